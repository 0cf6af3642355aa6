#include "base/printable.h"

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

TEST(Printable, LeavesOrdinaryTextAlone) {
    EXPECT_EQ(printable("KTLX 20\xC2\xB0 \xE2\x82\xAC"), "KTLX 20\xC2\xB0 \xE2\x82\xAC");
}

// A file name must not be able to move the cursor or break a line of the log.
TEST(Printable, EscapesControlsAndBrokenUtf8) {
    EXPECT_EQ(printable("a\nb\x1B[2J"), "a\\x0ab\\x1b[2J");
    EXPECT_EQ(printable("\xFF\xC3"), "\\xff\\xc3");
    EXPECT_EQ(printable("\xC2\x9B"), "\\xc2\\x9b") << "C1 controls are controls";
    EXPECT_EQ(printable("\x7F"), "\\x7f");
}

}  // namespace
}  // namespace stormcellar
