#include "base/nearest_name.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

TEST(NearestName, EditDistanceOfKnownPairs) {
    EXPECT_EQ(edit_distance("", ""), 0U);
    EXPECT_EQ(edit_distance("", "abc"), 3U);
    EXPECT_EQ(edit_distance("abc", ""), 3U);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
    EXPECT_EQ(edit_distance("ab", "ba"), 1U);
    EXPECT_EQ(edit_distance("ca", "abc"), 3U);  // optimal string alignment edits no part twice
    EXPECT_EQ(edit_distance("flaw", "lawn"), 2U);
    EXPECT_EQ(edit_distance("sunday", "saturday"), 3U);
}

TEST(NearestName, IsTheOneWithTheFewestSlips) {
    const std::vector<std::string> names{"--product", "--probe", "--tilt", "REF", "SW"};
    EXPECT_EQ(nearest_name("--prodct", names), "--product");
    EXPECT_EQ(nearest_name("--Probe", names), "--probe");
    EXPECT_EQ(nearest_name("--tlit", names), "--tilt");
    EXPECT_EQ(nearest_name("ref", names), "REF");
    EXPECT_EQ(nearest_name("RFE", names), "REF");
    EXPECT_EQ(nearest_name("sww", names), "SW");
}

TEST(NearestName, IsNoneIfTheWordIsAnother) {
    const std::vector<std::string> names{"volume", "section", "SW"};
    EXPECT_FALSE(nearest_name("cappi", names));
    EXPECT_FALSE(nearest_name("", names));
    EXPECT_FALSE(nearest_name("x", names)) << "a match needs fewer edits than the name has bytes";
    EXPECT_FALSE(nearest_name(std::string(81, 'v'), names));
    EXPECT_FALSE(nearest_name("volume", {}));
}

TEST(NearestName, IsAskedForInAMessage) {
    const std::vector<std::string> names{"volume", "section"};
    EXPECT_EQ(did_you_mean("volum", names), "; did you mean 'volume'?");
    EXPECT_EQ(did_you_mean("picture", names), "");
}

}  // namespace
}  // namespace stormcellar
