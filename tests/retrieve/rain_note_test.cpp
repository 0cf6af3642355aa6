// Tests that the note of a rain total comes back as the facts for labels.
#include "retrieve/rain/rain_note.h"

#include <vector>

#include <gtest/gtest.h>

namespace stormcellar::retrieve {
namespace {

constexpr UtcTime note_start{std::chrono::sys_days{std::chrono::year{2024} / 6 / 1}};

TEST(RainNote, ComesBackFromTheNotesOfAGrid) {
    const std::string whole = rain_note({note_start, 60, 0.2, 13, 0});
    EXPECT_EQ(whole,
              "rain since 2024-06-01T00:00:00Z: 60 minutes; 13 volumes; 0 columns were not seen "
              "for a part of the time");
    const auto facts = rain_in_notes(std::vector<std::string>{"another note", whole});
    ASSERT_TRUE(facts);
    EXPECT_EQ(facts->from, note_start);
    EXPECT_EQ(facts->span, "60 minutes");
    const auto gap = rain_in_notes(std::vector{rain_note({note_start, 180, 12, 30, 7})});
    ASSERT_TRUE(gap);
    EXPECT_EQ(gap->span, "180 minutes, 12 of them without volumes");
}

TEST(RainNote, OtherNotesAreNone) {
    for (const char* note : {"", "rain since ", "rain since yesterday: 1; 2", "rain since ; : ",
                             "rain since 2024-06-01T00:00:00Z", "it rained since dawn: 3; 4"})
        EXPECT_FALSE(rain_in_notes(std::vector<std::string>{note})) << note;
}

}  // namespace
}  // namespace stormcellar::retrieve
