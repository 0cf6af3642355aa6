#include "base/toml_file.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/testing/temporary_directory.h"

namespace stormcellar {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TomlFile file_of(std::string_view text) {
    auto file = TomlFile::parse(text, "s.toml");
    if (!file) throw std::runtime_error(file.error().message);
    return std::move(*file);
}

std::string complaint(TomlFile& file) {
    const Status finished = file.finish();
    if (finished) return "";
    EXPECT_EQ(finished.error().code, ErrorCode::bad_argument);
    return finished.error().message;
}

TEST(TomlFile, GivesWhatIsThere) {
    TomlFile file = file_of(
        "title = \"a\"\n[grid]\nspacing = 0.5\ncount = 3\nlevels = [1, 2.5]\n[grid.inner]\nx = 1\n"
        "[[storm]]\npeak = 50\n[storm.hook]\nwidth = 2\n[[storm]]\npeak = 60\n");
    TomlTable root = file.root();
    EXPECT_EQ(root.text("title"), "a");
    auto grid = root.table("grid");
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->number("spacing", {0, 1}), 0.5);
    EXPECT_EQ(grid->whole_number("count", {3, 3}), 3);
    EXPECT_TRUE(grid->is_array("levels"));
    EXPECT_FALSE(grid->is_array("count"));
    EXPECT_THAT(*grid->numbers("levels"), ElementsAre(1, 2.5));
    EXPECT_EQ(grid->table("inner")->number("x", {0, 1}), 1);
    auto storms = root.tables("storm");
    ASSERT_EQ(storms.size(), 2U);
    EXPECT_EQ(storms[0].number("peak", {0, 100}), 50);
    EXPECT_EQ(storms[0].table("hook")->number("width", {0, 9}), 2);
    EXPECT_EQ(storms[1].number("peak", {0, 100}), 60);
    EXPECT_FALSE(storms[1].has("hook"));
    EXPECT_EQ(complaint(file), "");
}

TEST(TomlFile, GivesFlags) {
    TomlFile file = file_of("yes = true\nno = false\n");
    EXPECT_EQ(file.root().flag("yes"), true);
    EXPECT_EQ(file.root().flag("no"), false);
    EXPECT_FALSE(file.root().flag("maybe"));
    EXPECT_EQ(complaint(file), "");
    TomlFile number = file_of("yes = 1\n");
    EXPECT_FALSE(number.root().flag("yes"));
    EXPECT_THAT(complaint(number), HasSubstr("s.toml:1: yes: must be true or false"));
}

TEST(TomlFile, GivesTextsOfAnArrayOfNothingElse) {
    TomlFile file = file_of("a = [\"x\", \"y\"]\nb = []\n");
    EXPECT_THAT(*file.root().texts("a"), ElementsAre("x", "y"));
    EXPECT_TRUE(file.root().texts("b")->empty());
    EXPECT_FALSE(file.root().texts("c"));
    EXPECT_EQ(complaint(file), "");
    TomlFile mixed = file_of("a = [\"x\", 1]\n");
    EXPECT_FALSE(mixed.root().texts("a"));
    EXPECT_THAT(complaint(mixed), HasSubstr("must be an array of texts, holds a number"));
    TomlFile other = file_of("a = \"x\"\n");
    EXPECT_FALSE(other.root().texts("a"));
    EXPECT_THAT(complaint(other), HasSubstr("an array of texts"));
}

TEST(TomlFile, WhatIsAbsentIsNone) {
    TomlFile file = file_of("");
    TomlTable root = file.root();
    EXPECT_FALSE(root.text("a"));
    EXPECT_FALSE(root.number("a", {0, 1}));
    EXPECT_FALSE(root.whole_number("a", {0, 1}));
    EXPECT_FALSE(root.numbers("a"));
    EXPECT_FALSE(root.table("a"));
    EXPECT_TRUE(root.tables("a").empty());
    TomlTable section = root.section("a");
    EXPECT_FALSE(section.number("b", {0, 1}));
    EXPECT_EQ(complaint(file), "");
    section.complain("b", "is missing");
    EXPECT_EQ(complaint(file), "s.toml: [a] b: is missing");
}

TEST(TomlFile, TheWrongKindIsNamed) {
    const auto expect = [](const std::string& value, const auto& read, const std::string& what) {
        TomlFile file = file_of("[t]\n\nk = " + value + "\n");
        TomlTable table = *file.root().table("t");
        read(table);
        EXPECT_EQ(complaint(file), "s.toml:3: [t] k: " + what);
    };
    const auto number = [](TomlTable& t) { EXPECT_FALSE(t.number("k", {0, 1})); };
    const auto whole = [](TomlTable& t) { EXPECT_FALSE(t.whole_number("k", {0, 1})); };
    const auto text = [](TomlTable& t) { EXPECT_FALSE(t.text("k")); };
    const auto numbers = [](TomlTable& t) { EXPECT_FALSE(t.numbers("k")); };
    const auto table = [](TomlTable& t) { EXPECT_FALSE(t.table("k")); };
    const auto tables = [](TomlTable& t) { EXPECT_TRUE(t.tables("k").empty()); };
    expect("true", number, "must be a number, is true or false");
    expect("1.5", number, "1.5 is out of range, must be 0 to 1");
    expect("nan", number, "nan is out of range, must be 0 to 1");
    expect("1.0", whole, "must be a whole number, is a number");
    expect("9000000000000000000", whole, "9e+18 is out of range, must be 0 to 1");
    expect("1", text, "must be text in quotes, is a number");
    expect("1", numbers, "must be an array of numbers, is a number");
    expect("[1, \"2\"]", numbers, "must be an array of numbers, holds text");
    expect("[]", table, "must be a section: [t.k], is an array");
    expect("2024-06-01", tables, "must be sections: [[t.k]], is a date or time");
}

TEST(TomlFile, WhatNobodyAskedForIsNamed) {
    for (const auto& [text, message] : {std::pair{"[t]\nk = 1\n", "s.toml:2: unknown key [t] k"},
                                        {"k = 1\n", "s.toml:1: unknown key k"},
                                        {"[u]\nk = 1\n", "s.toml:1: unknown section [u]"},
                                        {"[t.u]\nk = 1\n", "s.toml:1: unknown section [t.u]"},
                                        {"[[u]]\nk = 1\n", "s.toml:1: unknown section [[u]]"},
                                        {"\"a\\nb\" = 1\n", "s.toml:1: unknown key a\\x0ab"}}) {
        TomlFile file = file_of(text);
        (void)file.root().table("t");
        EXPECT_EQ(complaint(file), message);
    }
}

TEST(TomlFile, TheEarliestLineIsNamed) {
    TomlFile file = file_of("a = 1\nb = 2\nc = 3\n");
    (void)file.root().text("c");
    (void)file.root().text("b");
    (void)file.root().number("a", {0, 1});
    EXPECT_THAT(complaint(file), StartsWith("s.toml:2: b: "));
}

TEST(TomlFile, AMisspeltKeyIsNamedBeforeTheOneThatIsMissing) {
    const auto read = [](std::string_view text) {
        TomlFile file = file_of(text);
        for (TomlTable& loop : file.root().tables("loop"))
            if (!loop.text("name")) loop.complain("name", "must be there");
        return complaint(file);
    };
    EXPECT_EQ(read("[[loop]]\nnam = \"a\"\n"), "s.toml:2: unknown key [loop] nam");
    EXPECT_EQ(read("[[loop]]\n[[loop]]\nname = \"a\"\nnam = 1\n"),
              "s.toml:1: [loop] name: must be there")
        << "the unknown key is in another table";
    EXPECT_EQ(read("[[loop]]\ntitle = \"a\"\n"), "s.toml:1: [loop] name: must be there")
        << "the unknown key is not similar";
    EXPECT_EQ(read("[[loop]]\ntitle = \"a\"\nmane = \"a\"\n"), "s.toml:3: unknown key [loop] mane");
    EXPECT_EQ(read("[[loop]]\nname = \"a\"\n"), "");
}

TEST(TomlFile, AMisspeltSectionIsNamedBeforeWhatIsMissingInIt) {
    const auto read = [](std::string_view text) {
        TomlFile file = file_of(text);
        TomlTable root = file.root();
        TomlTable paths = root.section("paths");
        if (!paths.text("drop")) paths.complain("drop", "must be there");
        return complaint(file);
    };
    EXPECT_EQ(read("[path]\ndrop = \"a\"\n"), "s.toml:1: unknown section [path]");
    EXPECT_EQ(read("drop = \"a\"\n"), "s.toml:1: unknown key drop");
    EXPECT_EQ(read("paths = 3\n"), "s.toml:1: paths: must be a section: [paths], is a number");
    EXPECT_EQ(read("[ingset]\nworkers = 3\n"), "s.toml: [paths] drop: must be there");
    EXPECT_EQ(read("[paths]\ndrip = \"a\"\n"), "s.toml:2: unknown key [paths] drip");
}

TEST(TomlFile, WhatIsNotTomlNamesTheLine) {
    for (const char* text : {"a = 1\nb = \n", "a = 1\na = 2\n", "a = 1\n[b\n"}) {
        const auto file = TomlFile::parse(text, "s.toml");
        ASSERT_FALSE(file);
        EXPECT_EQ(file.error().code, ErrorCode::bad_argument);
        EXPECT_THAT(file.error().message, StartsWith("s.toml:2: not valid TOML: "));
        EXPECT_EQ(file.error().message.find('\n'), std::string::npos);
    }
}

TEST(TomlFile, BytesThatAreNotTextAreRefused) {
    const auto file = TomlFile::parse("a = \"\xFF\"", "s.toml");
    ASSERT_FALSE(file);
    EXPECT_THAT(file.error().message, StartsWith("s.toml:1: not valid TOML: "));
}

TEST(TomlFile, WhatCannotBeReadIsNamed) {
    const testing::TemporaryDirectory directory;
    const auto missing = TomlFile::open(directory / "none.toml");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::not_found);
    EXPECT_THAT(missing.error().message, HasSubstr("none.toml"));
}

}  // namespace
}  // namespace stormcellar
