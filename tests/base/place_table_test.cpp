#include "base/place_table.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

TEST(PlaceTable, EachRowIsAPlace) {
    std::set<std::string> regions;
    for (const NamedPlace& place : all_places()) {
        EXPECT_FALSE(place.name.empty());
        EXPECT_GE(place.region.size(), 2U) << place.name;
        EXPECT_EQ(place.name.find_first_of(",;\t"), std::string_view::npos) << place.name;
        EXPECT_EQ(place.name.find("(balance)"), std::string_view::npos) << place.name;
        EXPECT_NE(compared_name(place.name), "") << place.name;
        EXPECT_GT(place.latitude_deg, 5) << place.name;
        EXPECT_LT(place.latitude_deg, 76) << place.name;
        EXPECT_GT(std::abs(place.longitude_deg), 25) << place.name;
        EXPECT_LE(std::abs(place.longitude_deg), 180) << place.name;
        EXPECT_GE(place.population_thousands, 0) << place.name;
        if (place.region.size() == 2) regions.insert(std::string(place.region));
    }
    EXPECT_GT(all_places().size(), 30000U);
    EXPECT_GE(regions.size(), 52U) << "the states, DC and Puerto Rico";
}

TEST(PlaceTable, NamesAreComparedAsTheyAreTyped) {
    EXPECT_EQ(compared_name("St. Louis"), "st louis");
    EXPECT_EQ(compared_name("Saint Louis"), "st louis");
    EXPECT_EQ(compared_name("  Winston-Salem "), "winston salem");
    EXPECT_EQ(compared_name("Coeur d'Alene"), "coeur dalene");
    EXPECT_EQ(compared_name("Ca\u00F1on City"), "canon city");
    EXPECT_EQ(compared_name("Bayam\u00F3n"), "bayamon");
    EXPECT_EQ(compared_name("\xC3"), "\xC3") << "nothing after a truncated letter may be read";
}

}  // namespace
}  // namespace stormcellar
