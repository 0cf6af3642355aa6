# bash completion of @SERVICE@.
_@FUNCTION@_program() {
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
    if [[ $previous == --config || $previous == '=' || $current == '=' ]]; then
        mapfile -t COMPREPLY < <(compgen -f -- "${current#=}")
        compopt -o filenames 2>/dev/null
    else
        mapfile -t COMPREPLY < <(compgen -W '--config --check-config --version --help' -- "$current")
    fi
}
complete -F _@FUNCTION@_program @SERVICE@
