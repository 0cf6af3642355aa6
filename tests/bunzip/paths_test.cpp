#include "bunzip/paths.h"

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "tests/bunzip/each_path.h"

namespace stormcellar::bunzip {
namespace {

TEST(Paths, HaveNames) {
    for (const Path path : all_paths)
        EXPECT_EQ(path_named(name_of(path)), path);
    EXPECT_EQ(path_named("abacus"), std::nullopt);
    EXPECT_EQ(path_named(""), std::nullopt);
}

TEST(Paths, TwoAreEverywhereAndTheFastestIsThere) {
    EXPECT_TRUE(is_available(Path::libbz2));
    EXPECT_TRUE(is_available(Path::plain));
    EXPECT_TRUE(is_available(fastest_path()));
    EXPECT_NE(fastest_path(), Path::libbz2);
}

TEST(Paths, TheUsualOneCanBeSet) {
    const Path before = usual_path();
    for (const Path path : all_paths) {
        EXPECT_EQ(set_usual_path(path), is_available(path));
        if (is_available(path)) {
            EXPECT_EQ(usual_path(), path);
        }
    }
    EXPECT_TRUE(set_usual_path(before));
}

// Returns the usual path as an exit status, with STORMCELLAR_BUNZIP set to `name`. A process reads
// the environment only once, so each case runs in a new process.
int exit_with_usual_path(const char* name) {
    ::setenv("STORMCELLAR_BUNZIP", name, 1);
    return static_cast<int>(usual_path());
}

TEST(PathsDeathTest, TheEnvironmentNamesOne) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(std::exit(exit_with_usual_path("libbz2")),
                ::testing::ExitedWithCode(static_cast<int>(Path::libbz2)), "");
    EXPECT_EXIT(std::exit(exit_with_usual_path("plain")),
                ::testing::ExitedWithCode(static_cast<int>(Path::plain)), "");
    EXPECT_EXIT(std::exit(exit_with_usual_path("abacus")),
                ::testing::ExitedWithCode(static_cast<int>(fastest_path())), "");
}

}  // namespace
}  // namespace stormcellar::bunzip
