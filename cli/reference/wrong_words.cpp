#include "cli/reference/wrong_words.h"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/nearest_name.h"

namespace stormcellar::cli {
namespace {

std::string last_word_of(const std::string& name) {
    return name.substr(name.rfind(' ') + 1);
}

std::vector<std::string> inner_names(const CommandReference& command) {
    std::vector<std::string> names;
    for (const CommandReference& inner : command.inner)
        names.push_back(last_word_of(inner.name));
    return names;
}

std::vector<std::string> option_names_of(const CommandReference& command) {
    std::vector<std::string> names{"--help", "--help-all"};
    for (const OptionReference& option : command.options)
        names.insert(names.end(), option.names.begin(), option.names.end());
    return names;
}

// Returns the option of this name, or null if the command has none.
const OptionReference* find_option(const std::string& name, const CommandReference& command) {
    for (const OptionReference& one : command.options) {
        const bool is_named = std::ranges::find(one.names, name) != one.names.end();
        if (is_named || one.place == name) return &one;
    }
    return nullptr;
}

std::string value_of(const std::string& name, const CommandReference& command) {
    const OptionReference* const option = find_option(name, command);
    return option == nullptr ? std::string{} : option->value;
}

// Returns a clearer form of the parser's message "Could not convert: --width = abc".
std::string not_a_number(std::string_view said, const CommandReference& command) {
    const std::size_t equals = said.find(" = ");
    const std::string option(said.substr(0, equals));
    const std::string text(equals == std::string_view::npos ? "" : said.substr(equals + 3));
    const OptionReference* const found = find_option(option, command);
    return fmt::format("{} must be a {}number, not '{}'", option,
                       found != nullptr && found->is_whole ? "whole " : "", text);
}

// Makes a sentence from a message of the parser, such as "--last: Value 0 not in range 1 to 9" or
// "--last: 1 required INT missing". Returns other messages unchanged.
std::string sentence_of(const std::string& said, const CommandReference& command) {
    constexpr std::string_view value = ": Value ", range = " not in range ";
    const std::size_t at_value = said.find(value), at_range = said.rfind(range);
    if (at_value < at_range && at_range != std::string::npos) {
        const std::size_t begin = at_value + value.size();
        return fmt::format("{} must be {}, not {}", said.substr(0, at_value),
                           said.substr(at_range + range.size()),
                           said.substr(begin, at_range - begin));
    }
    const std::size_t at_missing = said.find(": 1 required ");
    if (at_missing != std::string::npos && said.ends_with(" missing")) {
        const std::string option = said.substr(0, at_missing);
        return fmt::format("{} needs a value: {} {}", option, option, value_of(option, command));
    }
    constexpr std::string_view not_converted = "Could not convert: ";
    if (said.starts_with(not_converted))
        return not_a_number(std::string_view(said).substr(not_converted.size()), command);
    constexpr std::string_view required = " is required";
    if (said.ends_with(required)) {
        const std::string option = said.substr(0, said.size() - required.size());
        const std::string word = value_of(option, command);
        const bool is_option = option.starts_with('-') && !word.empty();
        return fmt::format("{}{} must be given", option, is_option ? " " + word : "");
    }
    return said;
}

}  // namespace

std::string no_command(const std::string& name, const CommandReference& program) {
    // Suggest commands below the words before the last one, or below the program if these words
    // are no command.
    const std::size_t space = name.rfind(' ');
    const CommandReference* above =
        space == std::string::npos ? &program : find_command(program, name.substr(0, space));
    if (above == nullptr) above = &program;
    const auto names = inner_names(*above);
    const auto nearest = nearest_name(last_word_of(name), names);
    if (!nearest) return fmt::format("there is no command '{}'", name);
    return fmt::format("there is no command '{}'; did you mean '{}{}'?", name,
                       above->name.empty() ? "" : above->name + " ", *nearest);
}

// Returns the reason of the refusal. If an option was misspelled, reports the misspelling; CLI11
// would report that the option is missing.
std::string reason_of(const CLI::ParseError& error, std::vector<std::string> left,
                      const CommandReference& command) {
    // For "--prodct volume", report the option, not the word after it.
    std::stable_partition(left.begin(), left.end(),
                          [](const std::string& word) { return word.starts_with('-'); });
    const int code = error.get_exit_code();
    const bool may_be_misspelt = code == static_cast<int>(CLI::ExitCodes::RequiredError) ||
                                 code == static_cast<int>(CLI::ExitCodes::ExtrasError);
    if (!may_be_misspelt || left.empty()) {
        if (!command.inner.empty() && code == static_cast<int>(CLI::ExitCodes::RequiredError)) {
            return fmt::format("a command is missing{}",
                               command.name.empty() ? "" : " behind " + command.name);
        }
        return sentence_of(error.what(), command);
    }
    const std::string& word = left.front();
    if (word.starts_with('-')) {
        const std::string name = word.substr(0, word.find('='));
        return fmt::format("there is no option {}{}", word,
                           did_you_mean(name, option_names_of(command)));
    }
    if (!command.inner.empty()) {
        const std::string all = command.name.empty() ? word : command.name + " " + word;
        return fmt::format("there is no command '{}'{}", all,
                           did_you_mean(word, inner_names(command)));
    }
    return fmt::format("the argument {} is one too many", word);
}

}  // namespace stormcellar::cli
