// Writes the text of --help and --help-all: examples, then usual options, then all other options.
#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/parse_number.h"
#include "cli/reference/reference.h"

namespace stormcellar::cli {
namespace {

constexpr std::size_t usual_width = 80, least_width = 60, most_width = 160;
constexpr std::size_t text_column = 26;  // where the text beside an option begins
constexpr std::size_t margin = 2;

// Returns the width of a page, from $COLUMNS if a user has set it, limited to readable widths.
std::size_t page_width() {
    const char* const asked = std::getenv("COLUMNS");
    if (asked == nullptr) return usual_width;
    const auto width = parse_number<std::size_t>(asked);
    return width ? std::clamp(*width, least_width, most_width) : usual_width;
}

// Breaks a text at blanks. Lines after the first begin at this column.
std::string wrapped(const std::string& text, std::size_t column) {
    const std::size_t width = page_width();
    std::string out;
    std::size_t at = column;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find(' ', begin), text.size());
        std::string word = text.substr(begin, end - begin);
        begin = end + 1;
        // A list without blanks may be longer than a line, so break it at a comma.
        while (column + word.size() > width) {
            const std::size_t comma = word.rfind(',', width - column - 1);
            if (comma == std::string::npos) break;
            if (at > column) out += '\n' + std::string(column, ' ');
            out += word.substr(0, comma + 1) + '\n' + std::string(column, ' ');
            word.erase(0, comma + 1);
            at = column;
        }
        if (at > column && at + 1 + word.size() > width) {
            out += '\n' + std::string(column, ' ');
            at = column;
        } else if (at > column) {
            out += ' ';
            ++at;
        }
        out += word;
        at += word.size();
    }
    return out;
}

void write_row(const std::string& head, const std::string& text, std::string& out) {
    out += std::string(margin, ' ') + head;
    const std::size_t end = margin + head.size();
    if (end + 2 > text_column) {
        out += '\n' + std::string(text_column, ' ');
    } else {
        out += std::string(text_column - end, ' ');
    }
    out += wrapped(text, text_column) + '\n';
}

// Returns "-o, --output FILE", or "DOMAIN" for a positional option.
std::string head_of(const OptionReference& option) {
    std::string head = option.place;
    if (!option.names.empty()) {
        if (!head.empty()) head += " or ";
        head += fmt::format("{}", fmt::join(option.names, ", "));
        if (!option.choices.empty()) {
            head += fmt::format(" {}", fmt::join(option.choices, "|"));
        } else if (!option.value.empty()) {
            head += " " + option.value;
        }
    }
    return head;
}

std::string usage_of(const CommandReference& command) {
    std::string line = "Usage: stormcellar";
    if (!command.name.empty()) line += " " + command.name;
    if (!command.inner.empty()) return line + " COMMAND";
    for (const OptionReference& option : command.options) {
        if (option.place.empty()) continue;
        line += fmt::format(fmt::runtime(option.is_required ? " {}" : " [{}]"), option.usage);
    }
    for (const OptionReference& option : command.options) {
        if (!option.is_required || !option.place.empty()) continue;
        line += fmt::format(" {} {}", option.names.front(), option.value);
    }
    return line + " [OPTIONS]";
}

// Returns the options of the short help: arguments first, then the usual options of the guide.
std::vector<const OptionReference*> usual_options(const CommandReference& command) {
    std::vector<const OptionReference*> usual;
    const CommandGuide* const guide = find_guide(command.name);
    const bool all = guide == nullptr || guide->usual.empty();
    for (const OptionReference& option : command.options) {
        if (all || !option.place.empty()) usual.push_back(&option);
    }
    if (all) return usual;
    for (const std::string_view name : guide->usual) {
        for (const OptionReference& option : command.options) {
            const bool is_named = std::ranges::find(option.names, name) != option.names.end();
            if (is_named && option.place.empty()) usual.push_back(&option);
        }
    }
    return usual;
}

// Breaks a long command line before an option, in a form that a shell accepts as one command.
std::string example_line(std::string_view line) {
    std::string out;
    std::size_t begin = 0;
    const std::size_t width = page_width();
    std::size_t room = width - margin - 2;
    while (line.size() - begin > room) {
        std::size_t end = line.rfind(" -", begin + room);
        if (end == std::string_view::npos || end <= begin) break;
        out += fmt::format("{} \\\n      ", line.substr(begin, end - begin));
        begin = end + 1;
        room = width - 8;
    }
    return out + std::string(line.substr(begin));
}

void write_examples(const CommandReference& command, std::string& out) {
    if (command.examples.empty()) return;
    out += "\nExamples:\n";
    for (const CommandExample& example : command.examples)
        out += fmt::format("  {}\n      {}\n", example_line(example.line),
                           wrapped(std::string(example.what), 6));
}

void write_commands(const CommandReference& command, std::string& out) {
    if (command.inner.empty()) return;
    out += "\nCommands:\n";
    for (const CommandReference& inner : command.inner) {
        const std::size_t space = inner.name.rfind(' ');
        const std::string word =
            space == std::string::npos ? inner.name : inner.name.substr(space + 1);
        constexpr std::size_t column = 14;
        out +=
            fmt::format("  {:<{}}{}\n", word, column - margin, wrapped(inner.description, column));
    }
}

void write_option_row(const OptionReference& option, std::string& out) {
    const auto sentences = sentences_of(option);
    write_row(head_of(option), fmt::format("{}", fmt::join(sentences, " ")), out);
}

// Writes the options, and returns how many it left out.
std::size_t write_options(const CommandReference& command, HelpExtent extent, std::string& out) {
    out += "\nOptions:\n";
    if (extent == HelpExtent::usual) {
        const auto usual = usual_options(command);
        for (const OptionReference* option : usual)
            write_option_row(*option, out);
        return command.options.size() - usual.size();
    }
    std::string group;
    for (const OptionReference& option : command.options) {
        if (option.group != group) {
            group = option.group;
            out += fmt::format("\n{}:\n", group);
        }
        write_option_row(option, out);
    }
    return 0;
}

}  // namespace

std::string help_of(const CommandReference& command, HelpExtent extent) {
    std::string out = command.description;
    if (!out.empty() && out.back() != '.') out += '.';
    out = wrapped(out, 0) + '\n';
    write_examples(command, out);
    out += "\n" + wrapped(usage_of(command), 0) + "\n";
    write_commands(command, out);
    const std::size_t left_out = write_options(command, extent, out);
    if (extent == HelpExtent::all) out += '\n';
    write_row("-h, --help", "Print this help.", out);
    if (left_out > 0) {
        write_row("--help-all", fmt::format("Print the help of all options, {} more.", left_out),
                  out);
    }
    if (!command.footer.empty()) out += "\n" + wrapped(command.footer, 0) + "\n";
    if (!command.inner.empty()) {
        out += fmt::format("\nSee 'stormcellar help {}COMMAND' for one of them.\n",
                           command.name.empty() ? "" : command.name + " ");
    }
    return out;
}

}  // namespace stormcellar::cli
