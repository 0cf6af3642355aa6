# The live part of scripts/demo, which sources it: stormcellar-feed follows one station of the public bucket, the
# daemon grids its volumes, and the viewer shows them until Ctrl-C. Uses $build, $cellar, $output, step, fail and,
# from the environment,
#   STORMCELLAR_DEMO_BUCKET   another bucket that answers like Amazon S3
#   https_proxy               if set, the proxy that the feed uses
bucket=${STORMCELLAR_DEMO_BUCKET:-https://unidata-nexrad-level2-chunks.s3.amazonaws.com}

# reach_bucket STATION: checks the bucket before anything is built, if curl is installed
reach_bucket() {
    local answer
    command -v curl >/dev/null || return 0
    answer=$(curl -sS --fail --max-time 20 "$bucket/?list-type=2&max-keys=1&prefix=$1/" 2>&1) ||
        fail "$bucket cannot be reached: ${answer##*$'\n'}. --live needs a network; scripts/demo without it needs none"
    [[ $answer == *"<Key>"* ]] || fail "the bucket has nothing of $1: is that the name of a radar, such as KTLX?"
}

# configure_live STATION
configure_live() {
    cat >>"$cellar/stormcellard.toml" <<TOML
[feed]
stations = ["$1"]
drop = "drop"
state = "feed"
bucket = "$bucket"
proxy = "${https_proxy:-}"
keep_hours = 2
bytes = "2 GB"
TOML
}

# Prints the value of "KEY": in the feed's status file.
feed_says() { sed -n "s/^ *\"$1\": *\"\{0,1\}\([^\",]*\).*/\1/p" "$cellar/feed/status.json" 2>/dev/null | head -n 1; }
start_beside() {
    local name=$1
    shift
    "$@" >"$cellar/$name.log" 2>&1 &
    beside[$name]=$!
}
stop_beside() {
    local name
    for name in "${!beside[@]}"; do
        kill -TERM "${beside[$name]}" 2>/dev/null || true
        wait "${beside[$name]}" 2>/dev/null || true
    done
    beside=()
}
check_beside() {
    local name
    for name in "${!beside[@]}"; do
        kill -0 "${beside[$name]}" 2>/dev/null || fail "$name ended: $(tail -n 3 "$cellar/$name.log")"
    done
}

# show_live STATION
show_live() {
    local station=$1 deadline=$((SECONDS + wait_limit_s)) said='' now address
    declare -gA beside=()
    trap stop_beside EXIT
    step "Follow $station of $bucket"
    start_beside feed "$build/fetch/feed/stormcellar-feed" --config "$cellar/stormcellard.toml"
    start_beside daemon "$build/daemon/stormcellard" --config "$cellar/stormcellard.toml"
    start_beside web "$build/cli/stormcellar" serve --config "$cellar/stormcellard.toml" --listen 127.0.0.1:0
    until "$build/cli/stormcellar" frame --cache "$cellar/cache" --domain "$station" -o "$output/$station.png" \
        >"$cellar/frame.log" 2>&1; do
        check_beside
        [ "$SECONDS" -lt "$deadline" ] || fail "no picture after $wait_limit_s s: $(feed_says error)"
        now="$(feed_says state), chunk $(feed_says chunk) $(feed_says error)"
        [ "$now" = "$said" ] || printf '%s\n' "$now"
        said=$now
        sleep 1
    done
    address=$(sed -n 's|^listening on \(http://.*\)$|\1|p' "$cellar/web.log" | head -n 1)
    step "Live"
    printf 'picture   %s\n' "$output/$station.png"
    printf 'viewer    %sview/\n' "$address"
    printf 'logs      %s\n' "$cellar/*.log"
    printf 'The viewer shows each sweep as it comes. Ctrl-C ends it.\n'
    said=
    while check_beside; do
        now=$(printf 'volume %s of %s, chunk %s, %s' "$(feed_says volume)" "$(feed_says volume_time)" \
            "$(feed_says chunk)" "$(feed_says state)")
        [ "$now" = "$said" ] || printf '%s\n' "$now"
        said=$now
        sleep 2
    done
}
