#include "grid/frame/named_place.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/base/station_table.h"

namespace stormcellar::grid {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

void expect_at(const char* text, double latitude_deg, double longitude_deg, double off_deg = 0.05) {
    const auto place = parse_place("--at", text);
    ASSERT_TRUE(place) << text << ": " << place.error().message;
    EXPECT_NEAR(place->latitude_deg, latitude_deg, off_deg) << text;
    EXPECT_NEAR(place->longitude_deg, longitude_deg, off_deg) << text;
}

std::string refusal(const char* text) {
    const auto place = parse_place("--at", text);
    EXPECT_FALSE(place) << text;
    return place ? "" : place.error().message;
}

TEST(NamedPlace, NumbersAreAPlace) {
    expect_at("35.3,-97.5", 35.3, -97.5, 1e-9);
    expect_at(" 35.3,-97.5 ", 35.3, -97.5, 1e-9);
    EXPECT_THAT(refusal("35.3"), HasSubstr("--at: must be LAT,LON in degrees"));
    EXPECT_THAT(refusal("35.3,-97.5,1"), HasSubstr("--at: must be LAT,LON"));
    EXPECT_THAT(refusal(""), HasSubstr("--at: must be LAT,LON"));
}

// The expected positions are those of city halls on maps, accurate to a few kilometers.
TEST(NamedPlace, TownsByNameAndState) {
    expect_at("Moore, OK", 35.34, -97.49);
    expect_at("moore,ok", 35.34, -97.49);
    expect_at("El Reno, OK", 35.53, -97.96);
    expect_at("Joplin, MO", 37.08, -94.51);
    expect_at("St. Louis, MO", 38.63, -90.20);
    expect_at("Saint Louis, MO", 38.63, -90.20);
    expect_at("Canon City, CO", 38.44, -105.24);
    expect_at("Winston Salem, NC", 36.10, -80.25);
    expect_at("Coeur d'Alene, ID", 47.69, -116.78);
    expect_at("Framingham, MA", 42.30, -71.44);
    expect_at("Cherry Hill, NJ", 39.90, -75.00);
    expect_at("San Juan, PR", 18.46, -66.11);
    expect_at("Toronto, Canada", 43.65, -79.38);
}

TEST(NamedPlace, ATownWithoutItsStateIfOneIsMeant) {
    expect_at("El Reno", 35.53, -97.96);
    expect_at("Dallas", 32.78, -96.80);  // the only large town of the eight with this name
}

TEST(NamedPlace, AmbiguousNamesListTheirStates) {
    EXPECT_EQ(refusal("Moore"),
              "--at: 'Moore' may be Moore, ID; Moore, MT; Moore, OK; Moore, TX; name one of them "
              "with its state, or give LAT,LON");
    EXPECT_THAT(refusal("Franklin"), HasSubstr(" more; name one"));
    EXPECT_THAT(refusal("Milford, IN"), HasSubstr("Milford, IN (39.35,-85.62); Milford, IN (41."));
}

TEST(NamedPlace, UnknownNamesHaveASuggestion) {
    EXPECT_EQ(refusal("Mooore, OK"),
              "--at: there is no place 'Mooore, OK'; did you mean 'Moore, OK'?");
    EXPECT_THAT(refusal("Norrman"), HasSubstr("did you mean 'Norman'?"));
    EXPECT_EQ(
        refusal("Moore, Oklahoma"),
        "--at: there is no place 'Moore, Oklahoma'; there is Moore, ID; Moore, MT; Moore, OK; "
        "Moore, TX");
    EXPECT_THAT(refusal("Xyzzyxyzzy"), Not(HasSubstr("did you mean")));
}

TEST(NamedPlace, RadarsByIcaoAndByPlace) {
    const auto station = find_station("KTLX");
    ASSERT_TRUE(station);
    expect_at("KTLX", station->latitude_deg, station->longitude_deg, 1e-9);
    expect_at("ktlx", station->latitude_deg, station->longitude_deg, 1e-9);
    for (const Station& one : all_stations()) {
        const std::string name = fmt::format("{}, {}", one.name, one.state);
        const auto place = parse_place("--at", name);
        if (place) continue;
        EXPECT_THAT(place.error().message, HasSubstr("may be")) << name;
    }
}

TEST(NamedPlace, TwoPlaces) {
    const auto numbers = parse_two_places("--section", "35,-98.5,35.6,-96.5");
    ASSERT_TRUE(numbers);
    EXPECT_EQ((*numbers)[1].longitude_deg, -96.5);
    const auto named = parse_two_places("--section", "Moore, OK; KINX");
    ASSERT_TRUE(named) << named.error().message;
    EXPECT_NEAR((*named)[0].latitude_deg, 35.34, 0.05);
    EXPECT_EQ((*named)[1].latitude_deg, find_station("KINX")->latitude_deg);
    for (const char* wrong : {"35,-98.5,35.6", "Moore, OK", "a;b;c", ";"})
        EXPECT_FALSE(parse_two_places("--section", wrong)) << wrong;
    EXPECT_THAT(parse_two_places("--section", "Moore; KINX").error().message,
                HasSubstr("--section: 'Moore' may be"));
}

}  // namespace
}  // namespace stormcellar::grid
