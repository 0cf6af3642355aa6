// Writes completions for bash, zsh and fish. For the value of an option, they offer the allowed or
// usual values, files, directories, or the domains and stations that the program finds
// (completed_names.h).
#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/reference/reference.h"

namespace stormcellar::cli {
namespace {

using Words = std::vector<std::string>;

std::vector<const CommandReference*> all_commands(const CommandReference& program) {
    std::vector<const CommandReference*> all{&program};
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (const CommandReference& inner : all[i]->inner)
            all.push_back(&inner);
    }
    return all;
}

// Returns the last word of a command's name: "get" for "catalog get".
std::string last_word(const std::string& name) {
    const std::size_t space = name.rfind(' ');
    return space == std::string::npos ? name : name.substr(space + 1);
}

Words names_of_inner(const CommandReference& command) {
    Words names;
    for (const CommandReference& inner : command.inner)
        names.push_back(last_word(inner.name));
    return names;
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
    for (std::size_t at = text.find(what); at != std::string::npos;
         at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
    return text;
}

// Returns the start of a description that fits on one line of a menu.
std::string brief(const std::string& description) {
    std::size_t end = description.size();
    for (const char* stop : {". ", "; ", ": ", " ("})
        end = std::min(end, description.find(stop));
    return description.substr(0, end);
}

Words option_names(const CommandReference& command) {
    Words names{"-h", "--help", "--help-all"};
    for (const OptionReference& option : command.options)
        names.insert(names.end(), option.names.begin(), option.names.end());
    return names;
}

std::string zsh_quoted(const std::string& text) {
    std::string out = replaced(text, "\\", "\\\\");
    out = replaced(out, "'", "'\\''");
    for (const char* sign : {"[", "]", ":"})
        out = replaced(out, sign, fmt::format("\\{}", sign));
    return out;
}

std::string fish_quoted(const std::string& text) {
    return fmt::format("'{}'", replaced(replaced(text, "\\", "\\\\"), "'", "\\'"));
}

std::string zsh_function(const std::string& name) {
    return name.empty() ? "_stormcellar" : "_stormcellar_" + replaced(name, " ", "_");
}

// Returns the values that can be listed: all allowed values, or else the usual values.
const Words& listed(const OptionReference& option) {
    return option.choices.empty() ? option.offers : option.choices;
}

// Returns the names of all commands, as the words that may follow `help`.
Words names_of_all(const CommandReference& program) {
    Words names;
    for (const CommandReference* command : all_commands(program)) {
        if (command->name.empty()) continue;
        const std::string word = last_word(command->name);
        if (std::ranges::find(names, word) == names.end()) names.push_back(word);
    }
    return names;
}

// Returns the kind of values to offer for positional arguments: files, unless the table of words
// says otherwise.
Kept kept_of_arguments(const CommandReference& command) {
    for (const OptionReference& option : command.options) {
        if (!option.place.empty() && option.kept != Kept::nowhere) return option.kept;
    }
    return Kept::files;
}

// An offer for values that no list can name. The program finds them; `word` is the argument of its
// option --complete.
struct KeptOffer {
    Kept kept = Kept::nowhere;
    std::string_view word, zsh, fish;
};
constexpr auto kept_offers = std::to_array<KeptOffer>({
    {Kept::files, "files", "_files", " -r -F"},
    {Kept::directories, "directories", "_files -/", " -x -a '(__fish_complete_directories)'"},
    // The leading blank keeps zsh from adding arguments of its own to the action.
    {Kept::domains, "domains", " _stormcellar_names domains",
     " -x -a '(__stormcellar_names domains)'"},
    {Kept::stations, "stations", " _stormcellar_names stations",
     " -x -a '(__stormcellar_names stations)'"},
});

// Returns an empty offer for values that are listed, and for the kinds without a row.
KeptOffer offer_of(const OptionReference& option) {
    const auto row = std::ranges::find(kept_offers, option.kept, &KeptOffer::kept);
    const bool is_listed = option.kept == Kept::files && !option.choices.empty();
    return row == kept_offers.end() || is_listed ? KeptOffer{} : *row;
}

std::string zsh_action(const OptionReference& option) {
    const Words& values = listed(option);
    const std::string joined = fmt::format("{}", fmt::join(values, " "));
    const KeptOffer offer = offer_of(option);
    if (offer.kept == Kept::files && !values.empty())
        return fmt::format(" _stormcellar_or_file {}", joined);
    if (offer.kept != Kept::nowhere) return std::string(offer.zsh);
    return values.empty() ? " " : fmt::format("({})", joined);
}

std::string zsh_arguments(const CommandReference& command, const Words& all_names) {
    const Kept kept = kept_of_arguments(command);
    if (kept == Kept::domains) return "'*:domain: _stormcellar_domain_or_file'";
    if (kept == Kept::commands) return fmt::format("'*:command:({})'", fmt::join(all_names, " "));
    return "'*:file:_files'";
}

// Writes an option, with a line for each of its names. One line for all names would need a list of
// options that exclude each other.
void write_zsh_option(const OptionReference& option, std::string& out) {
    for (const std::string& name : option.names) {
        const bool is_long = name.starts_with("--");
        out += fmt::format(" \\\n    '*{}", name);
        if (!option.value.empty()) out += is_long ? "=" : "+";
        out += fmt::format("[{}]", zsh_quoted(brief(option.description)));
        if (!option.value.empty()) {
            out += fmt::format(":{}:{}", zsh_quoted(option.value), zsh_action(option));
        }
        out += '\'';
    }
}

void write_zsh_command(const CommandReference& command, const Words& all_names, std::string& out) {
    const std::string function = zsh_function(command.name);
    out += fmt::format("\n{}() {{\n", function);
    if (!command.inner.empty()) out += "  local context state state_descr line\n";
    out += fmt::format(
        "  _arguments -s {}'(-h --help)'{{-h,--help}}'[Print help and exit]' \\\n"
        "    '--help-all[Print help with all options]'",
        command.inner.empty() ? "" : "-C ");
    for (const OptionReference& option : command.options)
        write_zsh_option(option, out);
    if (command.inner.empty()) {
        out += fmt::format(" \\\n    {}\n}}\n", zsh_arguments(command, all_names));
        return;
    }
    out +=
        " \\\n    '1:command:->command' '*::argument:->argument'\n  case $state in\n"
        "    command)\n      local -a commands=(\n";
    for (const CommandReference& inner : command.inner) {
        out += fmt::format("        '{}:{}'\n", last_word(inner.name),
                           zsh_quoted(brief(inner.description)));
    }
    out += "      )\n      _describe command commands ;;\n    argument)\n      case $line[1] in\n";
    for (const CommandReference& inner : command.inner) {
        out += fmt::format("        {}) {} ;;\n", last_word(inner.name), zsh_function(inner.name));
    }
    out += "      esac ;;\n  esac\n}\n";
}

// Returns the flags that tell fish whether a value follows, and which values to offer.
std::string fish_values(const OptionReference& option) {
    if (option.value.empty()) return "";
    const Words& values = listed(option);
    const std::string offered =
        values.empty() ? "" : fmt::format(" -a '{}'", fmt::join(values, " "));
    const KeptOffer offer = offer_of(option);
    if (offer.kept == Kept::nowhere) return " -x" + offered;
    return std::string(offer.fish) + (offer.kept == Kept::files ? offered : "");
}

// Writes the domains or commands that fish offers for positional arguments, besides files.
void write_fish_arguments(const CommandReference& command, const Words& all_names,
                          std::string& out) {
    const Kept kept = kept_of_arguments(command);
    if (kept != Kept::domains && kept != Kept::commands) return;
    out +=
        fmt::format("complete -c stormcellar -n '__stormcellar_at \"{}\"' {}\n", command.name,
                    kept == Kept::domains ? std::string{"-a '(__stormcellar_names domains)'"}
                                          : fmt::format("-f -a '{}'", fmt::join(all_names, " ")));
}

void write_fish_option(const CommandReference& command, const OptionReference& option,
                       std::string& out) {
    if (option.names.empty()) return;
    out += fmt::format("complete -c stormcellar -n '__stormcellar_at \"{}\"'", command.name);
    for (const std::string& name : option.names) {
        const bool is_long = name.starts_with("--");
        out += fmt::format(" {} {}", is_long ? "-l" : "-s", name.substr(is_long ? 2 : 1));
    }
    out += fish_values(option);
    out += fmt::format(" -d {}\n", fish_quoted(brief(option.description)));
}

// Writes the options that take a value, and for each option the values that bash offers.
std::string bash_values_of(const CommandReference& command) {
    std::string values;
    std::string cases;
    for (const OptionReference& option : command.options) {
        if (option.value.empty() || option.names.empty()) continue;
        values += fmt::format(" {}", fmt::join(option.names, " "));
        const Words& words = listed(option);
        const std::string_view kept = option.choices.empty() ? offer_of(option).word : "";
        if (words.empty() && kept.empty()) continue;
        cases += fmt::format("                {})", fmt::join(option.names, "|"));
        if (!words.empty()) cases += fmt::format(" choices='{}'", fmt::join(words, " "));
        if (!kept.empty()) cases += fmt::format(" kept={}", kept);
        cases += " ;;\n";
    }
    std::string out = fmt::format("            values='{} '\n", values);
    if (!cases.empty()) out += "            case $previous in\n" + cases + "            esac\n";
    return out;
}

// A format string. Its first placeholder takes the names of all commands, the second takes the
// words that bash offers for each command.
constexpr std::string_view bash_script =
    R"bash(# bash completion of stormcellar; made by stormcellar --reference bash.
# Adds files, directories, or the names that the program knows, to what is offered.
_stormcellar_add() {{
    local -a more=()
    case $1 in
        files) mapfile -t more < <(compgen -f -- "$2") ;;
        directories) mapfile -t more < <(compgen -d -- "$2") ;;
        domains | stations)
            mapfile -t more < <(compgen -W \
                "$("$3" --complete "$1" "${{COMP_WORDS[@]}}" 2>/dev/null)" -- "$2") ;;
    esac
    [[ $1 != files && $1 != directories ]] || compopt -o filenames 2>/dev/null
    COMPREPLY+=("${{more[@]}}")
}}
_stormcellar() {{
    local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}
    local command='' commands='' options='' values='' choices='' kept='' arguments=files longer i
    for ((i = 1; i < COMP_CWORD; ++i)); do
        longer="${{command:+$command }}${{COMP_WORDS[i]}}"
        case $longer in
            {}) command=$longer ;;
        esac
    done
    # --option=value comes as three words, and so does the name=on behind --effect.
    if [[ $current == '=' ]]; then
        current=''
        [[ $previous == -* ]] || previous="${{COMP_WORDS[COMP_CWORD - 2]}}="
    elif [[ $previous == '=' ]]; then
        previous=${{COMP_WORDS[COMP_CWORD - 2]}}
        [[ $previous == -* ]] || previous="${{COMP_WORDS[COMP_CWORD - 3]}}="
    fi
    case $command in
{}    esac
    if [[ $previous == '--effect=' ]]; then
        choices='on off auto'
    fi
    if [[ -n $choices || -n $kept ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$current")
        _stormcellar_add "$kept" "$current" "${{1:-stormcellar}}"
    elif [[ $values == *" $previous "* ]]; then
        COMPREPLY=()
    elif [[ $current == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
    elif [[ -n $commands ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$current")
    else
        COMPREPLY=()
        [[ $arguments == files ]] || _stormcellar_add "$arguments" "$current" "${{1:-stormcellar}}"
        _stormcellar_add files "$current" "${{1:-stormcellar}}"
    fi
}}
complete -F _stormcellar stormcellar
)bash";

}  // namespace

std::string bash_completion_of(const CommandReference& program) {
    std::string known;
    std::string cases;
    for (const CommandReference* command : all_commands(program)) {
        if (!command->name.empty())
            known += fmt::format("{}'{}'", known.empty() ? "" : "|", command->name);
        cases += fmt::format("        '{}')\n            commands='{}'\n            options='{}'\n",
                             command->name, fmt::join(names_of_inner(*command), " "),
                             fmt::join(option_names(*command), " "));
        cases += bash_values_of(*command);
        if (kept_of_arguments(*command) == Kept::domains)
            cases += "            arguments=domains\n";
        if (kept_of_arguments(*command) == Kept::commands) {
            cases +=
                fmt::format("            commands='{}'\n", fmt::join(names_of_all(program), " "));
        }
        cases += "            ;;\n";
    }
    return fmt::format(bash_script, known, cases);
}

std::string zsh_completion_of(const CommandReference& program) {
    std::string out = R"zsh(#compdef stormcellar
# Made by stormcellar --reference zsh.

# The names that the program knows, and for some options files beside them.
_stormcellar_names() {
  local -a names=(${(f)"$(${_stormcellar_program:-stormcellar} --complete $1 "${words[@]}" 2>/dev/null)"})
  compadd -a names
}
_stormcellar_or_file() {
  compadd -- "$@"
  _files
}
_stormcellar_domain_or_file() {
  _stormcellar_names domains
  _files
}
)zsh";
    const Words all_names = names_of_all(program);
    for (const CommandReference* command : all_commands(program))
        write_zsh_command(*command, all_names, out);
    return out + "\n_stormcellar_program=$words[1]\n_stormcellar \"$@\"\n";
}

std::string fish_completion_of(const CommandReference& program) {
    std::string names;
    std::string lines;
    for (const CommandReference* command : all_commands(program)) {
        if (!command->name.empty()) names += fmt::format(" '{}'", command->name);
        if (!command->inner.empty()) {
            lines += fmt::format("complete -c stormcellar -n '__stormcellar_at \"{}\"' -f\n",
                                 command->name);
        }
        for (const CommandReference& inner : command->inner) {
            lines += fmt::format(
                "complete -c stormcellar -n '__stormcellar_at \"{}\"' -a {} -d {}\n", command->name,
                last_word(inner.name), fish_quoted(brief(inner.description)));
        }
        for (const OptionReference& option : command->options)
            write_fish_option(*command, option, lines);
        if (command->inner.empty()) write_fish_arguments(*command, names_of_all(program), lines);
    }
    return fmt::format(R"(# fish completion of stormcellar; made by stormcellar --reference fish.
function __stormcellar_at --description 'Whether this is the command that was typed so far'
    set -l command ''
    for word in (commandline -opc)[2..-1]
        set -l longer (string trim -- "$command $word")
        if contains -- $longer{}
            set command $longer
        end
    end
    test "$command" = "$argv[1]"
end
# The names that the program knows.
function __stormcellar_names
    set -l typed (commandline -opc)
    $typed[1] --complete $argv[1] $typed 2>/dev/null
end
complete -c stormcellar -s h -l help -d 'Print help and exit'
complete -c stormcellar -l help-all -d 'Print help with all options'
{})",
                       names, lines);
}

}  // namespace stormcellar::cli
