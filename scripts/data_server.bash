# Functions for scripts that test a client against the data server; they source this file.
#   skip REASON             ends the script with status 77
#   need PROGRAM ...        skips if one of the programs is not installed
#   need_python MODULE ...  skips if $python lacks a module ($PYTHON, else Debian's)
#   serve PROGRAM WORD ...  runs `PROGRAM serve WORD ...` and sets $address, without a slash at the end
#   take_volume             sets $volume to a real volume, or to a volume that $program simulates, and $station to its
#                           station
# $directory is a new directory. At the end of the script the directory is removed and the server is stopped.
python=${PYTHON:-/usr/bin/python3}
directory=$(mktemp -d)
server=

skip() {
    echo "skipped: $1"
    exit 77
}

need() {
    local name
    for name in "$@"; do
        command -v "$name" >/dev/null || skip "$name is not installed"
    done
}

need_python() {
    local module
    for module in "$@"; do
        "$python" -c "import $module" 2>/dev/null || skip "$python has no module $module"
    done
}

end_server() {
    [ -z "$server" ] || { kill "$server" 2>/dev/null && wait "$server"; } || true
    server=
}

finish() {
    end_server
    rm -rf "$directory"
}
trap finish EXIT

serve() {
    local program=$1
    shift
    : >"$directory/out"
    "$program" serve "$@" --listen 127.0.0.1:0 >"$directory/out" 2>"$directory/err" &
    server=$!
    for _ in $(seq 600); do
        ! grep -q '^listening on ' "$directory/out" || break
        kill -0 "$server" 2>/dev/null || break
        sleep 0.1
    done
    address=$(sed -n 's|^listening on \(http://.*\)/$|\1|p' "$directory/out" | head -n 1)
    if [ -z "$address" ]; then
        echo "the server does not answer:" >&2
        cat "$directory/err" >&2
        exit 1
    fi
}

take_volume() {
    volume=${STORMCELLAR_DATA:-../shared/data}/volumes/KLOT20220317_000842_V06
    if [ ! -f "$volume" ]; then
        "$program" synth scenes/small-storm.toml -o "$directory/drop" >/dev/null
        volume=$(find "$directory/drop" -type f | sort | head -n 1)
    fi
    station=$(basename "$volume" | cut -c 1-4)
    echo "volume: $(basename "$volume")"
}
