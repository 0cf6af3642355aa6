#include "cli/reference/reference.h"

#include <algorithm>
#include <cstdlib>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace stormcellar::cli {
namespace {

// Returns a range such as "1 - 1e+06" in words for people.
std::string range_in_words(const std::string& range) {
    const std::size_t dash = range.find(" - ");
    if (dash == std::string::npos) return range;
    const auto number = [](const std::string& text) {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        return end == text.c_str() ? text : fmt::format("{}", value);
    };
    return fmt::format("{} to {}", number(range.substr(0, dash)), number(range.substr(dash + 3)));
}

// Returns a word for a type, because the parser's own names of types are not meant for users.
std::string word_of_type(const std::string& type) {
    if (type == "INT" || type == "UINT") return "N";
    return type == "FLOAT" ? "NUMBER" : type;
}

// Sets the option's type from the parser's text, such as "INT:INT in [1 - 10]" or "TEXT:{a,b}".
void take_type(const std::string& type, OptionReference& option) {
    const std::string name = type.substr(0, type.find(':'));
    option.value = word_of_type(name);
    option.is_whole = option.value == "N";
    option.kept = option.value == name ? Kept::files : Kept::nowhere;
    const std::size_t range = type.find(" in [");
    if (range != std::string::npos) {
        option.range = range_in_words(type.substr(range + 5, type.find(']', range) - range - 5));
    }
    const std::size_t set = type.find(":{");
    if (set == std::string::npos) return;
    const std::string inside = type.substr(set + 2, type.find('}', set) - set - 2);
    for (std::size_t begin = 0; begin <= inside.size();) {
        const std::size_t end = std::min(inside.find(',', begin), inside.size());
        option.choices.push_back(inside.substr(begin, end - begin));
        begin = end + 1;
    }
}

// Sets the words for the option's value from the table. The row of the table may have any name of
// the option.
void take_words(const std::string& command, OptionReference& option) {
    std::vector<std::string> names = option.names;
    if (!option.place.empty()) names.push_back(option.place);
    for (const std::string& name : names) {
        const ValueWord* const row = find_value_word(name, command);
        if (row == nullptr) continue;
        option.value = row->word;
        option.kept = row->kept;
        if (row->values != nullptr) option.offers = row->values();
        return;
    }
}

std::vector<std::string> shown_names(const std::set<CLI::Option*>& options) {
    std::vector<std::string> names;
    for (const CLI::Option* option : options) {
        if (!option->get_group().empty()) names.push_back(option->get_name());
    }
    std::sort(names.begin(), names.end());
    return names;
}

OptionReference option_of(const CLI::Option& from, const std::string& group,
                          const std::string& command) {
    OptionReference option;
    for (const std::string& name : from.get_snames())
        option.names.push_back("-" + name);
    for (const std::string& name : from.get_lnames())
        option.names.push_back("--" + name);
    if (from.get_positional()) {
        option.place = from.get_name(true);
        option.usage = from.get_option_text();
        if (option.usage.empty())
            option.usage = option.place + (from.get_expected_max() > 1 ? "..." : "");
    }
    if (from.get_expected_max() > 0) {
        take_type(from.get_type_name(), option);
        take_words(command, option);
    }
    option.not_with = shown_names(from.get_excludes());
    option.only_with = shown_names(from.get_needs());
    option.initial = from.get_default_str();
    option.description = from.get_description();
    option.group = group;
    option.is_required = from.get_required();
    return option;
}

void add_options(const CLI::App& app, const std::string& group_of_all, CommandReference& command) {
    for (const CLI::Option* option : app.get_options({})) {
        const std::string& group = option->get_group();
        const bool is_help = option == app.get_help_ptr() || option == app.get_help_all_ptr();
        if (group.empty() || is_help) continue;
        const bool is_plain = group == "Options";
        command.options.push_back(
            option_of(*option, is_plain ? group_of_all : group, command.name));
    }
}

// Sorts options as --help shows them: first options without a group, then the options of each
// group.
void sort_by_group(std::vector<OptionReference>& options) {
    std::vector<std::string> groups{""};
    for (const OptionReference& option : options) {
        if (std::find(groups.begin(), groups.end(), option.group) == groups.end()) {
            groups.push_back(option.group);
        }
    }
    const auto place = [&](const OptionReference& option) {
        return std::find(groups.begin(), groups.end(), option.group) - groups.begin();
    };
    std::stable_sort(
        options.begin(), options.end(),
        [&](const OptionReference& a, const OptionReference& b) { return place(a) < place(b); });
}

CommandReference command_of(const CLI::App& app, const std::string& name) {
    CommandReference command;
    command.name = name;
    command.description = app.get_description();
    command.footer = app.get_footer();
    if (const CommandGuide* const guide = find_guide(name)) command.examples = guide->examples;
    add_options(app, "", command);
    for (const CLI::App* inner : app.get_subcommands(std::function<bool(const CLI::App*)>{})) {
        if (inner->get_name().empty()) {  // not a command but a group of options
            add_options(*inner, inner->get_group(), command);
        } else if (!inner->get_group().empty()) {
            command.inner.push_back(
                command_of(*inner, name.empty() ? inner->get_name()
                                                : fmt::format("{} {}", name, inner->get_name())));
        }
    }
    sort_by_group(command.options);
    return command;
}

}  // namespace

CommandReference reference_of(const CLI::App& app) {
    return command_of(app, "");
}

const CommandReference* find_command(const CommandReference& program, std::string_view name) {
    if (program.name == name) return &program;
    for (const CommandReference& inner : program.inner) {
        if (const CommandReference* found = find_command(inner, name)) return found;
    }
    return nullptr;
}

std::vector<std::string> sentences_of(const OptionReference& option) {
    std::vector<std::string> sentences;
    if (!option.description.empty()) {
        sentences.push_back(option.description);
        const char last = sentences.back().back();
        if (last != '.' && last != '?') sentences.back() += '.';
    }
    if (!option.range.empty()) sentences.push_back(fmt::format("From {}.", option.range));
    if (!option.initial.empty()) sentences.push_back(fmt::format("Default: {}.", option.initial));
    if (!option.not_with.empty())
        sentences.push_back(fmt::format("Not with {}.", fmt::join(option.not_with, " or ")));
    if (!option.only_with.empty())
        sentences.push_back(fmt::format("Only with {}.", fmt::join(option.only_with, " and ")));
    if (option.is_required) sentences.emplace_back("Must be given.");
    return sentences;
}

std::optional<std::string> reference_text(const CLI::App& app, std::string_view kind) {
    const CommandReference program = reference_of(app);
    if (kind == "man") return manual_of(program);
    if (kind == "bash") return bash_completion_of(program);
    if (kind == "zsh") return zsh_completion_of(program);
    if (kind == "fish") return fish_completion_of(program);
    return std::nullopt;
}

}  // namespace stormcellar::cli
