#include "render/image/shades.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/image/level.h"

namespace stormcellar::render {
namespace {

// Return the relative luminance and the contrast ratio of WCAG 2.
double luminance(Rgba8 color) {
    const auto linear = [](std::uint8_t level) {
        const double c = level / 255.0;
        return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(color[0]) + 0.7152 * linear(color[1]) + 0.0722 * linear(color[2]);
}
double contrast(Rgba8 one, Rgba8 other) {
    const double a = luminance(one);
    const double b = luminance(other);
    return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05);
}

std::vector<Rgba8> grounds(const Shades& shades) {
    std::vector<Rgba8> all;
    for (const GroundShades* ground : {&shades.land, &shades.water}) {
        for (const Rgba8& shade :
             {ground->seen, ground->seen_aloft, ground->not_seen, ground->beyond})
            all.push_back(shade);
    }
    return all;
}

class ShadesOfTheme : public ::testing::TestWithParam<Theme> {};

TEST_P(ShadesOfTheme, LettersOnThePageCanBeRead) {
    const Shades& shades = shades_of(GetParam());
    EXPECT_GE(contrast(shades.text, shades.page), 12);
    EXPECT_GE(contrast(shades.quiet_text, shades.page), 7);
    EXPECT_GE(contrast(shades.warning_text, shades.page), 6);
}

// Letters can be read on the ground, and on their halo over echo of any color.
TEST_P(ShadesOfTheme, LettersOnTheMapCanBeRead) {
    const Shades& shades = shades_of(GetParam());
    for (const Rgba8& letter : {shades.text, shades.quiet_text, shades.city, shades.small_city}) {
        for (const Rgba8& ground : grounds(shades)) {
            EXPECT_GE(contrast(letter, ground), 4.5);
            EXPECT_GE(contrast(letter, over(shades.halo, ground)), 4.5);
        }
        for (const Rgba8& echo : {Rgba8{255, 255, 255, 255}, Rgba8{255, 255, 0, 255},
                                  Rgba8{0, 0, 0, 255}, Rgba8{0, 0, 246, 255}}) {
            EXPECT_GE(contrast(letter, over(shades.halo, echo)), 4.5);
        }
    }
}

TEST_P(ShadesOfTheme, LinesOfTheMapStandOutByTheirRank) {
    const Shades& shades = shades_of(GetParam());
    for (const GroundShades* ground : {&shades.land, &shades.water}) {
        for (const Rgba8& shade : {ground->seen, ground->seen_aloft, ground->beyond}) {
            const auto drawn = [&](Rgba8 line) { return contrast(over(line, shade), shade); };
            EXPECT_GE(drawn(shades.coast), 3);
            EXPECT_GE(drawn(shades.country), 3);
            EXPECT_GE(drawn(shades.state), 3);
            EXPECT_GE(drawn(shades.ring), 1.5);
            EXPECT_GE(drawn(shades.county), 1.2);
            EXPECT_GE(drawn(shades.highway), 1.2);
            EXPECT_GE(drawn(shades.interstate), 2);
            EXPECT_GT(drawn(shades.country), drawn(shades.state));
            EXPECT_GT(drawn(shades.state), 1.5 * drawn(shades.county));
        }
    }
}

// Land and water of the same state differ, and ground that was not seen differs from seen ground.
TEST_P(ShadesOfTheme, GroundsDiffer) {
    const Shades& shades = shades_of(GetParam());
    EXPECT_GE(contrast(shades.land.seen, shades.water.seen), 1.07);
    EXPECT_GE(contrast(shades.land.beyond, shades.water.beyond), 1.07);
    for (const GroundShades* ground : {&shades.land, &shades.water}) {
        EXPECT_GE(contrast(ground->seen, ground->seen_aloft), 1.07);
        EXPECT_GE(contrast(ground->not_seen, shades.hatch), 1.35);
        const auto all = {ground->seen, ground->seen_aloft, ground->not_seen};
        for (const Rgba8& one : all) {
            // Grounds are nearly gray, unlike any echo.
            EXPECT_LE(*std::max_element(one.begin(), one.begin() + 3) -
                          *std::min_element(one.begin(), one.begin() + 3),
                      26);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, ShadesOfTheme, ::testing::Values(Theme::dark, Theme::light),
                         [](const auto& named) { return std::string(theme_name(named.param)); });

TEST(Theme, NamesAreReadBack) {
    for (const Theme theme : {Theme::dark, Theme::light})
        EXPECT_EQ(theme_from_name(theme_name(theme)).value(), theme);
    const auto unknown = theme_from_name("sepia");
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().message,
              "there is no theme 'sepia'; the known themes are dark or light");
    EXPECT_EQ(theme_from_name("ligth").error().message,
              "there is no theme 'ligth'; did you mean 'light'?");
}

// nearest_level() must give the results of std::lround(), also for halves and the numbers next to
// them.
TEST(NearestLevel, IsThatOfTheLibrary) {
    for (int i = 0; i <= 510; ++i) {
        const double half = i / 2.0;
        for (const double level : {half, std::nextafter(half, 0), std::nextafter(half, 255)})
            EXPECT_EQ(nearest_level(level), std::lround(level)) << level;
    }
    std::mt19937 random(31);
    std::uniform_real_distribution<double> any(0, 255);
    for (int i = 0; i < 100'000; ++i) {
        const double level = any(random);
        ASSERT_EQ(nearest_level(level), std::lround(level)) << level;
    }
}

TEST(Hatched, HasALineEveryNinePixelsOfAnyScale) {
    for (const double scale : {0.6, 1.0, 1.37, 4.0}) {
        for (int place = 0; place < 6000; ++place) {
            const double along = std::fmod(place, 9 * scale);
            const double distance = std::min(along, 9 * scale - along) / std::sqrt(2);
            const double share = std::clamp(0.5 * scale + 0.5 - distance, 0.0, 1.0);
            const Rgba8 slow = mixed({0, 0, 0, 255}, shades::dark.hatch, share);
            const Rgba8 fast =
                hatched({0, 0, 0, 255}, shades::dark.hatch, place / 3, place - place / 3, scale);
            ASSERT_EQ(fast, slow) << scale << " " << place;
        }
    }
}

TEST(Mixed, GoesFromOneToTheOther) {
    EXPECT_EQ(mixed({0, 100, 200, 255}, {100, 0, 200, 255}, 0), (Rgba8{0, 100, 200, 255}));
    EXPECT_EQ(mixed({0, 100, 200, 255}, {100, 0, 200, 255}, 0.5), (Rgba8{50, 50, 200, 255}));
    EXPECT_EQ(mixed({0, 100, 200, 255}, {100, 0, 200, 255}, 1), (Rgba8{100, 0, 200, 255}));
}

}  // namespace
}  // namespace stormcellar::render
