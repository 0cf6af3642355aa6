// Tests the reference of a small program; tests/packaging/check-reference compares the real
// reference with --help.
#include "cli/reference/reference.h"

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stormcellar::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class Reference : public ::testing::Test {
  protected:
    void SetUp() override {
        CLI::App* draw = app_.add_subcommand("draw", "Draw it. At once");
        draw->add_option("--scene", scene_, "A file that's [read]")->group("Picture");
        draw->add_option("-o,--output", output_, "Where to; any number")->required();
        draw->add_option("--as", as_, "How")->check(CLI::IsMember({"whole", "growing"}));
        draw->add_option("--last", last_, "So many")->check(CLI::Range(1, 9));
        draw->add_option("DOMAIN,--domain", domain_, "Whose");
        draw->add_flag("--json", json_, "One document");
        draw->add_option("--secret", secret_, "Not shown")->group("");
        draw->add_option_group("The grid")->add_option("--spacing", scene_, ".5 by default");
        CLI::App* keep = app_.add_subcommand("keep", "Keep things");
        keep->add_subcommand("list", "Say what there is");
    }
    [[nodiscard]] const OptionReference& option(const std::string& name) const {
        for (const OptionReference& one : reference_.inner.at(0).options) {
            for (const std::string& its : one.names) {
                if (its == name) return one;
            }
        }
        throw std::runtime_error("no option " + name);
    }
    void read() { reference_ = reference_of(app_); }

    CLI::App app_{"The program"};
    CommandReference reference_;
    std::string scene_, output_, as_, domain_, secret_;
    int last_ = 0;
    bool json_ = false;
};

TEST_F(Reference, HoldsWhatTheParserKnows) {
    read();
    ASSERT_EQ(reference_.inner.size(), 2U);
    EXPECT_EQ(reference_.inner[0].name, "draw");
    EXPECT_EQ(reference_.inner[1].inner.at(0).name, "keep list");
    EXPECT_THAT(option("-o").names, ElementsAre("-o", "--output"));
    EXPECT_TRUE(option("-o").is_required);
    EXPECT_THAT(option("--as").choices, ElementsAre("whole", "growing"));
    EXPECT_EQ(option("--last").range, "1 to 9");
    EXPECT_EQ(option("--last").value, "N") << "the value is not called UINT";
    EXPECT_EQ(option("--scene").value, "FILE");
    EXPECT_EQ(option("--domain").kept, Kept::domains);
    EXPECT_EQ(option("--domain").place, "DOMAIN");
    EXPECT_EQ(option("--json").value, "");
    EXPECT_EQ(option("--spacing").group, "The grid");
    EXPECT_THROW((void)option("--secret"), std::runtime_error);
    EXPECT_THROW((void)option("--help"), std::runtime_error);
    // Groups follow the options without a group, although --scene came first.
    EXPECT_EQ(reference_.inner[0].options.front().names.front(), "-o");
    EXPECT_EQ(reference_.inner[0].options.back().names.front(), "--spacing");
}

TEST_F(Reference, TheManualSaysThemAsRoff) {
    read();
    const std::string page = manual_of(reference_);
    EXPECT_THAT(page,
                HasSubstr(".SS \"stormcellar draw [DOMAIN] [OPTIONS]\"\nDraw it. At once.\n"));
    EXPECT_THAT(page, HasSubstr("\\fB\\-o\\fR, \\fB\\-\\-output\\fR \\fIFILE\\fR\nWhere to; any "
                                "number.\nMust be given.\n"));
    EXPECT_THAT(page, HasSubstr("\\fB\\-\\-as\\fR \\fBwhole|growing\\fR\n"));
    EXPECT_THAT(page, HasSubstr("From 1 to 9.\n"));
    EXPECT_THAT(page, HasSubstr("\n\\&.5 by default.\n"))
        << "a line that begins with a dot must not be a roff request";
    EXPECT_THAT(page, Not(HasSubstr("secret")));
}

TEST_F(Reference, ShellsAreGivenThemQuoted) {
    read();
    EXPECT_THAT(bash_completion_of(reference_), HasSubstr("--as) choices='whole growing' ;;"));
    EXPECT_THAT(bash_completion_of(reference_), HasSubstr("'draw'|'keep'|'keep list') command="));
    EXPECT_THAT(zsh_completion_of(reference_),
                HasSubstr("'*--scene=[A file that'\\''s \\[read\\]]:FILE:_files'"));
    EXPECT_THAT(zsh_completion_of(reference_), HasSubstr("(whole growing)"));
    EXPECT_THAT(fish_completion_of(reference_),
                HasSubstr("-l scene -r -F -d 'A file that\\'s [read]'"));
    EXPECT_THAT(bash_completion_of(reference_), HasSubstr("--domain) kept=domains ;;"));
    EXPECT_THAT(zsh_completion_of(reference_), HasSubstr(":DOMAIN: _stormcellar_names domains'"));
    EXPECT_THAT(fish_completion_of(reference_),
                HasSubstr("-l domain -x -a '(__stormcellar_names domains)'"));
    EXPECT_THAT(fish_completion_of(reference_), HasSubstr("-l as -x -a 'whole growing' -d 'How'"));
}

TEST_F(Reference, IsAskedForByName) {
    for (const char* kind : {"man", "bash", "zsh", "fish"})
        EXPECT_TRUE(reference_text(app_, kind)) << kind;
    EXPECT_FALSE(reference_text(app_, "csh"));
}

}  // namespace
}  // namespace stormcellar::cli
