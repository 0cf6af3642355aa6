// Tests the help of the program's real commands.
#include <algorithm>
#include <sstream>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/reference/reference.h"
#include "cli/subcommands.h"
#include "stormcellar/render/light.h"
#include "tests/cli/run_stormcellar.h"

namespace stormcellar::cli {
namespace {

using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

class ReferenceHelp : public ::testing::Test {
  protected:
    void SetUp() override {
        app_.set_help_all_flag("--help-all");
        app_.require_subcommand(1);
        for (const Subcommand& subcommand : subcommands())
            commands_.push_back(add_subcommand(app_, subcommand));
        program_ = reference_of(app_);
        add(program_);
    }
    void add(const CommandReference& command) {
        all_.push_back(&command);
        for (const CommandReference& inner : command.inner)
            add(inner);
    }
    [[nodiscard]] const CommandReference& at(const std::string& name) const {
        const CommandReference* found = find_command(program_, name);
        if (found == nullptr) throw std::runtime_error("no command " + name);
        return *found;
    }

    CLI::App app_{"The program"};
    Commands commands_;
    CommandReference program_;
    std::vector<const CommandReference*> all_;
};

Words names_of_options(const CommandReference& command) {
    Words names;
    for (const OptionReference& option : command.options)
        names.insert(names.end(), option.names.begin(), option.names.end());
    return names;
}

// Returns the words of a command line, split as by a shell, without the name of the program.
Words words_of(std::string_view line) {
    Words words{""};
    bool quoted = false;
    for (const char c : line) {
        if (c == '\'') {
            quoted = !quoted;
        } else if (c == ' ' && !quoted) {
            words.emplace_back();
        } else {
            words.back() += c;
        }
    }
    words.erase(words.begin());
    return words;
}

void count_visible(const CLI::App& app, std::size_t& count) {
    for (const CLI::Option* option : app.get_options({})) {
        const bool is_help = option == app.get_help_ptr() || option == app.get_help_all_ptr();
        if (!option->get_group().empty() && !is_help) ++count;
    }
    for (const CLI::App* inner : app.get_subcommands(std::function<bool(const CLI::App*)>{}))
        count_visible(*inner, count);
}

TEST_F(ReferenceHelp, HoldsEveryOptionThatTheParserHas) {
    std::size_t parsed = 0;
    count_visible(app_, parsed);
    std::size_t told = 0;
    for (const CommandReference* command : all_)
        told += command->options.size();
    EXPECT_EQ(told, parsed);
    EXPECT_GT(told, 150U);
    for (const CommandReference* command : all_) {
        const std::string all = help_of(*command, HelpExtent::all);
        for (const std::string& name : names_of_options(*command))
            EXPECT_THAT(all, HasSubstr(name)) << command->name;
    }
}

TEST_F(ReferenceHelp, SpeaksNoTypesOfTheParserAndFitsThePage) {
    for (const CommandReference* command : all_) {
        for (const HelpExtent extent : {HelpExtent::usual, HelpExtent::all}) {
            const std::string text = help_of(*command, extent);
            for (const char* type : {"INT", "FLOAT", "TEXT", " in [", "REQUIRED", "BOOLEAN"})
                EXPECT_THAT(text, Not(HasSubstr(type)))
                    << command->name << ": the option needs a row in value_words.cpp";
            std::istringstream lines(text);
            for (std::string line; std::getline(lines, line);)
                EXPECT_LE(line.size(), 80U) << command->name << ": " << line;
        }
    }
}

// 2026-11-26: COLUMNS was ignored.
TEST_F(ReferenceHelp, IsAsWideAsTheReaderAsks) {
    const auto widest_line = [&](const char* columns) {
        ::setenv("COLUMNS", columns, 1);
        std::istringstream lines(help_of(at("frame"), HelpExtent::all));
        ::unsetenv("COLUMNS");
        std::size_t widest = 0;
        for (std::string line; std::getline(lines, line);)
            widest = std::max(widest, line.size());
        return widest;
    };
    EXPECT_LE(widest_line("120"), 120U);
    EXPECT_GT(widest_line("120"), 100U);
    EXPECT_LE(widest_line("100000"), 160U) << "lines stay short enough to read";
    for (const char* unusable : {"", "wide", "100x", "-5"})
        EXPECT_LE(widest_line(unusable), 80U) << unusable;
}

TEST_F(ReferenceHelp, BeginsWithExamplesAndAtMostTenOptions) {
    for (const CommandReference* command : all_) {
        const std::string text = help_of(*command, HelpExtent::usual);
        if (!command->inner.empty() && !command->name.empty()) continue;
        EXPECT_LT(text.find("Examples:"), text.find("Usage:")) << command->name;
        const auto rows = static_cast<std::size_t>(
            std::ranges::count_if(command->options, [&](const OptionReference& option) {
                return option.place.empty() &&
                       text.find("\n  " + option.names.front()) != std::string::npos;
            }));
        EXPECT_LE(rows, most_usual_options)
            << command->name << ": name its usual options in command_guide.cpp";
    }
    EXPECT_THAT(help_of(at("frame"), HelpExtent::usual), HasSubstr("--help-all"));
    EXPECT_THAT(help_of(at("frame"), HelpExtent::usual), Not(HasSubstr("--curved-earth")));
    EXPECT_THAT(help_of(at("frame"), HelpExtent::usual), HasSubstr("Default: the latest grid."));
    EXPECT_THAT(help_of(at("loop"), HelpExtent::all), HasSubstr("From -3600 to 3600."));
}

TEST_F(ReferenceHelp, GuidesNameWhatThereIs) {
    for (const CommandGuide& guide : command_guides()) {
        const CommandReference& command = at(std::string(guide.command));
        EXPECT_LE(guide.usual.size(), most_usual_options) << guide.command;
        for (const std::string_view name : guide.usual)
            EXPECT_THAT(names_of_options(command), Contains(std::string(name))) << guide.command;
        for (const CommandExample& example : guide.examples) {
            EXPECT_EQ(example.line.find("stormcellar " + std::string(guide.command)), 0U)
                << example.line;
            EXPECT_EQ(example.what.back(), '.') << example.what;
        }
    }
}

TEST_F(ReferenceHelp, ExamplesAreCommandLinesThatTheParserTakes) {
    for (const CommandGuide& guide : command_guides()) {
        for (const CommandExample& example : guide.examples) {
            Words words = words_of(example.line);
            std::ranges::reverse(words);  // the parser takes words in reverse
            EXPECT_NO_THROW(app_.parse(words)) << example.line;
        }
    }
}

TEST_F(ReferenceHelp, WordsOfValuesAreThoseThatTheProgramTakes) {
    for (const std::string& name : find_value_word("--light", "frame")->values()) {
        render::Light light;
        EXPECT_TRUE(render::set_light(name, light)) << name;
    }
    EXPECT_EQ(find_value_word("--to", "info")->word, "FILE");
    EXPECT_EQ(find_value_word("--to", "loop")->word, "TIME");
    EXPECT_EQ(find_value_word("--no-such", "loop"), nullptr);
    EXPECT_THAT(find_value_word("--effect", "grid")->values(), Contains("cell_size=off"));
    EXPECT_THAT(find_value_word("--effect", "frame")->values(), Not(Contains("cell_size=off")));
    EXPECT_THAT(find_value_word("--colors", "frame")->values(), Contains("nws-reflectivity"));
}

TEST(Help, IsAskedForInThreeWays) {
    const auto flag = run({"catalog", "get", "--help"});
    EXPECT_EQ(flag.status, exit_done);
    EXPECT_THAT(flag.out, HasSubstr("stormcellar catalog get --station STATION"));
    EXPECT_EQ(run({"help", "catalog", "get"}).out, flag.out);
    EXPECT_EQ(run({"help"}).out, run({"--help"}).out);
    EXPECT_EQ(run({"help", "frame", "--all"}).out, run({"frame", "--help-all"}).out);
    EXPECT_THAT(run({"frame", "--help-all"}).out, HasSubstr("--curved-earth"));
}

// 2026-11-26: the usage of `frame` had one FILE, and its help named fixed defaults for a camera
// that is fitted to the echo.
TEST(Help, SaysWhatFrameTakesAndWhichViewItChooses) {
    for (const char* command : {"frame", "loop"}) {
        const std::string help = run({command, "--help-all"}).out;
        EXPECT_THAT(help,
                    HasSubstr(fmt::format("Usage: stormcellar {} [FILE...|DOMAIN] ", command)));
        EXPECT_THAT(help, HasSubstr("as fits the echo"));
        EXPECT_THAT(help, Not(HasSubstr("Default: 55.")));
    }
}

TEST(Help, IsOfferedWithOneClearLine) {
    const std::vector<std::pair<std::vector<std::string>, std::string>> mistakes = {
        {{"fram"}, "there is no command 'fram'; did you mean 'frame'?"},
        {{"help", "loop", "x"}, "there is no command 'loop x'"},
        {{"catalog", "lits"}, "there is no command 'catalog lits'; did you mean 'list'?"},
        {{"catalog"}, "a command is missing behind catalog"},
        {{"frame", "--prodct", "vil"}, "there is no option --prodct; did you mean '--product'?"},
        {{"frame", "--zzzzz"}, "there is no option --zzzzz\n"},
        {{"frame", "KTLX", "--width", "x"}, "--width must be a whole number, not 'x'"},
        {{"frame", "KTLX", "--zoom", "x"}, "--zoom must be a number, not 'x'"},
        {{"catalog", "get", "-o", "x"}, "--station STATION must be given"},
        {{"frame", "--cache"}, "--cache needs a value: --cache DIRECTORY"},
        {{"loop", "-o", "x.webp", "--last", "0"}, "--last must be 1 to 1000000, not 0"},
        {{"frame", "K", "--cache", "c", "--product", "volum", "-o", "x.png"},
         "there is no product 'volum'; did you mean 'volume'?"},
        {{"frame", "K", "--cache", "c", "--moment", "rfe", "-o", "x.png"}, "did you mean 'REF'?"},
        {{"frame", "K", "--cache", "c", "--colors", "nws-zdrr", "-o", "x.png"},
         "did you mean 'nws-zdr'?"},
        {{"frame", "K", "--cache", "c", "--colors", "smoth", "-o", "x.png"},
         "did you mean 'smooth'?"},
    };
    for (const auto& [words, said] : mistakes) {
        const auto told = run(words);
        EXPECT_EQ(told.status, exit_bad_usage) << said;
        EXPECT_THAT(told.err, HasSubstr("stormcellar: ")) << said;
        EXPECT_THAT(told.err, HasSubstr(said));
        EXPECT_LE(std::ranges::count(told.err, '\n'), 2) << told.err;
    }
}

}  // namespace
}  // namespace stormcellar::cli
