// The commands and options for bash, zsh and fish. Where a value is expected, its allowed values or
// files are offered.
#include <algorithm>

#include <fmt/format.h>

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

// Returns "get" of "catalog get".
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

// Returns the beginning of a description, for one line of a menu.
std::string brief(const std::string& description) {
    std::size_t end = description.size();
    for (const char* stop : {". ", "; ", ": ", " ("})
        end = std::min(end, description.find(stop));
    return description.substr(0, end);
}

Words option_names(const CommandReference& command) {
    Words names{"-h", "--help"};
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

std::string zsh_action(const OptionReference& option) {
    if (option.choices.empty()) return "_files";
    return fmt::format("({})", fmt::join(option.choices, " "));
}

// Each name of an option gets a line of its own, so that the exclusive lists of _arguments are not
// needed.
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

void write_zsh_command(const CommandReference& command, std::string& out) {
    const std::string function = zsh_function(command.name);
    out += fmt::format("\n{}() {{\n", function);
    if (!command.inner.empty()) out += "  local context state state_descr line\n";
    out += fmt::format("  _arguments -s {}'(-h --help)'{{-h,--help}}'[Print help and exit]'",
                       command.inner.empty() ? "" : "-C ");
    for (const OptionReference& option : command.options)
        write_zsh_option(option, out);
    if (command.inner.empty()) {
        out += " \\\n    '*:file:_files'\n}\n";
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

void write_fish_option(const CommandReference& command, const OptionReference& option,
                       std::string& out) {
    if (option.names.empty()) return;
    out += fmt::format("complete -c stormcellar -n '__stormcellar_at \"{}\"'", command.name);
    for (const std::string& name : option.names) {
        const bool is_long = name.starts_with("--");
        out += fmt::format(" {} {}", is_long ? "-l" : "-s", name.substr(is_long ? 2 : 1));
    }
    if (!option.value.empty()) out += option.choices.empty() ? " -r -F" : " -x";
    if (!option.choices.empty()) out += fmt::format(" -a '{}'", fmt::join(option.choices, " "));
    out += fmt::format(" -d {}\n", fish_quoted(brief(option.description)));
}

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
        std::string values;
        std::string choices;
        for (const OptionReference& option : command->options) {
            if (option.value.empty() || option.names.empty()) continue;
            values += fmt::format(" {}", fmt::join(option.names, " "));
            if (option.choices.empty()) continue;
            choices += fmt::format("                {}) choices='{}' ;;\n",
                                   fmt::join(option.names, "|"), fmt::join(option.choices, " "));
        }
        cases += fmt::format("            values='{} '\n", values);
        if (!choices.empty())
            cases += "            case $previous in\n" + choices + "            esac\n";
        cases += "            ;;\n";
    }
    return fmt::format(
        R"(# bash completion of stormcellar; made by stormcellar --reference bash.
_stormcellar() {{
    local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}
    local command='' commands='' options='' values='' choices='' longer i
    for ((i = 1; i < COMP_CWORD; ++i)); do
        longer="${{command:+$command }}${{COMP_WORDS[i]}}"
        case $longer in
            {}) command=$longer ;;
        esac
    done
    # --option=value comes as three words.
    if [[ $current == '=' ]]; then
        current=''
    elif [[ $previous == '=' ]]; then
        previous=${{COMP_WORDS[COMP_CWORD - 2]}}
    fi
    case $command in
{}    esac
    if [[ -n $choices ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$current")
    elif [[ $values == *" $previous "* ]]; then
        mapfile -t COMPREPLY < <(compgen -f -- "$current")
        compopt -o filenames 2>/dev/null
    elif [[ $current == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
    elif [[ -n $commands ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$current")
    else
        mapfile -t COMPREPLY < <(compgen -f -- "$current")
        compopt -o filenames 2>/dev/null
    fi
}}
complete -F _stormcellar stormcellar
)",
        known, cases);
}

std::string zsh_completion_of(const CommandReference& program) {
    std::string out = "#compdef stormcellar\n# Made by stormcellar --reference zsh.\n";
    for (const CommandReference* command : all_commands(program))
        write_zsh_command(*command, out);
    return out + "\n_stormcellar \"$@\"\n";
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
complete -c stormcellar -s h -l help -d 'Print help and exit'
{})",
                       names, lines);
}

}  // namespace stormcellar::cli
