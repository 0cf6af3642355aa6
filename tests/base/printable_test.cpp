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

// Others refuse these, so they must not pass as text (RFC 3629).
TEST(Printable, EscapesSurrogatesOverlongFormsAndWhatIsBeyondUnicode) {
    EXPECT_EQ(printable("\xED\x9F\xBF"), "\xED\x9F\xBF");
    EXPECT_EQ(printable("\xED\xA0\x80"), "\\xed\\xa0\\x80");
    EXPECT_EQ(printable("\xE0\x9F\xBF"), "\\xe0\\x9f\\xbf");
    EXPECT_EQ(printable("\xE0\xA0\x80"), "\xE0\xA0\x80");
    EXPECT_EQ(printable("\xF0\x8F\xBF\xBF"), "\\xf0\\x8f\\xbf\\xbf");
    EXPECT_EQ(printable("\xF4\x8F\xBF\xBF"), "\xF4\x8F\xBF\xBF");
    EXPECT_EQ(printable("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
}

}  // namespace
}  // namespace stormcellar
