#include "base/toml_depth.h"

#include <string>

#include <gtest/gtest.h>

#include "base/toml_file.h"

namespace stormcellar {
namespace {

std::string key_of(int parts, const std::string& part = "a") {
    std::string key = part;
    for (int i = 1; i < parts; ++i)
        key += "." + part;
    return key;
}

TEST(TomlDepth, KeysAndSectionsHaveSoManyPartsAtMost) {
    for (const std::string part : {"a", "\"a\"", "'a.b'", " a "}) {
        const std::string most = key_of(most_key_parts, part);
        const std::string more = key_of(most_key_parts + 1, part);
        EXPECT_EQ(line_of_deep_key("[" + most + "]\n" + most + " = 1\n"), std::nullopt) << part;
        EXPECT_EQ(line_of_deep_key("a = 1\n" + more + " = 1\n"), 2U) << part;
        EXPECT_EQ(line_of_deep_key("\n\n[" + more + "]\n"), 3U) << part;
        EXPECT_EQ(line_of_deep_key("[[" + more + "]]"), 1U) << part;
        EXPECT_EQ(line_of_deep_key("a = {b = 1, " + more + " = 1}"), 1U) << part;
        EXPECT_EQ(line_of_deep_key("a = [\n{" + more + " = 1}]"), 2U) << part;
    }
}

TEST(TomlDepth, DotsOfNumbersStringsAndCommentsAreNone) {
    std::string numbers = "a = [";
    for (int i = 0; i < 1000; ++i)
        numbers += "1.5, ";
    const std::string dots(1000, '.');
    for (const std::string& text :
         {numbers + "]", "a = \"" + dots + "\\\"" + dots + "\"", "a = '" + dots + "'",
          "# it's " + dots + "\na = 1 # " + dots, "a = \"\"\"\n" + dots + "\"\n" + dots + "\"\"\"",
          "a = '''\n" + dots + "''" + dots + "'''", "\"" + dots + "\".b = 1"}) {
        EXPECT_EQ(line_of_deep_key(text), std::nullopt) << text;
        EXPECT_TRUE(TomlFile::parse(text, "s.toml")) << text;
    }
}

// If we and the parser disagreed about the end of a string, a deep key could remain unnoticed.
TEST(TomlDepth, StringsEndWhereTheParserEndsThem) {
    const std::string deep = "\n" + key_of(100) + " = 1\n";
    for (const std::string before :
         {"a = \"\"", "a = ''", "a = \"\\\\\"", "a = '\\'", "a = \"\"\"\"\"\"",
          "a = \"\"\"\"\"\"\"\"", "a = '''''b'''''", "a = \"\"\"\\\"\"\"\"",
          "a = \"\"\"b\\\\\"\"\"", "a = \"'\" # \"", "\"\".'' = 1"}) {
        EXPECT_TRUE(TomlFile::parse(before, "s.toml")) << before;
        EXPECT_TRUE(line_of_deep_key(before + deep)) << before;
    }
}

// 2026-11-25: a key of too many parts crashed the process, even if the file had a mistake after it.
TEST(TomlDepth, AKeyThatWouldEndTheProcessIsRefused) {
    const std::string deep = key_of(400'000);
    for (const std::string& text :
         {"b = 1\n" + deep + " = 1\n", "b = 1\n[" + deep + "]\n", "b = 1\n" + deep + " = \n",
          "b = 1\nc = {" + deep + " = 1}\n"}) {
        const auto file = TomlFile::parse(text, "s.toml");
        ASSERT_FALSE(file);
        EXPECT_EQ(file.error().code, ErrorCode::bad_argument);
        EXPECT_EQ(file.error().message, "s.toml:2: a key has more than 16 parts");
    }
}

}  // namespace
}  // namespace stormcellar
