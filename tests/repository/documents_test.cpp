// Tests that links of documents resolve, that files named in documents exist, and that documents
// named by installed files are installed.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/repository/text_of.h"
#include "tests/testing/data.h"

namespace stormcellar {
namespace {

namespace fs = std::filesystem;

// Documents outside of docs/. cmake/Install.cmake installs them, and docs/, with the same relative
// paths as in the tree.
const std::vector<fs::path> single_documents = {"README.md", "CONTRIBUTING.md", "GLOSSARY.md",
                                                "bunzip/README.md"};

bool is_installed(const fs::path& path) {
    return *path.begin() == "docs" || std::ranges::count(single_documents, path) > 0;
}

// Returns the installed documents, from the root of the source tree.
std::vector<fs::path> documents() {
    std::vector<fs::path> found = single_documents;
    const fs::path root = testing::source_directory();
    for (const auto& entry : fs::recursive_directory_iterator(root / "docs"))
        if (entry.path().extension() == ".md") found.push_back(fs::relative(entry.path(), root));
    return found;
}

// Returns a document without its blocks of code, which hold no links.
std::string without_code(const std::string& text) {
    std::string rest;
    bool is_code = false;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const bool is_fence = line.starts_with("```");
        if (!is_fence && !is_code) rest += line + "\n";
        is_code = is_code != is_fence;
    }
    return rest;
}

struct Link {
    fs::path file;  // from the root of the source tree
    std::string heading;
};

// Returns the links of a document to files of the repository.
std::vector<Link> links_of(const fs::path& document) {
    static const std::regex link(R"(\]\(([^)\s]+)\))");
    std::vector<Link> links;
    const std::string text = without_code(testing::text_of(testing::source_directory() / document));
    for (const std::string& target : testing::found_in(text, link)) {
        if (target.find("://") != std::string::npos) continue;
        const std::size_t hash = target.find('#');
        const std::string file = target.substr(0, hash);
        links.push_back(
            {file.empty() ? document : (document.parent_path() / file).lexically_normal(),
             hash == std::string::npos ? "" : target.substr(hash + 1)});
    }
    return links;
}

// Returns the anchors of a document's headings. Anchors are in lower case, with "-" for blanks and
// without other signs.
std::set<std::string> headings_of(const fs::path& document) {
    static const std::regex heading(R"(\n#+ ([^\n]*))");
    std::set<std::string> names;
    const std::string text =
        "\n" + without_code(testing::text_of(testing::source_directory() / document));
    for (const std::string& title : testing::found_in(text, heading)) {
        std::string name;
        for (const char letter : title) {
            const auto sign = static_cast<unsigned char>(letter);
            if (std::isalnum(sign) != 0 || letter == '-' || letter == '_')
                name += static_cast<char>(std::tolower(sign));
            if (letter == ' ') name += '-';
        }
        names.insert(name);
    }
    return names;
}

TEST(Documents, EveryLinkLeadsSomewhere) {
    std::size_t checked = 0;
    for (const fs::path& document : documents()) {
        for (const Link& link : links_of(document)) {
            ++checked;
            ASSERT_TRUE(fs::exists(testing::source_directory() / link.file))
                << document << " links to " << link.file;
            if (link.heading.empty() || link.file.extension() != ".md") continue;
            EXPECT_TRUE(headings_of(link.file).contains(link.heading))
                << document << " links to " << link.file << "#" << link.heading;
        }
    }
    EXPECT_GT(checked, 100U);
}

// The documents once had 134,000 words, which nobody read.
TEST(Documents, AreShortEnoughToBeRead) {
    constexpr std::size_t most_words = 65'000;
    std::vector<fs::path> all = documents();
    all.insert(all.end(), {"CHANGELOG.md", "SECURITY.md"});
    std::size_t words = 0;
    for (const fs::path& document : all) {
        std::istringstream text(testing::text_of(testing::source_directory() / document));
        words +=
            static_cast<std::size_t>(std::distance(std::istream_iterator<std::string>(text), {}));
    }
    EXPECT_GT(words, most_words / 2) << "some documents were not read";
    EXPECT_LE(words, most_words);
}

// An installed document may link only to other installed documents.
TEST(Documents, WhatTheInstalledOnesLinkToIsInstalled) {
    for (const fs::path& document : documents()) {
        for (const Link& link : links_of(document))
            EXPECT_TRUE(is_installed(link.file)) << document << " links to " << link.file;
    }
    const std::string rules = testing::text_of(testing::source_directory() / "cmake/Install.cmake");
    EXPECT_NE(rules.find("install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})"),
              std::string::npos);
    for (const fs::path& file : single_documents)
        EXPECT_NE(rules.find(file), std::string::npos) << file << " is not installed";
}

// Manual pages, units and the configuration name documents by their installed paths.
TEST(Documents, WhatManualPagesUnitsAndConfigurationNameIsThere) {
    static const std::regex installed(R"(@STORMCELLAR_DOCDIR@/([A-Za-z0-9_/-]+\.md))");
    static const std::regex named(R"(\b(docs/[A-Za-z0-9_/-]+\.md))");
    std::size_t checked = 0;
    for (const char* file :
         {"packaging/man/stormcellar.1.in", "packaging/man/stormcellard.8.in",
          "packaging/man/stormcellard.toml.5.in", "systemd/stormcellard.service.in",
          "systemd/stormcellar-loops.service.in", "daemon/stormcellard.toml",
          "daemon/monitoring/stormcellar-alerts.yml"}) {
        const std::string text = testing::text_of(testing::source_directory() / file);
        for (const std::regex* what : {&installed, &named}) {
            for (const std::string& document : testing::found_in(text, *what)) {
                ++checked;
                EXPECT_TRUE(is_installed(document)) << file << " names " << document;
                EXPECT_TRUE(fs::exists(testing::source_directory() / document))
                    << file << " names " << document;
            }
        }
    }
    EXPECT_GT(checked, 5U);
}

// Returns the sources of the tree, without build output.
std::vector<fs::path> sources() {
    static const std::set<std::string> kinds = {".h",   ".cpp",  ".md", ".cmake", ".in",
                                                ".txt", ".toml", ".py", ".yml",   ".awk"};
    const fs::path root = testing::source_directory();
    std::vector<fs::path> found;
    for (const auto& top : fs::directory_iterator(root)) {
        const std::string name = top.path().filename();
        if (name.starts_with(".") || name.starts_with("build") || name == "out") continue;
        if (!top.is_directory()) {
            found.push_back(top.path());
            continue;
        }
        for (const fs::path& path : testing::files_below(top.path()))
            if (kinds.contains(path.extension()) || name == "scripts") found.push_back(path);
    }
    return found;
}

// Returns the documents that a text names by their paths in the tree.
std::vector<std::string> documents_named_in(const std::string& text) {
    const std::string folder = "docs/";
    const auto belongs = [](char sign) {
        return std::isalnum(static_cast<unsigned char>(sign)) != 0 || sign == '_' || sign == '/' ||
               sign == '-' || sign == '.';
    };
    std::vector<std::string> found;
    for (std::size_t at = text.find(folder); at != std::string::npos;
         at = text.find(folder, at + 1)) {
        if (at > 0 && belongs(text[at - 1])) continue;
        const auto begin = text.begin() + static_cast<std::ptrdiff_t>(at);
        const std::string path(begin, std::find_if_not(begin, text.end(), belongs));
        const std::size_t ending = path.find(".md");
        if (ending != std::string::npos) found.push_back(path.substr(0, ending + 3));
    }
    return found;
}

// Documents that comments or documents name must exist.
TEST(Documents, NobodyRefersToADocumentThatIsNotThere) {
    const fs::path root = testing::source_directory();
    std::size_t checked = 0;
    for (const fs::path& source : sources()) {
        for (const std::string& document : documents_named_in(testing::text_of(source))) {
            ++checked;
            EXPECT_TRUE(fs::exists(root / document)) << source << " names " << document;
        }
    }
    EXPECT_GT(checked, 100U);
}

// The last column of each row of docs/find-it.md is a path, and there are at least thirty rows.
TEST(Documents, FindItNamesFilesThatAreThere) {
    static const std::regex row(R"(\n\|[^\n]*\| `([^`\n]+)` \|(?=\n))");
    static const std::regex question(R"(\n(\| [A-Z][^\n|]*\? )\|)");
    const fs::path root = testing::source_directory();
    const std::string page = testing::text_of(root / "docs/find-it.md");
    const std::vector<std::string> files = testing::found_in(page, row);
    EXPECT_GE(files.size(), 30U);
    EXPECT_EQ(files.size(), testing::found_in(page, question).size()) << "a question has no file";
    for (const std::string& file : files)
        EXPECT_TRUE(fs::is_regular_file(root / file)) << file;
    // All other files and folders that docs/find-it.md names must exist, too.
    static const std::regex path(R"(`([a-z_0-9]+/[A-Za-z0-9_./-]*)`)");
    for (const std::string& named : testing::found_in(page, path))
        EXPECT_TRUE(fs::exists(root / named)) << named;
}

// Documents name sources by their paths from the root: `grid/beam/sounding.h`.
TEST(Documents, SourcesThatTheyNameAreThere) {
    static const std::regex path(R"(`((?:[a-z_0-9]+/)+[a-z_0-9-]+\.(?:h|cpp|toml|yml|cmake))`)");
    const fs::path root = testing::source_directory();
    std::size_t checked = 0;
    for (const fs::path& document : documents()) {
        for (const std::string& named :
             testing::found_in(testing::text_of(root / document), path)) {
            ++checked;
            EXPECT_TRUE(fs::exists(root / named) || fs::exists(root / "include" / named))
                << document << " names " << named;
        }
    }
    EXPECT_GT(checked, 100U);
}

}  // namespace
}  // namespace stormcellar
