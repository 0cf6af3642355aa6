#include "daemon/queue/seen_files.h"

#include <gtest/gtest.h>

namespace stormcellar::daemon {
namespace {

constexpr FileStamp stamp{1, 100, 5};

TEST(SeenFiles, KnowAFileUntilAnythingOfItChanges) {
    SeenFiles seen;
    seen.add("a", stamp);
    EXPECT_TRUE(seen.contains("a", stamp));
    EXPECT_FALSE(seen.contains("b", stamp));
    EXPECT_FALSE(seen.contains("a", {2, 100, 5}));
    EXPECT_FALSE(seen.contains("a", {1, 101, 5}));
    EXPECT_FALSE(seen.contains("a", {1, 100, 6}));
    EXPECT_FALSE(seen.contains("a", {1, 100, 5, 7})) << "the permissions may have been corrected";
    seen.forget("a");
    EXPECT_FALSE(seen.contains("a", stamp));
}

TEST(SeenFiles, AScanForgetsWhatIsNotThereAnyMore) {
    SeenFiles seen;
    seen.add("stays", stamp);
    seen.add("goes", stamp);
    seen.begin_scan();
    seen.found_again("stays");
    seen.add("comes", stamp);
    seen.end_scan();
    EXPECT_TRUE(seen.contains("stays", stamp));
    EXPECT_TRUE(seen.contains("comes", stamp));
    EXPECT_FALSE(seen.contains("goes", stamp));
    EXPECT_EQ(seen.count(), 2U);
}

}  // namespace
}  // namespace stormcellar::daemon
