# Functions that run the checks of tests/viewer in a browser; scripts source this file.
#   need_playwright                        ends the script with status 77 unless Playwright and its programs are
#                                          installed
#   run_playwright BUILD PICTURES WORD ...  runs `playwright test WORD ...`, by the command in $screen if that is set
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
