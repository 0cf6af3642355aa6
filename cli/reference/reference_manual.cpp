// Writes the commands and options in the format of man(7).
#include <fmt/format.h>

#include "cli/reference/reference.h"

namespace stormcellar::cli {
namespace {

// Escapes all characters that roff would interpret.
std::string roff(const std::string& text) {
    std::string out;
    for (const char letter : text) {
        if (letter == '\\') {
            out += "\\e";
        } else if (letter == '-') {
            out += "\\-";
        } else if ((letter == '.' || letter == '\'') && (out.empty() || out.back() == '\n')) {
            out += "\\&";
            out += letter;
        } else {
            out += letter;
        }
    }
    return out;
}

std::string ended(std::string text) {
    if (!text.empty() && text.back() != '.') text += '.';
    return text;
}

std::string bold(const std::string& text) {
    return fmt::format("\\fB{}\\fR", roff(text));
}
std::string italic(const std::string& text) {
    return fmt::format("\\fI{}\\fR", roff(text));
}

void write_option(const OptionReference& option, std::string& out) {
    std::string head;
    for (const std::string& name : option.names)
        head += (head.empty() ? "" : ", ") + bold(name);
    if (option.names.empty()) {
        head = italic(option.place);
    } else if (!option.choices.empty()) {
        head += " " + bold(fmt::format("{}", fmt::join(option.choices, "|")));
    } else if (!option.value.empty()) {
        head += " " + italic(option.value);
    }
    out += fmt::format(".TP\n{}\n", head);
    for (const std::string& sentence : sentences_of(option))
        out += roff(sentence) + "\n";
}

void write_command(const CommandReference& command, std::string& out) {
    if (command.inner.empty()) {
        out += fmt::format(".SS \"stormcellar {}", roff(command.name));
        for (const OptionReference& option : command.options) {
            if (option.place.empty()) continue;
            const std::string place = roff(option.usage);
            out += option.is_required ? fmt::format(" {}", place) : fmt::format(" [{}]", place);
        }
        out += fmt::format(" [OPTIONS]\"\n{}\n", roff(ended(command.description)));
    }
    for (const CommandExample& example : command.examples) {
        out += fmt::format(".PP\n{}\n.br\n{}\n", bold(std::string(example.line)),
                           roff(std::string(example.what)));
    }
    std::string group;
    for (const OptionReference& option : command.options) {
        if (option.group != group) {
            group = option.group;
            out += fmt::format(".PP\n{}\n", italic(group + ":"));
        }
        write_option(option, out);
    }
    if (!command.footer.empty()) out += fmt::format(".PP\n{}\n", roff(command.footer));
    for (const CommandReference& inner : command.inner)
        write_command(inner, out);
}

}  // namespace

std::string manual_of(const CommandReference& program) {
    std::string out;
    for (const CommandReference& command : program.inner)
        write_command(command, out);
    return out;
}

}  // namespace stormcellar::cli
