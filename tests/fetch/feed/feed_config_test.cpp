#include "fetch/feed/feed_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/base/station_table.h"
#include "tests/fetch/config_file.h"

namespace stormcellar::feed {
namespace {

using ::testing::HasSubstr;

using FeedConfigFile = testing::ConfigFile<load_feed_config>;

TEST_F(FeedConfigFile, TheShippedFileHoldsEveryDefault) {
    const auto shipped = load_shipped();
    ASSERT_TRUE(shipped) << shipped.error().message;
    EXPECT_TRUE(*shipped == FeedConfig{});
}

TEST_F(FeedConfigFile, EveryKeyIsTaken) {
    const auto config = load(
        "[paths]\ndrop = \"raw\"\n[feed]\nstations = [\"KTLX\", \"KFDR\", \"KTLX\"]\n"
        "drop = \"raw/feed\"\nstate = \"run\"\nbucket = \"http://127.0.0.1:23000/chunks/\"\n"
        "every_seconds = 7.5\nkeep_hours = 2\nbytes = \"3 GB\"\nstall_seconds = 7\n"
        "proxy = \"http://proxy:3128\"\nca_file = \"ca.pem\"\n[log]\nlevel = \"debug\"\n");
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_EQ(config->stations, (std::vector<std::string>{"KTLX", "KFDR"}));
    EXPECT_EQ(config->drop, directory_ / "raw/feed");
    EXPECT_EQ(config->state, directory_ / "run");
    EXPECT_EQ(config->bucket, "http://127.0.0.1:23000/chunks");
    EXPECT_EQ(config->every, std::chrono::milliseconds{7500});
    EXPECT_EQ(config->keep, std::chrono::hours{2});
    EXPECT_EQ(config->bytes, 3'000'000'000U);
    EXPECT_EQ(config->stall, std::chrono::seconds{7});
    EXPECT_EQ(config->proxy, "http://proxy:3128");
    EXPECT_EQ(config->ca_file, (directory_ / "ca.pem").native());
    EXPECT_EQ(config->log_level, "debug");
}

TEST_F(FeedConfigFile, KnownStationsAreThoseOfTheTable) {
    const auto config = load("[paths]\ndrop = \"a\"\n[feed]\nstations = \"known\"\ndrop = \"a\"\n");
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_EQ(config->stations.size(), all_stations().size());
}

TEST_F(FeedConfigFile, WhatMakesNoSenseIsNamedWithItsLine) {
    EXPECT_THAT(complaint("[feed]\nstations = \"all\"\n"), HasSubstr("s.toml:2: [feed] stations"));
    EXPECT_THAT(complaint("[feed]\nstations = [\"../x\"]\n"), HasSubstr("is not an ICAO"));
    for (const char* url : {"", "ftp://a", "http://", "http://a?b", "http://u@a", "file:///etc"})
        EXPECT_THAT(complaint(fmt::format("[feed]\nbucket = \"{}\"\n", url)),
                    HasSubstr("bucket: must be an address"));
    EXPECT_THAT(complaint("[feed]\nproxy = \"proxy:3128\"\n"), HasSubstr("proxy: must be"));
    EXPECT_THAT(complaint("[feed]\nevery_seconds = 1\n"), HasSubstr("every_seconds"));
    EXPECT_THAT(complaint("[feed]\nbytes = \"10 kB\"\n"), HasSubstr("at least 1 MB"));
    EXPECT_THAT(complaint("[feed]\never_seconds = 5\n"), HasSubstr("ever_seconds"));
}

TEST_F(FeedConfigFile, ADropDirectoryThatTheDaemonDoesNotReadIsNamed) {
    const std::string feed = "[feed]\nstations = [\"KTLX\"]\ndrop = \"a/b\"\n";
    EXPECT_THAT(complaint("[paths]\ndrop = \"c\"\n" + feed), HasSubstr("[feed] drop: must be"));
    EXPECT_THAT(complaint("[paths]\ndrop = \"a/bc\"\n" + feed), HasSubstr("[feed] drop: must be"));
    EXPECT_TRUE(load("[paths]\ndrop = \"a\"\n" + feed));
    EXPECT_TRUE(load("[paths]\ndrop = \"a/b/\"\n" + feed));
}

}  // namespace
}  // namespace stormcellar::feed
