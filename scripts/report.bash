# Functions for checks of several programs, which report and wait; scripts source this file.
#   say TEXT                   prints the text with the script's name and the seconds since its start
#   fail TEXT                  prints the text and ends the script
#   skip TEXT                  prints the text and ends the script with status 77
#   wait_for WHAT COMMAND ...  waits until the command succeeds; fails after $most_wait_s seconds
most_wait_s=60

say() { echo "${0##*/}: $1 ($SECONDS s)"; }
fail() {
    echo "${0##*/}: $1"
    exit 1
}
skip() {
    echo "${0##*/}: skipped: $1"
    exit 77
}
wait_for() {
    local what=$1 until=$((SECONDS + most_wait_s))
    shift
    until "$@" >/dev/null 2>&1; do
        [ "$SECONDS" -lt "$until" ] || fail "not within $most_wait_s s: $what"
        sleep 0.2
    done
}
