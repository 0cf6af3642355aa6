// Tests that no test waits for a fixed time. Only tests/testing/waiting.h may sleep.
#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/repository/text_of.h"
#include "tests/testing/data.h"

namespace stormcellar {
namespace {

namespace fs = std::filesystem;

constexpr const char* the_one_place = "testing/waiting.h";

// The files that may call pass_time(), for a load with a rate, a simulated peer, or a kill at a
// random moment.
const std::set<std::string> with_a_pace = {
    "cache/processes_test.cpp",         // kills a writer at a random moment
    "catalog/durability_test.cpp",      // kills a process at a random moment
    "cli/loop_test.cpp",                // truncates and restores a file in turn
    "daemon/end_to_end_test.cpp",       // appends pieces as LDM does
    "daemon/hostile_drop_test.cpp",     // swaps names
    "daemon/hostile_sizes_test.cpp",    // appends bombs
    "daemon/recovery_test.cpp",         // kills the daemon, each time a bit later
    "daemon/watch_facts_test.cpp",      // deletes files at any moment
    "fault/hostile_feed.cpp",           // feeds the pieces of volumes when they are due
    "fault/hostile_mix.cpp",            // makes hostile files at a rate
    "fault/hostile_mix_test.cpp",       // attacks for some time
    "fault/hostile_queue_test.cpp",     // brings chunks in turn
    "fault/kill_test.cpp",              // kills the daemon at a random moment
    "fault/load.cpp",                   // delivers volumes, piece by piece
    "pipeline/living_chunks_test.cpp",  // starts workers one after another
};

// Returns the code of the tests by paths below tests/, without comments. Leaves out tests/bench,
// which measures times, and tests/viewer, which runs in the browser.
const std::map<std::string, std::string>& code_of_tests() {
    static const auto all = [] {
        const fs::path root = testing::source_directory() / "tests";
        std::map<std::string, std::string> code;
        for (const fs::path& path : testing::sources_below(root)) {
            const std::string name = fs::relative(path, root);
            if (name.starts_with("bench/") || name.starts_with("viewer/")) continue;
            if (name == "repository/waits_test.cpp") continue;
            code[name] = testing::without_comments(testing::text_of(path));
        }
        return code;
    }();
    return all;
}

// Returns the first line that waits for a fixed time; empty if no line does.
std::string wait_in(const std::string& code) {
    static const std::regex waits(
        R"(\b(sleep_for|sleep_until|usleep|nanosleep|clock_nanosleep|sleep|yield)\s*\()"
        R"(|\b(poll|ppoll|select|pselect)\s*\(\s*(nullptr|NULL|0)\b)");
    std::istringstream lines(code);
    for (std::string line; std::getline(lines, line);) {
        const auto has = [&](const char* word) { return line.find(word) != std::string::npos; };
        const bool is_worth_a_look = has("sleep") || has("yield") || has("poll") || has("select");
        if (is_worth_a_look && std::regex_search(line, waits)) return line;
    }
    return {};
}

TEST(Waits, NobodySleepsButTheOneHelper) {
    EXPECT_GT(code_of_tests().size(), 300U);
    for (const auto& [name, code] : code_of_tests()) {
        if (name == the_one_place) continue;
        EXPECT_EQ(wait_in(code), "")
            << "in tests/" << name << "; wait for a condition with testing::eventually() of tests/"
            << the_one_place;
    }
}

TEST(Waits, ASleepIsFound) {
    EXPECT_NE(wait_in(code_of_tests().at(the_one_place)), "");
    for (const char* line :
         {"std::this_thread::sleep_for(1s);", "::usleep (20);", "std::this_thread::yield();",
          "::poll(nullptr, 0, 100);", "::select(0, nullptr, nullptr, nullptr, &time);"})
        EXPECT_EQ(wait_in(line), line);
    for (const char* line : {"program(\"sleep 100\\n\");", "::poll(&source, 1, 100);"})
        EXPECT_EQ(wait_in(line), "");
}

// A condition that is never true would be a fixed wait.
TEST(Waits, EachConditionMayComeTrue) {
    for (const auto& [name, code] : code_of_tests()) {
        const std::string call = "eventually(";
        for (auto at = code.find(call); at != std::string::npos; at = code.find(call, at + 1)) {
            const std::string begin = code.substr(at, code.find(';', at) - at);
            EXPECT_EQ(begin.find("] { return false"), std::string::npos) << "tests/" << name;
        }
    }
}

TEST(Waits, WhoLetsTimePassIsListed) {
    std::set<std::string> found;
    for (const auto& [name, code] : code_of_tests())
        if (name != the_one_place && code.find("pass_time(") != std::string::npos)
            found.insert(name);
    EXPECT_EQ(found, with_a_pace)
        << "only a load may use pass_time(); use testing::eventually() to wait for a condition";
}

}  // namespace
}  // namespace stormcellar
