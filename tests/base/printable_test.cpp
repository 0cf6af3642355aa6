#include "base/printable.h"

#include <string>
#include <string_view>

#include <fmt/format.h>
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
    EXPECT_EQ(printable("\xC2\x9B"), "\\xc2\\x9b") << "C1 characters are control characters";
    EXPECT_EQ(printable("\x7F"), "\\x7f");
}

// RFC 3629 forbids these sequences and other programs refuse them, so they must not pass as text.
TEST(Printable, EscapesSurrogatesOverlongFormsAndWhatIsBeyondUnicode) {
    EXPECT_EQ(printable("\xED\x9F\xBF"), "\xED\x9F\xBF");
    EXPECT_EQ(printable("\xED\xA0\x80"), "\\xed\\xa0\\x80");
    EXPECT_EQ(printable("\xE0\x9F\xBF"), "\\xe0\\x9f\\xbf");
    EXPECT_EQ(printable("\xE0\xA0\x80"), "\xE0\xA0\x80");
    EXPECT_EQ(printable("\xF0\x8F\xBF\xBF"), "\\xf0\\x8f\\xbf\\xbf");
    EXPECT_EQ(printable("\xF4\x8F\xBF\xBF"), "\xF4\x8F\xBF\xBF");
    EXPECT_EQ(printable("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
}

// 2026-11-25: these characters passed, so the name of a file could reverse or hide a part of its
// line.
TEST(Printable, EscapesWhatTurnsTextAroundOrIsNotSeen) {
    EXPECT_EQ(printable("KTLX\u202Egz.exe"), "KTLX\\xe2\\x80\\xaegz.exe");
    for (const std::string_view unseen :
         {"\u00AD",     "\u034F",     "\u061C",     "\u115F",    "\u180E",     "\u200B",
          "\u200D",     "\u200E",     "\u200F",     "\u2028",    "\u2029",     "\u202A",
          "\u202E",     "\u2060",     "\u2064",     "\u2066",    "\u2069",     "\u3164",
          "\uFE0F",     "\uFEFF",     "\uFFF9",     "\uFFFB",    "\U0001D173", "\U000E0000",
          "\U000E0001", "\U000E007F", "\U000E01EF", "\U000E0FFF"}) {
        std::string escaped;
        for (const char byte : unseen)
            escaped += fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
        EXPECT_EQ(printable(unseen), escaped);
    }
}

// The code points next to the escaped ones are text, such as Hebrew and Arabic letters, dashes,
// signs and emoji.
TEST(Printable, LeavesTheirNeighborsAlone) {
    for (const std::string_view seen :
         {"\u00A0", "\u00AC", "\u00AE", "\u0350", "\u05D0", "\u061B",     "\u061D",
          "\u1810", "\u200A", "\u2010", "\u2027", "\u202F", "\u205F",     "\u2070",
          "\uFDFF", "\uFE10", "\uFF00", "\uFFFC", "\uFFFD", "\U0001F327", "\U0010FFFF"}) {
        EXPECT_EQ(printable(seen), seen);
    }
}

}  // namespace
}  // namespace stormcellar
