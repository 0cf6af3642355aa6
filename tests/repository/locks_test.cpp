// Tests that annotations tell which members each mutex guards, so that clang can check the uses of
// these members (stormcellar/base/mutex.h, scripts/check-locks).
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/repository/text_of.h"
#include "tests/testing/data.h"

namespace stormcellar {
namespace {

namespace fs = std::filesystem;

const std::string the_header = "include/stormcellar/base/mutex.h";

// Returns the headers and sources of the rooms, from the root.
std::vector<std::string> sources_of_rooms() {
    std::vector<std::string> found;
    for (const fs::path& folder : testing::folders_of_the_product()) {
        if (folder.filename() == "bench" || folder.filename() == "docs") continue;
        for (const fs::path& path : testing::sources_below(folder))
            found.push_back(fs::relative(path, testing::source_directory()));
    }
    return found;
}

std::string code_of(const std::string& path) {
    return testing::without_comments(testing::text_of(testing::source_directory() / path));
}

// Returns the uses of standard locks, because clang's analysis does not see these.
std::vector<std::string> unseen_locks(const std::string& code) {
    std::vector<std::string> found;
    for (const char* lock :
         {"std::mutex", "std::timed_mutex", "std::recursive_mutex", "std::shared_mutex",
          "std::shared_timed_mutex", "std::condition_variable", "std::lock_guard",
          "std::scoped_lock", "std::unique_lock", "std::shared_lock"}) {
        if (code.find(lock) != std::string::npos) found.emplace_back(lock);
    }
    return found;
}

// Returns the mutex members that no annotation of the same file names.
std::vector<std::string> silent_mutexes(const std::string& code) {
    static const std::regex member(R"(\n *(?:mutable )?(?:Shared)?Mutex (\w+);)");
    std::vector<std::string> silent;
    if (code.find("Mutex ") == std::string::npos) return silent;
    for (std::sregex_iterator at(code.begin(), code.end(), member), end; at != end; ++at) {
        const std::string name = (*at)[1];
        const std::regex annotation(R"(STORMCELLAR_\w+\([^()]*\b)" + name + R"(\b)");
        if (!std::regex_search(code, annotation)) silent.push_back(name);
    }
    return silent;
}

TEST(Locks, AreThoseThatClangChecks) {
    const auto sources = sources_of_rooms();
    ASSERT_GE(sources.size(), 1000U);
    for (const std::string& path : sources) {
        if (path == the_header) continue;
        const std::string code = code_of(path);
        for (const std::string& lock : unseen_locks(code))
            ADD_FAILURE() << path << ": " << lock << "; use " << the_header;
    }
}

TEST(Locks, EveryMutexSaysWhatItGuards) {
    std::size_t guarded = 0;
    for (const std::string& path : sources_of_rooms()) {
        if (path == the_header) continue;
        const std::string code = code_of(path);
        for (const std::string& name : silent_mutexes(code))
            ADD_FAILURE() << path << ": no annotation says what " << name << " guards";
        guarded += code.find("STORMCELLAR_GUARDED_BY(") != std::string::npos ? 1 : 0;
    }
    EXPECT_GE(guarded, 50U) << "too few files were found";
}

TEST(Locks, TheTestFindsWhatItRefuses) {
    EXPECT_EQ(unseen_locks("    const std::scoped_lock lock(mutex_);\n"),
              std::vector<std::string>{"std::scoped_lock"});
    EXPECT_EQ(unseen_locks("std::unique_lock<std::mutex>& lock"),
              (std::vector<std::string>{"std::mutex", "std::unique_lock"}));
    EXPECT_TRUE(unseen_locks("const MutexLock lock(mutex_); std::once_flag once;").empty());
    EXPECT_EQ(silent_mutexes("\n    mutable Mutex mutex_;\n    int count_ = 0;\n"),
              std::vector<std::string>{"mutex_"});
    EXPECT_EQ(
        silent_mutexes("\n    Mutex mutex;\n    int a STORMCELLAR_GUARDED_BY(other_mutex);\n"),
        std::vector<std::string>{"mutex"});
    EXPECT_TRUE(
        silent_mutexes("\n    Mutex mutex_;\n    int a STORMCELLAR_GUARDED_BY(mutex_) = 0;\n")
            .empty());
}

}  // namespace
}  // namespace stormcellar
