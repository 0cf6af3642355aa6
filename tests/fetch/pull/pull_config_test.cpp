#include "fetch/pull/pull_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fetch/config_file.h"

namespace stormcellar::pull {
namespace {

using ::testing::HasSubstr;

using PullConfigFile = testing::ConfigFile<load_pull_config>;

TEST_F(PullConfigFile, TheShippedFileHoldsEveryDefault) {
    const auto shipped = load_shipped();
    ASSERT_TRUE(shipped) << shipped.error().message;
    EXPECT_TRUE(*shipped == PullConfig{});
}

TEST_F(PullConfigFile, EveryKeyIsTaken) {
    const auto config = load(
        "[pull]\ndirectory = \"grids\"\nevery_seconds = 0.5\nage_hours = 2\nbytes = \"3 GB\"\n"
        "stall_seconds = 7\n[[pull.from]]\nname = \"north\"\nurl = "
        "\"http://n.example.org:8090/a/\"\n"
        "domains = [\"us\"]\nstations = [\"KBGM\"]\n[[pull.from]]\nname = \"south\"\nurl = "
        "\"https://[::1]\"\n"
        "[log]\nlevel = \"debug\"\n");
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_EQ(config->directory, directory_ / "grids");
    EXPECT_EQ(config->every, std::chrono::milliseconds{500});
    EXPECT_EQ(config->age, std::chrono::hours{2});
    EXPECT_EQ(config->bytes_a_source, 3'000'000'000U);
    EXPECT_EQ(config->stall, std::chrono::seconds{7});
    EXPECT_EQ(config->log_level, "debug");
    ASSERT_EQ(config->sources.size(), 2U);
    EXPECT_EQ(config->sources[0].url, "http://n.example.org:8090/a");
    EXPECT_EQ(config->sources[0].domains, std::vector<std::string>{"us"});
    EXPECT_EQ(config->sources[0].stations, std::vector<std::string>{"KBGM"});
    EXPECT_EQ(config->sources[1].url, "https://[::1]");
}

TEST_F(PullConfigFile, WhatMakesNoSenseIsNamedWithItsLine) {
    const auto with = [&](const std::string& name, const std::string& url) {
        return complaint("[[pull.from]]\nname = \"" + name + "\"\nurl = \"" + url + "\"\n");
    };
    EXPECT_THAT(with("../up", "http://a"), HasSubstr("s.toml:2: [pull.from] name"));
    EXPECT_THAT(with("a.KTLX", "http://a"), HasSubstr("name"));
    for (const char* url : {"", "ftp://a", "http://", "http:///x", "http://a?b", "http://u@a",
                            "http://a b", "a:8090", "file:///etc/passwd"})
        EXPECT_THAT(with("north", url), HasSubstr("url: must be an address")) << url;
    EXPECT_THAT(complaint("[pull]\nbytes = \"10 kB\"\n"), HasSubstr("at least 1 MB"));
    EXPECT_THAT(complaint("[pull]\never_seconds = 5\n"), HasSubstr("ever_seconds"));
    EXPECT_THAT(complaint("[[pull.from]]\nname = \"a\"\nurl = \"http://a\"\n"
                          "[[pull.from]]\nname = \"a\"\nurl = \"http://b\"\n"),
                HasSubstr("named twice"));
}

}  // namespace
}  // namespace stormcellar::pull
