#include "cli/reference/reference.h"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace stormcellar::cli {
namespace {

// Takes what the parser says of a value: "INT:INT in [1 - 10]" or "TEXT:{a,b}".
void take_type(const std::string& type, OptionReference& option) {
    option.value = type.substr(0, type.find(':'));
    const std::size_t range = type.find(" in [");
    if (range != std::string::npos) {
        option.range = type.substr(range + 5, type.find(']', range) - range - 5);
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

OptionReference option_of(const CLI::Option& from, const std::string& group) {
    OptionReference option;
    for (const std::string& name : from.get_snames())
        option.names.push_back("-" + name);
    for (const std::string& name : from.get_lnames())
        option.names.push_back("--" + name);
    if (from.get_positional()) option.place = from.get_name(true);
    if (from.get_expected_max() > 0) take_type(from.get_type_name(), option);
    option.initial = from.get_default_str();
    option.description = from.get_description();
    option.group = group;
    option.is_required = from.get_required();
    return option;
}

void add_options(const CLI::App& app, const std::string& group_of_all,
                 std::vector<OptionReference>& options) {
    for (const CLI::Option* option : app.get_options({})) {
        const std::string& group = option->get_group();
        if (group.empty() || option == app.get_help_ptr()) continue;
        const bool is_plain = group == "Options";
        options.push_back(option_of(*option, is_plain ? group_of_all : group));
    }
}

// Options without a group come first, then those of each group, as in --help.
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
    add_options(app, "", command.options);
    for (const CLI::App* inner : app.get_subcommands(std::function<bool(const CLI::App*)>{})) {
        if (inner->get_name().empty()) {  // not a command but a group of options
            add_options(*inner, inner->get_group(), command.options);
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

std::optional<std::string> reference_text(const CLI::App& app, std::string_view kind) {
    const CommandReference program = reference_of(app);
    if (kind == "man") return manual_of(program);
    if (kind == "bash") return bash_completion_of(program);
    if (kind == "zsh") return zsh_completion_of(program);
    if (kind == "fish") return fish_completion_of(program);
    return std::nullopt;
}

}  // namespace stormcellar::cli
