// Tests that docs/reference/log.md explains every line that the daemon logs.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/repository/text_of.h"
#include "tests/testing/data.h"

namespace stormcellar {
namespace {

namespace fs = std::filesystem;

std::map<std::string, std::string> daemon_sources() {
    std::map<std::string, std::string> sources;
    for (const fs::path& path : testing::sources_below(testing::source_directory() / "daemon"))
        sources[path.filename()] = testing::text_of(path);
    return sources;
}

// Returns the part of a text that begins with `from` and ends before the next `to`.
std::string between(const std::string& text, const std::string& from, const std::string& to) {
    const std::size_t begin = text.find(from);
    if (begin == std::string::npos) return {};
    return text.substr(begin, text.find(to, begin + from.size()) - begin);
}

// Returns the names of events in daemon/log/log_event.h.
std::vector<std::string> events() {
    const std::string header =
        testing::text_of(testing::source_directory() / "daemon/log/log_event.h");
    static const std::regex name(R"(\n    ([a-z_]+),)");
    return testing::found_in(between(header, "enum class Event {", "};"), name);
}

std::string chapter() {
    const std::string manual =
        testing::text_of(testing::source_directory() / "docs/reference/log.md");
    return between(manual, "\n## What the log lines mean", "\n## ");
}

// Returns the rows of the table by event. A row without an event belongs to the event of the row
// above.
std::map<std::string, std::string> rows_by_event() {
    static const std::regex row(R"(\n(\|[^\n]*))");
    static const std::regex first(R"(^\| `([a-z_]+)` \|)");
    std::map<std::string, std::string> rows;
    std::string event;
    for (const std::string& line : testing::found_in(chapter(), row)) {
        std::smatch named;
        if (std::regex_search(line, named, first)) event = named[1];
        if (!event.empty()) rows[event] += line + "\n";
    }
    return rows;
}

TEST(LogLines, EveryEventIsExplainedAndNoOther) {
    const std::vector<std::string> named = events();
    ASSERT_GT(named.size(), 30U);
    const auto rows = rows_by_event();
    for (const std::string& event : named)
        EXPECT_TRUE(rows.contains(event)) << event << " is not explained";
    for (const auto& [event, row] : rows)
        EXPECT_EQ(std::count(named.begin(), named.end(), event), 1)
            << event << " is not an event of the daemon";
}

TEST(LogLines, EveryEventIsLogged) {
    std::string all;
    for (const auto& [name, text] : daemon_sources())
        if (!name.starts_with("log_event")) all += text;
    // event_of() names the events for results of files.
    all += between(testing::text_of(testing::source_directory() / "daemon/log/log_event.cpp"),
                   "event_of(", "\n}");
    for (const std::string& event : events())
        EXPECT_TRUE(std::regex_search(all, std::regex("Event::" + event + R"(\b)"))) << event;
}

// Lines that do not go through daemon/log/log.h would be neither limited nor explained.
TEST(LogLines, NobodyLogsAnyOtherWay) {
    for (const auto& [name, text] : daemon_sources()) {
        if (name.starts_with("log.") || name == "line_limiter.h") continue;
        EXPECT_EQ(text.find("service/log.h"), std::string::npos) << name;
        EXPECT_EQ(text.find("std::cerr"), std::string::npos) << name;
    }
}

// Returns the string literals from here to the end of the statement. Literals side by side are
// joined.
std::vector<std::string> literals(const std::string& text, std::size_t at) {
    std::vector<std::string> found;
    bool joins = false;
    for (; at < text.size() && text[at] != ';'; ++at) {
        if (text[at] == '"') {
            std::string literal;
            for (++at; at < text.size() && text[at] != '"'; ++at) {
                if (text[at] == '\\') ++at;
                literal += text[at];
            }
            if (joins) {
                found.back() += literal;
            } else {
                found.push_back(literal);
            }
            joins = true;
        } else if (std::isspace(static_cast<unsigned char>(text[at])) == 0) {
            joins = false;
        }
    }
    return found;
}

// Returns the longest piece of a format between its placeholders.
std::string longest_piece(const std::string& format) {
    static const std::regex gap(R"(\{[^}]*\})");
    std::string longest;
    for (std::sregex_token_iterator at(format.begin(), format.end(), gap, -1), end; at != end; ++at)
        if (at->length() > static_cast<std::ptrdiff_t>(longest.size())) longest = *at;
    return longest;
}

std::string squeezed(const std::string& text) {
    static const std::regex blank(R"(\s+)");
    return std::regex_replace(text, blank, " ");
}

// The chapter has the longest piece of each text of a log call and of the reporter.
TEST(LogLines, TheManualHasTheirWords) {
    constexpr std::size_t too_short = 6;  // " ({})", "SIGINT": too short to look for
    static const std::regex call(R"((\blog_(?:debug|info|warning|error|line|problem)\())");
    static const std::regex made(R"((\bfmt::format\())");
    const std::string manual = squeezed(chapter());
    std::size_t checked = 0;
    const auto check = [&](const std::string& name, const std::string& text,
                           const std::regex& where) {
        for (std::sregex_iterator at(text.begin(), text.end(), where), end; at != end; ++at) {
            const auto start = static_cast<std::size_t>(at->position() + at->length());
            for (const std::string& literal : literals(text, start)) {
                std::string words = squeezed(longest_piece(literal));
                words.erase(0, words.find_first_not_of(" :;"));
                words.erase(words.find_last_not_of(" :;(") + 1);
                if (words.size() <= too_short) continue;
                ++checked;
                EXPECT_NE(manual.find(words), std::string::npos)
                    << name << " logs \"" << literal << "\", and the manual does not say it";
            }
        }
    };
    for (const auto& [name, text] : daemon_sources()) {
        if (name.starts_with("log.")) continue;
        check(name, text, call);
        if (name == "reporter.cpp") check(name, text, made);
    }
    EXPECT_GT(checked, 50U);
}

}  // namespace
}  // namespace stormcellar
