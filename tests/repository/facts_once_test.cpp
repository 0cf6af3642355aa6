// Tests that each fact is written once. A single file has the names of moments, and a single file
// has the names of products. No switch over an enumeration of the tables has a `default:`, which
// would let a forgotten case compile. The recipes of CONTRIBUTING.md name few files, which exist.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "grid/mosaic/time_interpolation.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/grid/method.h"
#include "stormcellar/grid/mosaic.h"
#include "stormcellar/level2/moment.h"
#include "stormcellar/render/product.h"
#include "tests/repository/text_of.h"
#include "tests/testing/data.h"

namespace stormcellar {
namespace {

namespace fs = std::filesystem;

// A source in two parts: its string literals, and its code with literals and comments blanked.
struct SplitSource {
    std::string code;
    std::vector<std::string> literals;
};

// Splits a source. Joins literals side by side, as the compiler does. Reads raw literals like other
// literals, because no raw literal has names.
SplitSource split_source(const std::string& text) {
    SplitSource split;
    bool goes_on = false;
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text.compare(at, 2, "//") == 0) {
            at = std::min(text.find('\n', at), text.size()) - 1;
            continue;
        }
        const char quote = text[at];
        const bool is_separator = quote == '\'' && at > 0 && std::isalnum(text[at - 1]) != 0;
        if ((quote != '"' && quote != '\'') || is_separator) {
            split.code += quote;
            if (std::isspace(static_cast<unsigned char>(quote)) == 0) goes_on = false;
            continue;
        }
        std::string literal;
        for (++at; at < text.size() && text[at] != quote; ++at) {
            literal += text[at];
            if (text[at] == '\\') literal += text[++at];
        }
        if (quote != '"') continue;
        if (goes_on) {
            split.literals.back() += literal;
        } else {
            split.literals.push_back(literal);
        }
        goes_on = true;
    }
    return split;
}

// Returns every source outside the tests, by its path from the root.
const std::map<std::string, SplitSource>& split_sources() {
    static const std::map<std::string, SplitSource> all = [] {
        std::map<std::string, SplitSource> found;
        for (const fs::path& folder : testing::folders_of_the_product()) {
            for (const fs::path& path : testing::sources_below(folder))
                found[fs::relative(path, testing::source_directory())] =
                    split_source(testing::text_of(path));
        }
        return found;
    }();
    return all;
}

std::string without_blanks_at_end(std::string text) {
    while (text.ends_with(' '))
        text.pop_back();
    return text;
}

// Returns the files in which a literal is one of the names, or holds two of the names side by side,
// as in a list typed by hand.
std::set<std::string> files_that_type(const std::vector<std::string>& names) {
    std::string any;
    for (const std::string& name : names)
        any += (any.empty() ? "" : "|") + name;
    const std::regex listed("\\b(" + any + ")( \\([a-z ]+\\))?(, | |/|\\|| or |, or )(" + any +
                            ")\\b");
    std::set<std::string> files;
    for (const auto& [path, source] : split_sources()) {
        for (const std::string& literal : source.literals) {
            const bool is_name = std::ranges::count(names, without_blanks_at_end(literal)) > 0;
            if (is_name || std::regex_search(literal, listed)) files.insert(path);
        }
    }
    return files;
}

TEST(FactsOnce, NamesOfMomentsStandInOneFile) {
    std::vector<std::string> names;
    for (const level2::MomentFacts& facts : level2::moment_facts)
        names.emplace_back(facts.name);
    auto files = files_that_type(names);
    files.erase("render/map/labels.cpp");  // "SW" is southwest there
    EXPECT_EQ(files, std::set<std::string>{"include/stormcellar/level2/moment.h"});
}

TEST(FactsOnce, NamesOfProductsStandInOneFile) {
    std::vector<std::string> names;
    for (const render::ProductFacts& facts : render::all_products()) {
        // "volume" and "section" have other meanings, too, such as tables and keys of scene files.
        if (facts.name != "volume" && facts.name != "section") names.emplace_back(facts.name);
    }
    auto files = files_that_type(names);
    files.erase("export/grid_gltf.cpp");  // "mesh" is a key of glTF there
    EXPECT_EQ(files, std::set<std::string>{"render/view/product.cpp"});
}

TEST(FactsOnce, NoProjectionIsListedByHand) {
    EXPECT_EQ(files_that_type({"azimuthal_equidistant", "lambert_conformal"}),
              (std::set<std::string>{"export/cf_attributes.cpp",  // names of the CF conventions
                                     "include/stormcellar/grid/grid_spec.h"}));
}

// Returns the sources of the page with two of the names side by side, as in a list or a record
// typed by hand. A single name is allowed, because code needs it to ask facts.ts.
std::set<std::string> files_of_the_page_that_list(const std::string& names) {
    const std::regex listed(R"(\b()" + names + R"()\b['"`]?( ?:[^;]{0,60}?)?\s*[,|/]\s*['"`]?()" +
                            names + R"()\b)");
    const fs::path root = testing::source_directory() / "viewer" / "src";
    std::set<std::string> files;
    for (const fs::path& path : testing::files_below(root)) {
        if (path.extension() != ".ts" || testing::is_viewer_test(path)) continue;
        const std::string code = testing::without_comments(testing::text_of(path));
        if (std::regex_search(code, listed)) files.insert(fs::relative(path, root));
    }
    return files;
}

// tests/repository/viewer_facts_test.cpp writes facts.ts from the tables.
TEST(FactsOnce, ThePageListsNamesInItsFactsAlone) {
    EXPECT_EQ(files_of_the_page_that_list("REF|VEL|SW|ZDR|PHI|RHO|CFP"),
              (std::set<std::string>{"facts.ts", "tables/pal_file.ts"}))
        << "pal_file.ts writes the words of .pal files";
    EXPECT_EQ(files_of_the_page_that_list("azimuthal_equidistant|lambert_conformal"
                                          "|latitude_longitude"),
              std::set<std::string>{"facts.ts"});
    EXPECT_EQ(files_of_the_page_that_list("composite|ppi|cappi|echotop|vil"),
              std::set<std::string>{});
}

// Returns the text from an opening bracket to its closing bracket, both included.
std::string in_brackets(const std::string& code, std::size_t at, char open, char close) {
    int depth = 0;
    for (std::size_t end = at; end < code.size(); ++end) {
        if (code[end] == open) ++depth;
        if (code[end] == close && --depth == 0) return code.substr(at, end + 1 - at);
    }
    return code.substr(at);
}

// Returns the bodies of all switches, without the bodies of switches inside them.
std::vector<std::string> switches_of(const std::string& code) {
    static const std::regex keyword(R"(\bswitch\s*\()");
    std::vector<std::string> bodies;
    for (std::sregex_iterator at(code.begin(), code.end(), keyword), end; at != end; ++at) {
        const auto condition_at = static_cast<std::size_t>(at->position() + at->length() - 1);
        const std::string condition = in_brackets(code, condition_at, '(', ')');
        const std::size_t body_at = code.find('{', condition_at + condition.size());
        if (body_at == std::string::npos) continue;
        bodies.push_back(in_brackets(code, body_at, '{', '}'));
    }
    return bodies;
}

const std::regex case_of_a_table(
    R"(\bcase\s+(\w+::)*(Moment|Circle|Blending|Product|View|Projection|Interpolation|CellExtent|Averaging|Overlap|TimeMethod)::)");

bool has_default_over_a_table(const std::string& code) {
    static const std::regex fallback(R"(\bdefault\s*:)");
    return std::ranges::any_of(switches_of(code), [](const std::string& body) {
        return std::regex_search(body, case_of_a_table) && std::regex_search(body, fallback);
    });
}

TEST(FactsOnce, NoDefaultLetsAForgottenCaseCompile) {
    std::size_t switches = 0;
    for (const auto& [path, source] : split_sources()) {
        EXPECT_FALSE(has_default_over_a_table(source.code)) << path;
        for (const std::string& body : switches_of(source.code))
            switches += std::regex_search(body, case_of_a_table) ? 1 : 0;
    }
    EXPECT_GE(switches, 8U) << "too few switches were found";
}

TEST(FactsOnce, TheCheckSeesWhatItLooksFor) {
    const auto split = split_source(
        "// \"REF\"\nf(\"VEL, \"\n  \"SW\", 1'000, '\"'); switch (a(b)) { case x::Moment::ref: "
        "default: break; }");
    EXPECT_EQ(split.literals, std::vector<std::string>{"VEL, SW"});
    EXPECT_TRUE(has_default_over_a_table(split.code));
    EXPECT_FALSE(has_default_over_a_table("switch (a) { case Moment::ref: break; } default:"));
    EXPECT_GT(split_sources().size(), 500U);
}

// Counts the enumerators of an enumeration, by its text.
std::size_t enumerators_in(const std::string& header, const std::string& name) {
    const std::string& code = split_sources().at(header).code;
    const std::regex definition("enum class " + name + R"( [^{;]*\{([^}]*)\})");
    std::smatch match;
    if (!std::regex_search(code, match, definition)) return 0;
    static const std::regex enumerator(R"(\w+\s*(= \d+)?\s*(,|$))");
    const std::string list = match[1];
    return static_cast<std::size_t>(
        std::distance(std::sregex_iterator(list.begin(), list.end(), enumerator), {}));
}

TEST(FactsOnce, EveryEnumeratorHasARow) {
    EXPECT_EQ(enumerators_in("include/stormcellar/level2/moment.h", "Moment"),
              level2::moment_facts.size());
    EXPECT_EQ(enumerators_in("include/stormcellar/render/product.h", "Product"),
              render::all_products().size());
    EXPECT_EQ(enumerators_in("include/stormcellar/grid/grid_spec.h", "Projection"),
              grid::projection_facts.size());
    EXPECT_EQ(enumerators_in("include/stormcellar/grid/method.h", "Interpolation"),
              grid::interpolation_facts.size());
    EXPECT_EQ(enumerators_in("include/stormcellar/grid/mosaic.h", "Overlap"),
              grid::overlap_facts.size());
    EXPECT_EQ(enumerators_in("grid/mosaic/time_interpolation.h", "TimeMethod"),
              grid::time_method_facts.size());
}

// Returns the files in the numbered list below the heading of a recipe.
std::vector<std::string> files_of_recipe(const std::string& thing) {
    const fs::path root = testing::source_directory();
    std::ifstream file(root / "CONTRIBUTING.md");
    bool is_inside = false;
    std::vector<std::string> files;
    static const std::regex step(R"(^\d+\. `([^`]+)`)");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("#")) is_inside = line.ends_with("Add a " + thing);
        std::smatch match;
        if (is_inside && std::regex_search(line, match, step)) files.push_back(match[1]);
    }
    return files;
}

TEST(FactsOnce, RecipesNameFewFilesAndTheyExist) {
    const std::map<std::string, std::size_t> most = {{"moment", 4},
                                                     {"product", 4},
                                                     {"projection", 6},
                                                     {"gridding method", 6},
                                                     {"picture option", 4},
                                                     {"unit", 4},
                                                     {"layer of the viewer", 4},
                                                     {"subcommand", 4},
                                                     {"grid export format", 4},
                                                     {"loop format", 5}};
    for (const auto& [thing, count] : most) {
        const auto files = files_of_recipe(thing);
        EXPECT_FALSE(files.empty()) << thing;
        EXPECT_LE(files.size(), count) << thing;
        for (const std::string& file : files) {
            const bool is_new = file.find("NAME") != std::string::npos;
            EXPECT_TRUE(is_new || fs::exists(testing::source_directory() / file))
                << thing << ": " << file;
        }
    }
}

}  // namespace
}  // namespace stormcellar
