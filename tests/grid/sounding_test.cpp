// Tests soundings: compares refractivity with the formula of ITU-R P.453, and checks the format and
// the message for each kind of wrong file.
#include "grid/beam/sounding.h"

#include <cmath>
#include <fstream>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stormcellar::grid {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string head = "height_m,pressure_hpa,temperature_c,dew_point_c\n";

std::string refusal(const std::string& text) {
    const auto profile = parse_sounding(text, "dir/a.csv");
    return profile ? "" : profile.error().message;
}

// The current ITU-R P.453 has 77.6 Pd / T + 72 e / T + 3.75e5 e / T^2, where Pd is the pressure of
// the dry air and e is the pressure of the vapor.
TEST(Sounding, RefractivityIsThatOfTheRecommendation) {
    for (const double temperature_c : {-60.0, -20.0, 0.0, 15.0, 30.0, 40.0}) {
        for (const double below_c : {0.0, 3.0, 20.0}) {
            const double e = saturation_pressure_hpa(temperature_c - below_c);
            const double kelvin = temperature_c + 273.15;
            const double full =
                77.6 * (900 - e) / kelvin + 72 * e / kelvin + 3.75e5 * e / (kelvin * kelvin);
            const double ours = refractivity(900, temperature_c, temperature_c - below_c);
            EXPECT_NEAR(ours, full, 0.001 * full) << temperature_c << ' ' << below_c;
        }
    }
    // For dry air of the standard atmosphere at sea level, 77.6 * 1013.25 / 288.15.
    EXPECT_NEAR(refractivity(1013.25, 15, -150), 272.9, 0.05);
}

// Goff and Gratch give 6.11 hPa at 0 degrees Celsius, 23.37 hPa at 20, 1.2540 hPa (over water) at
// -20, and 73.78 hPa at 40.
TEST(Sounding, SaturationPressureIsThatOfTheTables) {
    EXPECT_NEAR(saturation_pressure_hpa(0), 6.11, 0.01);
    EXPECT_NEAR(saturation_pressure_hpa(20), 23.37, 0.05);
    EXPECT_NEAR(saturation_pressure_hpa(40), 73.78, 0.15);
    EXPECT_NEAR(saturation_pressure_hpa(-20), 1.254, 0.01);
}

TEST(Sounding, ReadsColumnsInAnyOrderWithCommentsAndOthers) {
    const std::string text =
        "# KOUN 12 UTC\r\n\r\n"
        "temperature_c , wind_mps, height_m,\tdew_point_c, pressure_hpa # as sent\r\n"
        "21.4, 5, 345, 17.0, 968.2\r\n"
        "   # a comment between\r\n"
        "20, ?, 1500, 1e1, 850";
    const auto profile = parse_sounding(text, "dir/KOUN.csv");
    ASSERT_TRUE(profile) << profile.error().message;
    EXPECT_EQ(profile->name(), "sounding KOUN.csv");
    EXPECT_NEAR(profile->at(345).n_units, refractivity(968.2, 21.4, 17), 1e-9);
    EXPECT_NEAR(profile->at(1500).n_units, refractivity(850, 20, 10), 1e-9);
}

TEST(Sounding, ReadsRefractivityAndRelativeHumidity) {
    const auto direct = parse_sounding("height_m,refractivity\n0,320\n1000,280\n", "n");
    ASSERT_TRUE(direct) << direct.error().message;
    EXPECT_NEAR(direct->at(0).n_units, 320, 1e-9);
    const auto humid = parse_sounding(
        "height_m,pressure_hpa,temperature_c,relative_humidity_percent\n0,1000,20,100\n1000,900,15,"
        "0\n",
        "rh");
    ASSERT_TRUE(humid) << humid.error().message;
    EXPECT_NEAR(humid->at(0).n_units, refractivity(1000, 20, 20), 1e-9);
    EXPECT_NEAR(humid->at(1000).n_units, 77.6 * 900 / 288.15, 1e-9);
}

// Regression of 2026-11-21: a byte order mark, which some editors write, hid the first column.
TEST(Sounding, AByteOrderMarkIsNoPartOfTheFirstColumn) {
    const std::string text = "height_m,refractivity\n0,320\n1000,280\n";
    const auto marked = parse_sounding("\xEF\xBB\xBF" + text, "n");
    ASSERT_TRUE(marked) << marked.error().message;
    EXPECT_NEAR(marked->at(0).n_units, 320, 1e-9);
    EXPECT_FALSE(parse_sounding("\xEF\xBB" + text, "n")) << "a truncated mark is not a mark";
    EXPECT_FALSE(parse_sounding("\xEF\xBB\xBF", "n")) << "no line names the columns";
}

TEST(Sounding, EveryTextThatIsNoSoundingIsTheSameError) {
    for (const char* text : {"", "# nothing\n", "height_m,refractivity\n", "1,2\n3,4\n"}) {
        const auto profile = parse_sounding(text, "n");
        ASSERT_FALSE(profile) << text;
        EXPECT_EQ(profile.error().code, ErrorCode::bad_argument) << text;
    }
}

TEST(Sounding, TheLowestLayerEndsAtTheFirstLevel) {
    const auto profile = parse_sounding("height_m,refractivity\n950,320\n1500,280\n", "n");
    ASSERT_TRUE(profile) << profile.error().message;
    EXPECT_EQ(profile->layer(0).top_m, 950);
}

TEST(Sounding, NamesTheColumnThatIsMissing) {
    EXPECT_THAT(refusal(""), HasSubstr("no line names the columns"));
    EXPECT_THAT(refusal("# nothing\n\n"), HasSubstr("no line names the columns"));
    EXPECT_THAT(refusal("\nheight,refractivity\n"),
                StartsWith("dir/a.csv:2: there is no column height_m"));
    EXPECT_THAT(refusal("height_m\n"),
                HasSubstr("there is no column refractivity or pressure_hpa"));
    EXPECT_THAT(refusal("height_m,pressure_hpa,dew_point_c\n"), HasSubstr("temperature_c"));
    EXPECT_THAT(refusal("height_m,pressure_hpa,temperature_c\n"),
                HasSubstr("there must be exactly one"));
    EXPECT_THAT(refusal("height_m,pressure_hpa,temperature_c,dew_point_c,"
                        "relative_humidity_percent\n"),
                HasSubstr("there must be exactly one"));
    EXPECT_THAT(refusal("height_m,height_m,refractivity\n"), HasSubstr("named twice"));
    EXPECT_THAT(refusal(std::string(200, ',')), HasSubstr("201 columns"));
}

TEST(Sounding, NamesLineAndColumnOfWhatIsWrong) {
    const std::string good = head + "0,1000,20,10\n";
    EXPECT_THAT(refusal(good), HasSubstr("dir/a.csv: has 1 levels"));
    EXPECT_THAT(refusal(good + "100,990,19\n"),
                StartsWith("dir/a.csv:3: there are 3 columns, not 4"));
    EXPECT_THAT(refusal(good + "100,990,,9\n"),
                StartsWith("dir/a.csv:3: column temperature_c (number 3): not a number: ''"));
    EXPECT_THAT(refusal(good + "100,9x,19,9\n"), HasSubstr("pressure_hpa (number 2): not a num"));
    EXPECT_THAT(refusal(good + "nan,990,19,9\n"), HasSubstr("height_m (number 1): not a num"));
    EXPECT_THAT(refusal(good + "100,inf,19,9\n"), HasSubstr("pressure_hpa (number 2): not a num"));
    EXPECT_THAT(refusal(good + "100,1e999,19,9\n"), HasSubstr("pressure_hpa"));
    EXPECT_THAT(refusal(good + "100,990,292,9\n"), HasSubstr("292 is not from -120 to 60"));
    EXPECT_THAT(refusal(good + "100,0,19,9\n"), HasSubstr("pressure_hpa (number 2): 0 is not"));
    EXPECT_THAT(refusal(good + "0,990,19,9\n"),
                HasSubstr("height_m: 0 is not above the one before, 0"));
    EXPECT_THAT(refusal(good + "100,1001,19,9\n"), HasSubstr("pressure_hpa: 1001 is more than"));
    EXPECT_THAT(refusal(good + "100,990,8,9\n"), HasSubstr("dew_point_c: 9 is above the temp"));
    EXPECT_THAT(refusal(good + "1,990,19,-100\n"), HasSubstr(":3: the refractivity changes by"));
    EXPECT_THAT(refusal(head + "9500,300,-40,-50\n"), HasSubstr(":2: column height_m: the first"));
    EXPECT_THAT(refusal(head + "0,1000,20,\x01\x02\n"), HasSubstr("'\\x01\\x02'"));
}

TEST(Sounding, BoundsSizeAndLevels) {
    EXPECT_THAT(refusal(std::string((1 << 20) + 1, '#')), HasSubstr("1048577 bytes"));
    std::string many = "height_m,refractivity\n";
    for (int i = 0; i <= 10'000; ++i)
        many += std::to_string(i) + ",300\n";
    EXPECT_THAT(refusal(many), HasSubstr(":10002: there are more than 10000 levels"));
}

TEST(Sounding, ReadsAFileAndSaysWhichIsMissing) {
    const auto path = std::filesystem::path(::testing::TempDir()) / "sounding_test.csv";
    std::ofstream(path) << head << "0,1000,20,10\n1000,890,12,5\n";
    const auto profile = read_sounding(path);
    ASSERT_TRUE(profile) << profile.error().message;
    EXPECT_NEAR(profile->at(1000).n_units, refractivity(890, 12, 5), 1e-9);
    std::filesystem::remove(path);
    const auto missing = read_sounding(path);
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::not_found);
}

// Any bytes must yield a finite profile, or a message of one line that names the file.
TEST(Sounding, SurvivesMutations) {
    std::mt19937_64 random(20261121);
    const std::string seed = head + "0,1000,20,10\n500,945,17,9\n1500,845,12,1\n9000,308,-42,-55\n";
    const std::string alphabet = "0123456789.,-+e#\n\r \tnaif_mchp";
    int read = 0;
    for (int i = 0; i < 20'000; ++i) {
        std::string text = seed;
        for (int edits = static_cast<int>(random() % 3) + 1; edits > 0; --edits) {
            // Change mostly the numbers, because nothing can be read without the names of the
            // columns.
            const std::size_t first =
                random() % 5 > 0 && text.size() > head.size() ? head.size() : 0;
            const std::size_t at = first + random() % (text.size() - first);
            const auto kind = random() % 3;
            if (kind == 0) text.erase(at, random() % 8 + 1);
            if (kind == 1) text.insert(at, 1, alphabet[random() % alphabet.size()]);
            if (kind == 2) text[at] = static_cast<char>(random());
            if (text.empty()) text = "#";
        }
        const auto profile = parse_sounding(text, "m");
        if (!profile) {
            ASSERT_THAT(profile.error().message, StartsWith("m:"));
            ASSERT_EQ(profile.error().message.find('\n'), std::string::npos);
            continue;
        }
        ++read;
        for (const double height_m : {-500.0, 0.0, 700.0, 20e3})
            ASSERT_TRUE(std::isfinite(profile->at(height_m).n_units)) << text;
    }
    EXPECT_GT(read, 500);
    EXPECT_LT(read, 19'000);
}

}  // namespace
}  // namespace stormcellar::grid
