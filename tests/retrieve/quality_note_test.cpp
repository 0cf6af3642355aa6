// Tests that the reader of notes about left-out echo finds the numbers in the notes.
#include "retrieve/derived/quality_note.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "retrieve/derived/quality_moment.h"
#include "stormcellar/retrieve/derived_moments.h"

namespace stormcellar::retrieve {
namespace {

TEST(QualityNote, HasTheThresholdAndTheShare) {
    const auto of_file = quality_note_in(std::vector{weather_note(0.5, {1000, 123})});
    ASSERT_TRUE(of_file);
    EXPECT_EQ(of_file->least, 0.5);
    EXPECT_NEAR(of_file->share.value(), 0.123, 1e-9);
    const auto without_echo = quality_note_in(std::vector{weather_note(0.25, {})});
    ASSERT_TRUE(without_echo);
    EXPECT_EQ(without_echo->least, 0.25);
    EXPECT_FALSE(without_echo->share);
}

TEST(QualityNote, HasNoShareIfTheSitesOfAMosaicDiffer) {
    const auto mosaic = quality_note_in(std::vector{"KBGM: " + weather_note(0.5, {1000, 123}),
                                                    "KTYX: " + weather_note(0.5, {1000, 456})});
    ASSERT_TRUE(mosaic);
    EXPECT_EQ(mosaic->least, 0.5);
    EXPECT_FALSE(mosaic->share);
    EXPECT_EQ(quality_in_notes(std::vector{"KBGM: " + weather_note(0.5, {1000, 123}),
                                           "KLIX: " + weather_note(0.5, {}),
                                           "KTYX: " + weather_note(0.5, {1000, 456})}),
              "probability of weather at least 0.5; 12 to 46 % of the echo left out");
    EXPECT_EQ(quality_in_notes(
                  std::vector{"KBGM: " + weather_note(0.5, {}), "KLIX: " + weather_note(0.25, {})}),
              "probability of weather at least 0.5");
}

TEST(QualityNote, IsNoneWithoutSuchANote) {
    EXPECT_FALSE(quality_note_in({}));
    EXPECT_FALSE(quality_note_in(std::vector<std::string>{"storm motion 240/15, as given"}));
    EXPECT_FALSE(quality_note_in(std::vector<std::string>{quality_words + "half"}));
}

TEST(QualityNote, TellsGridsOfOneThresholdFromThoseOfAnother) {
    const std::vector file = {weather_note(0.1, {1000, 123})};
    EXPECT_TRUE(is_of_quality(file, 0.1));
    EXPECT_FALSE(is_of_quality(file, 0));
    EXPECT_FALSE(is_of_quality(file, 0.12));
    EXPECT_FALSE(is_of_quality(std::vector{weather_note(0.12, {})}, 0.1));
    EXPECT_TRUE(is_of_quality(std::vector{weather_note(0.12, {})}, 0.12));
    EXPECT_TRUE(is_of_quality({}, 0));
    EXPECT_FALSE(is_of_quality({}, 0.1));
    EXPECT_FALSE(is_of_quality({}, std::numeric_limits<double>::quiet_NaN()));
    EXPECT_TRUE(is_of_quality(std::vector{weather_note(1.0 / 3, {})}, 1.0 / 3));
}

}  // namespace
}  // namespace stormcellar::retrieve
