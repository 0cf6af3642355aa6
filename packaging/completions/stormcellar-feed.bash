# bash completion of stormcellar-feed.
_stormcellar_feed_program() {
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
    if [[ $previous == --config || $previous == '=' || $current == '=' ]]; then
        mapfile -t COMPREPLY < <(compgen -f -- "${current#=}")
        compopt -o filenames 2>/dev/null
    else
        mapfile -t COMPREPLY < <(compgen -W '--config --check-config --version --help' -- "$current")
    fi
}
complete -F _stormcellar_feed_program stormcellar-feed
