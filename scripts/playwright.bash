# Runs the checks of tests/viewer in a browser; scripts source it.
#   need_playwright                        ends the script with status 77 unless its programs and packages are here
#   run_playwright BUILD PICTURES WORD ...  runs `playwright test WORD ...`, on a screen if $screen has a command for one
need_playwright() {
    local name
    for name in chromium node; do
        command -v "$name" >/dev/null || { echo "skipped: $name is not installed"; exit 77; }
    done
    if [ ! -x viewer/node_modules/.bin/playwright ]; then
        echo "skipped: Playwright is not installed; npm --prefix viewer ci installs it"
        exit 77
    fi
}

run_playwright() {
    STORMCELLAR_BUILD=$(realpath "$1")
    STORMCELLAR_PICTURES=${2:+$(realpath -m "$2")}
    export STORMCELLAR_BUILD STORMCELLAR_PICTURES
    shift 2
    "${screen[@]}" viewer/node_modules/.bin/playwright test --config tests/viewer "$@"
}
