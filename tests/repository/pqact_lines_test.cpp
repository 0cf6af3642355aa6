// Tests that the lines for LDM's pqact.conf in docs/guides/ldm.md do what the page promises.
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/testing/data.h"

namespace stormcellar {
namespace {

struct Entry {
    std::string pattern;
    std::vector<std::string> action;  // separated by tabs: FILE or PIPE, options, path or command
};

std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream text(line);
    for (std::string field; std::getline(text, field, '\t');)
        if (!field.empty()) fields.push_back(field);
    return fields;
}

// Returns the entries. The first line of an entry has feed and pattern; the second has a tab and
// the action.
std::vector<Entry> entries() {
    std::ifstream file(testing::source_directory() / "docs/guides/ldm.md");
    std::vector<Entry> found;
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("NEXRAD2\t")) continue;
        const std::vector<std::string> head = split(line);
        std::string action;
        EXPECT_TRUE(std::getline(file, action) && action.starts_with("\t")) << line;
        if (head.size() == 2) found.push_back({head[1], split(action)});
    }
    return found;
}

// Expands a text as pqact does: \1 to \9 become the groups of the match.
std::string expanded(const std::string& text, const std::smatch& caught) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\\' && i + 1 < text.size()) {
            result += caught[static_cast<std::size_t>(text[++i] - '0')];
        } else {
            result += text[i];
        }
    }
    return result;
}

// Returns the path or command of each entry whose pattern, an extended regular expression, matches
// the product.
std::multiset<std::string> places(const std::string& product) {
    std::multiset<std::string> found;
    for (const Entry& entry : entries()) {
        const std::regex pattern(entry.pattern, std::regex::extended);
        std::smatch caught;
        if (std::regex_search(product, caught, pattern))
            found.insert(expanded(entry.action.back(), caught));
    }
    return found;
}

const std::string drop = "/var/spool/ldm/nexrad2/KFTG/";

TEST(PqactLines, PutAChunkWhereTheManualSays) {
    EXPECT_EQ(entries().size(), 5U) << "the page has four ways, and one way has two entries";
    EXPECT_EQ(places("L2-BZIP2/KFTG/20150908215946/494/43/I/V06/0"),
              (std::multiset<std::string>{
                  drop + "KFTG20150908215946_V06", drop + "KFTG20150908215946_V06",
                  drop + ".KFTG20150908215946_V06", drop + "494/20150908-215946-43-I"}));
    const std::string script = "/usr/local/bin/finish-volume ";
    EXPECT_EQ(places("L2-BZIP2/KFTG/20150908215946/494/55/E/V06/0"),
              (std::multiset<std::string>{
                  drop + "KFTG20150908215946_V06", drop + "KFTG20150908215946_V06",
                  script + drop.substr(0, drop.size() - 1) + " KFTG20150908215946_V06",
                  drop + "494/20150908-215946-55-E"}));
    EXPECT_TRUE(places("SDUS54 KFTG 082159 /pNCRFTG").empty()) << "the product is of another feed";
}

}  // namespace
}  // namespace stormcellar
