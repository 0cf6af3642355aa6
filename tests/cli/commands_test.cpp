#include "cli/commands.h"

#include <gtest/gtest.h>

namespace stormcellar::cli {
namespace {

TEST(ReportError, BadArgumentIsBadUsageAndTheRestFailed) {
    EXPECT_EQ(report_error({ErrorCode::bad_argument, "x"}), exit_bad_usage);
    EXPECT_EQ(report_error({ErrorCode::corrupt, "x"}), exit_failed);
}

}  // namespace
}  // namespace stormcellar::cli
