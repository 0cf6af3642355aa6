#include "base/counted.h"

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

TEST(Counted, OneIsOneAndNoneAreMany) {
    EXPECT_EQ(counted(1, "file"), "1 file");
    EXPECT_EQ(counted(0, "file"), "0 files");
    EXPECT_EQ(counted(std::uint64_t{1} << 32 | 1, "file"), "4294967297 files");
    EXPECT_EQ(counted(1, "directory", "directories"), "1 directory");
    EXPECT_EQ(counted(3, "directory", "directories"), "3 directories");
}

}  // namespace
}  // namespace stormcellar
