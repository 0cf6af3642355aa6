#include "stormcellar/accuracy/effect.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stormcellar::accuracy {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<std::string> names = {"refraction", "ellipsoid", "beam_width", "cell_size"};

std::string override_error(const std::string& text) {
    const auto parsed = parse_override(text, names);
    if (parsed) return "no error";
    EXPECT_EQ(parsed.error().code, ErrorCode::bad_argument);
    return parsed.error().message;
}

TEST(Effect, OverridesNameAnEffectAndASetting) {
    const auto on = parse_override("refraction=on", names);
    ASSERT_TRUE(on);
    EXPECT_EQ(on->name, "refraction");
    EXPECT_EQ(on->setting, Setting::on);
    EXPECT_EQ(parse_override("beam_width=off", names)->setting, Setting::off);
    EXPECT_EQ(parse_override("cell_size=auto", names)->setting, Setting::automatic);
}

TEST(Effect, AMisspeltNameIsAnsweredWithTheNearest) {
    EXPECT_THAT(override_error("refracton=on"), HasSubstr("did you mean \"refraction\"?"));
    EXPECT_THAT(override_error("elipsiod=off"), HasSubstr("did you mean \"ellipsoid\"?"));
    EXPECT_THAT(override_error("beam-width=on"), HasSubstr("did you mean \"beam_width\"?"));
    EXPECT_THAT(override_error("Cell_Size=on"), HasSubstr("did you mean \"cell_size\"?"));
}

TEST(Effect, WhatIsNoMisspellingIsAnsweredWithTheList) {
    EXPECT_THAT(override_error("wind=on"),
                HasSubstr("the effects are refraction, ellipsoid, beam_width"));
    EXPECT_THAT(override_error("wind=on"), Not(HasSubstr("did you mean")));
    EXPECT_THAT(override_error(std::string(1000000, 'x') + "=on"),
                HasSubstr("the effects are refraction"));
    EXPECT_LT(override_error(std::string(1000000, 'x') + "=on").size(), 400U);
    EXPECT_THAT(parse_override("a=on", {}).error().message, HasSubstr("there are none"));
}

TEST(Effect, OtherFormsAreRefused) {
    for (const char* text : {"", "refraction", "=on", "="}) {
        EXPECT_THAT(override_error(text), HasSubstr("NAME=on|off|auto")) << text;
    }
    for (const char* text : {"refraction=", "refraction=yes", "refraction=on ", "refraction=ON",
                             "refraction=on=off"}) {
        EXPECT_THAT(override_error(text), HasSubstr("can be on, off or auto")) << text;
    }
    EXPECT_THAT(override_error("refraction=\x1b[2J"), HasSubstr("\\x1b"));
}

TEST(Effect, NamesAreSnakeCase) {
    for (const char* name : {"a", "refraction", "beam_width", "cut2_time"}) {
        EXPECT_TRUE(is_effect_name(name)) << name;
    }
    for (const char* name :
         {"", "A", "beam width", "_a", "a_", "a__b", "2a", "beam-width", "\xc3\xa9"}) {
        EXPECT_FALSE(is_effect_name(name)) << name;
    }
    EXPECT_TRUE(is_effect_name(std::string(40, 'a')));
    EXPECT_FALSE(is_effect_name(std::string(41, 'a')));
}

}  // namespace
}  // namespace stormcellar::accuracy
