#include "cli/shared/commands.h"

#include <gtest/gtest.h>

namespace stormcellar::cli {
namespace {

TEST(Plural, IsOfAllButOne) {
    EXPECT_EQ(plural(0, "grid"), "grids");
    EXPECT_EQ(plural(1, "grid"), "grid");
    EXPECT_EQ(plural(2, "grid"), "grids");
    EXPECT_EQ(plural(std::uint64_t{1} << 32 | 1, "file"), "files");
}

TEST(ReportError, BadArgumentIsBadUsageAndTheRestFailed) {
    EXPECT_EQ(report_error({ErrorCode::bad_argument, "x"}), exit_bad_usage);
    EXPECT_EQ(report_error({ErrorCode::corrupt, "x"}), exit_failed);
    EXPECT_EQ(report_error({ErrorCode::busy, "x"}), exit_failed) << "the request itself is valid";
    EXPECT_EQ(report_error({ErrorCode::unmet, "x"}), exit_failed);
}

}  // namespace
}  // namespace stormcellar::cli
