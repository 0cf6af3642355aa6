// Tests that functions outside the tests have at most 60 lines, from the first line of the head to
// the closing brace. The test Repository.Format enforces clang-format's layout, so indents show
// where functions end. A function in a namespace goes from a line without indent to a line "}". A
// function in a class goes from a line with an indent of four to a line "    }". A block with this
// indent inside a function is measured, too, but cannot be longer than the function. A TypeScript
// function may also be a constant, which ends with "};". Shaders have the layout of C++.
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/repository/text_of.h"
#include "tests/testing/data.h"

namespace stormcellar {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_lines = 60;

struct LongFunction {
    std::size_t line, lines;  // first line, and number of lines
    std::string head;
};

// Returns true if the line has exactly `indent` spaces before its text, and is neither a comment
// nor a directive.
bool begins_at(const std::string& line, std::size_t indent) {
    return line.find_first_not_of(' ') == indent && line[indent] != '/' && line[indent] != '#';
}

// Finds the functions with this indent that are longer than `most` lines.
std::vector<LongFunction> long_functions(const std::string& text, std::size_t indent,
                                         std::size_t most) {
    std::vector<LongFunction> found;
    std::istringstream lines(text);
    LongFunction last{};
    const std::string end = std::string(indent, ' ') + "}";
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        const bool ends_constant = line == end + ";" && last.head.find("=>") != std::string::npos;
        const bool is_class =
            last.head.starts_with("class ") || last.head.starts_with("export class ");
        if ((line == end || ends_constant) && last.line > 0 && !is_class) {
            last.lines = number - last.line + 1;
            if (last.lines > most) found.push_back(last);
        }
        if (begins_at(line, indent)) last = {number, 0, line};
    }
    return found;
}

TEST(FunctionLength, NoFunctionIsLongerThanSixtyLines) {
    const fs::path root = testing::source_directory();
    std::size_t sources = 0;
    for (const fs::path& folder : testing::folders_of_the_product()) {
        for (const fs::path& path : testing::files_below(folder)) {
            const auto ending = path.extension();
            if (ending == ".ts" && testing::is_viewer_test(path)) continue;
            if (path.string().starts_with((root / "viewer" / "third_party").string())) continue;
            if (ending != ".h" && ending != ".cpp" && ending != ".ts" && ending != ".glsl")
                continue;
            ++sources;
            const std::string text = testing::text_of(path);
            for (const std::size_t indent : {0, 4}) {
                for (const LongFunction& function : long_functions(text, indent, most_lines)) {
                    ADD_FAILURE() << fs::relative(path, root).string() << ":" << function.line
                                  << ": " << function.lines << " lines, not " << most_lines << ": "
                                  << function.head;
                }
            }
        }
    }
    EXPECT_GE(sources, 1100U);
}

TEST(FunctionLength, AFunctionIsMeasuredFromItsHeadToItsBrace) {
    const std::string text =
        "namespace a {\n"
        "\n"
        "// A comment.\n"
        "int first(int x,\n"
        "          int y) {\n"
        "    if (x < y) {\n"
        "        ++x;\n"
        "    }\n"
        "    return x;\n"
        "}\n"
        "class B {\n"
        "  public:\n"
        "    int second() {\n"
        "        int x = 1;\n"
        "        return x;\n"
        "    }\n"
        "};\n"
        "void third() {\n"
        "}\n"
        "}  // namespace a\n";
    const auto outer = long_functions(text, 0, 6);
    ASSERT_EQ(outer.size(), 1U);
    EXPECT_EQ(outer[0].line, 4U);
    EXPECT_EQ(outer[0].lines, 7U);
    EXPECT_EQ(outer[0].head, "int first(int x,");
    EXPECT_TRUE(long_functions(text, 0, 7).empty());
    const auto inner = long_functions(text, 4, 3);
    ASSERT_EQ(inner.size(), 1U);
    EXPECT_EQ(inner[0].line, 13U);
    EXPECT_EQ(inner[0].lines, 4U);
}

}  // namespace
}  // namespace stormcellar
