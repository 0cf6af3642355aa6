#include "notify/notify_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fetch/config_file.h"

namespace stormcellar::notify {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class NotifyConfigFile : public testing::ConfigFile<load_notify_config> {
  protected:
    // Returns the complaint about a rule in which `key` has the given value. If the value is empty,
    // the rule lacks the key.
    std::string complaint_with(const std::string& key, const std::string& value) {
        std::string text = "[[notify.rule]]\n";
        std::map<std::string, std::string> keys = {
            {"name", "\"moore\""}, {"area", "\"KTLX\""}, {"place", "[35.34, -97.49]"},
            {"radius_km", "30"},   {"max_dbz", "55"},    {"url", "\"http://a\""}};
        keys[key] = value;
        for (const auto& [name, given] : keys) {
            if (!given.empty()) text += name + " = " + given + "\n";
        }
        return complaint(text);
    }
};

TEST_F(NotifyConfigFile, TheShippedFileHoldsEveryDefault) {
    const auto shipped = load_shipped();
    ASSERT_TRUE(shipped) << shipped.error().message;
    EXPECT_TRUE(*shipped == NotifyConfig{});
}

TEST_F(NotifyConfigFile, EveryKeyIsTaken) {
    const auto config = load(
        "[paths]\ncache = \"grids\"\n[notify]\ndirectory = \"out\"\nfreezing_levels_m = [3000, "
        "6100]\n"
        "[[notify.rule]]\nname = \"moore\"\narea = \"KTLX\"\nplace = [35.34, -97.49]\n"
        "radius_km = 30\nmax_dbz = 55\nvil_kg_per_m2 = 20\nmesh_mm = 25\ntop_km = 9.5\n"
        "every_minutes = 20\nurl = \"https://hooks.example.org/a/b\"\n"
        "[[notify.rule]]\nname = \"norman\"\narea = \"central\"\nplace = \"KTLX\"\nradius_km = 5\n"
        "mesh_mm = 25\nmqtt = \"mqtt://[::1]:1884/storms/norman\"\npassword_file = \"secret\"\n"
        "[log]\nlevel = \"debug\"\n");
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_EQ(config->cache, directory_ / "grids");
    EXPECT_EQ(config->directory, directory_ / "out");
    EXPECT_EQ(config->freezing, (retrieve::FreezingLevels{3000, 6100}));
    EXPECT_EQ(config->log_level, "debug");
    ASSERT_EQ(config->rules.size(), 2U);
    NotifyRule moore{.name = "moore",
                     .area = "KTLX",
                     .latitude_deg = 35.34,
                     .longitude_deg = -97.49,
                     .radius_km = 30,
                     .thresholds = {55, 20, 25, 9.5},
                     .every = std::chrono::minutes{20},
                     .url = "https://hooks.example.org/a/b"};
    EXPECT_TRUE(config->rules[0] == moore);
    EXPECT_EQ(config->rules[1].every, std::chrono::minutes{15});
    EXPECT_TRUE(config->rules[1].mqtt == (MqttAddress{"::1", 1884, "storms/norman"}));
    EXPECT_EQ(config->rules[1].password_file, directory_ / "secret");
    EXPECT_NEAR(config->rules[1].latitude_deg, 35.333, 0.001) << "the radar's";
    EXPECT_NEAR(config->rules[1].longitude_deg, -97.278, 0.001);
}

TEST_F(NotifyConfigFile, WhatMakesNoSenseIsNamedWithItsLine) {
    EXPECT_THAT(complaint_with("radius_km", "30"), HasSubstr("it was taken"));
    EXPECT_THAT(complaint_with("name", "\"../up\""), HasSubstr("s.toml:4: [notify.rule] name"));
    EXPECT_THAT(complaint_with("area", "\"us.KTLX\""), HasSubstr("area: must be a station"));
    for (const char* place : {"", "[35]", "[91, 0]", "[35, -181]", "[nan, 0]", "\"Moore\""})
        EXPECT_THAT(complaint_with("place", place), HasSubstr("place")) << place;
    EXPECT_THAT(complaint_with("place", "\"Moore, OK\""), HasSubstr("it was taken"));
    EXPECT_THAT(complaint_with("place", "\"Moore\""),
                AllOf(HasSubstr("place: 'Moore' may be"), HasSubstr("Moore, OK")));
    EXPECT_THAT(complaint_with("place", "\"Norrman, OK\""),
                HasSubstr("did you mean 'Norman, OK'?"));
    EXPECT_THAT(complaint_with("place", "\"91,0\""), HasSubstr("must be a latitude"));
    for (const char* radius : {"", "0", "1001", "nan"})
        EXPECT_THAT(complaint_with("radius_km", radius), HasSubstr("radius_km")) << radius;
    EXPECT_THAT(complaint_with("max_dbz", ""), HasSubstr("max_dbz: or vil_kg_per_m2"));
    EXPECT_THAT(complaint_with("max_dbz", "81"), HasSubstr("max_dbz"));
    EXPECT_THAT(complaint_with("every_minutes", "0"), HasSubstr("every_minutes"));
    EXPECT_THAT(complaint_with("url", "\"ftp://a\""), HasSubstr("url: must be an address"));
    EXPECT_THAT(complaint_with("url", ""), HasSubstr("url: or mqtt must be given"));
    EXPECT_THAT(complaint_with("mqtt", "\"mqtt://a/b\""), HasSubstr("not both"));
    EXPECT_THAT(complaint_with("password_file", "\"a\""), HasSubstr("is for mqtt only"));
    EXPECT_THAT(complaint_with("radius", "3"), HasSubstr("radius"));
}

TEST_F(NotifyConfigFile, AddressesOfBrokers) {
    const auto with = [&](const std::string& mqtt) {
        return complaint(
            "[[notify.rule]]\nname = \"a\"\narea = \"KTLX\"\nplace = [35, -97]\n"
            "radius_km = 3\nmax_dbz = 5\nmqtt = \"" +
            mqtt + "\"\n");
    };
    EXPECT_EQ(with("mqtt://broker/a"), "it was taken");
    const auto address_of = [&](const std::string& mqtt) {
        return load(
                   "[[notify.rule]]\nname = \"a\"\narea = \"KTLX\"\nplace = [35, -97]\n"
                   "radius_km = 3\nmax_dbz = 5\nmqtt = \"" +
                   mqtt + "\"\n")
            ->rules.at(0)
            .mqtt;
    };
    EXPECT_EQ(address_of("mqtt://broker/a"), (MqttAddress{"broker", 1883, "a", false}));
    EXPECT_EQ(address_of("mqtts://broker/a/b"), (MqttAddress{"broker", 8883, "a/b", true}));
    EXPECT_EQ(address_of("mqtts://[::1]:99/a"), (MqttAddress{"::1", 99, "a", true}));
    for (const char* mqtt :
         {"", "mqtt://", "mqtt://broker", "mqtt://broker/", "mqtt:///a", "mqtt://broker:0/a",
          "mqtt://broker:65536/a", "mqtt://broker:1x/a", "mqtt://broker/a/#", "mqtt://broker/+/a",
          "mqtt://u:p@broker/a", "mqttss://broker/a", "mqtts://broker", "http://broker/a",
          "mqtt://[]/a"})
        EXPECT_THAT(with(mqtt), HasSubstr("mqtt: must be an address")) << mqtt;
    EXPECT_THAT(with("mqtt://broker/" + std::string(257, 'a')), HasSubstr("must be an address"));
}

TEST_F(NotifyConfigFile, RulesAndLevels) {
    const std::string rule =
        "[[notify.rule]]\nname = \"a\"\narea = \"KTLX\"\nplace = [35, -97]\n"
        "radius_km = 3\nmax_dbz = 5\nurl = \"http://a\"\n";
    EXPECT_THAT(complaint(rule + rule), HasSubstr("a is named twice"));
    for (const char* levels : {"[4200]", "[8000, 9000]", "[3000, 3500]"})
        EXPECT_THAT(complaint(fmt::format("[notify]\nfreezing_levels_m = {}\n", levels)),
                    HasSubstr("freezing_levels_m"))
            << levels;
}

}  // namespace
}  // namespace stormcellar::notify
