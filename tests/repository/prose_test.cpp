// Tests that comments begin with a subject or a verb and fit the line width of their language.
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/repository/text_of.h"
#include "tests/testing/data.h"

namespace stormcellar {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

constexpr double most_share = 0.05;  // share of a room's comment blocks that may lack a subject

struct Comments {
    std::size_t blocks = 0;
    std::vector<std::string> odd;   // "line: text" of the blocks that begin without a subject
    std::vector<std::size_t> wide;  // line numbers
};

// Returns true if the text begins with a word of a subordinate clause or a fragment.
bool lacks_subject(std::string_view text) {
    constexpr std::array<std::string_view, 11> words = {
        "Of", "What", "Which", "Whether", "That", "As", "Those", "How", "Who", "Whose", "Whatever"};
    const std::string_view first = text.substr(0, text.find_first_of(" ,.:;"));
    return std::ranges::find(words, first) != words.end();
}

// Reads the comments on lines of their own. Each block is one text.
Comments comments_of(const std::string& text, std::size_t width) {
    Comments found;
    std::istringstream lines(text);
    bool in_block = false;
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        const auto begin = line.find_first_not_of(' ');
        const bool is_comment = begin != std::string::npos && line.compare(begin, 2, "//") == 0;
        if (is_comment && line.size() > width) found.wide.push_back(number);
        const auto word = is_comment ? line.find_first_not_of(' ', begin + 2) : std::string::npos;
        if (is_comment && !in_block && word != std::string::npos && std::isalpha(line[word])) {
            ++found.blocks;
            const std::string own = line.substr(word);
            if (lacks_subject(own)) found.odd.push_back(std::to_string(number) + ": " + own);
        }
        in_block = is_comment;
    }
    return found;
}

std::string room_of(const fs::path& path) {
    if (path == "include/stormcellar.h") return "capi";
    auto part = path.begin();
    if (*part == "include") std::advance(part, 2);
    return part->string();
}

TEST(Prose, CommentsBeginWithASubjectAndFitTheWidth) {
    const std::set<std::string> skipped = {"build", "out", "docs", "node_modules", "third_party"};
    const std::map<std::string, std::size_t> widths = {
        {".h", 100}, {".cpp", 100}, {".ts", 120}, {".glsl", 120}, {".mjs", 120}};
    const fs::path root = testing::source_directory();
    std::map<std::string, Comments> rooms;
    for (fs::recursive_directory_iterator entry(root), end; entry != end; ++entry) {
        const std::string name = entry->path().filename();
        if (entry->is_directory() && (name.starts_with('.') || skipped.contains(name)))
            entry.disable_recursion_pending();
        const auto width = widths.find(entry->path().extension());
        if (!entry->is_regular_file() || width == widths.end()) continue;
        const fs::path path = fs::relative(entry->path(), root);
        const Comments of_file = comments_of(testing::text_of(entry->path()), width->second);
        Comments& room = rooms[room_of(path)];
        room.blocks += of_file.blocks;
        for (const std::string& odd : of_file.odd)
            room.odd.push_back(path.string() + ":" + odd);
        for (const std::size_t line : of_file.wide)
            ADD_FAILURE() << path.string() << ":" << line << ": wider than " << width->second;
    }
    EXPECT_GE(rooms.size(), 20U);
    for (const auto& [name, room] : rooms) {
        const auto most = static_cast<std::size_t>(most_share * static_cast<double>(room.blocks));
        std::string list;
        for (const std::string& odd : room.odd)
            list += odd + "\n";
        EXPECT_LE(room.odd.size(), most) << name << " has " << room.blocks << " blocks:\n" << list;
    }
}

TEST(Prose, TheCheckSeesWhatItLooksFor) {
    const Comments found = comments_of(
        "// Of a radar that is away, the newest.\n"
        "// Which is one block.\n"
        "int x;  // Of no block\n"
        "    // Asks the radar.\n"
        "\n"
        "    // Whether it answers.\n",
        38);
    EXPECT_EQ(found.blocks, 3U);
    EXPECT_THAT(found.odd,
                ElementsAre("1: Of a radar that is away, the newest.", "6: Whether it answers."));
    EXPECT_THAT(found.wide, ElementsAre(1U));
}

// Counts commits with long subjects. Without Git's history, as in an archive of the sources, the
// count is 0.
TEST(Prose, SubjectsOfCommitsAreShort) {
    constexpr std::size_t width = 72, allowed_before = 490;
    const std::string command =
        "git -C '" + testing::source_directory().string() + "' log --format=%s 2>/dev/null";
    const std::unique_ptr<FILE, int (*)(FILE*)> log(::popen(command.c_str(), "r"), &::pclose);
    ASSERT_TRUE(log);
    std::size_t long_ones = 0;
    std::string subject;
    for (int c = std::fgetc(log.get()); c != EOF; c = std::fgetc(log.get())) {
        if (c != '\n') {
            subject += static_cast<char>(c);
            continue;
        }
        if (subject.size() > width) ++long_ones;
        subject.clear();
    }
    EXPECT_LE(long_ones, allowed_before) << "list the subjects, newest first, with: " << command;
}

}  // namespace
}  // namespace stormcellar
