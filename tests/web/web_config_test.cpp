// Reads [web] tables as an operator may write them, and checks the error messages.
#include "web/config/web_config.h"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/testing/temporary_directory.h"
#include "web/config/web_setup.h"

namespace stormcellar::web {
namespace {

// Returns the setup of a configuration with these lines in [web].
Result<WebSetup> setup_of(const std::string& lines) {
    const testing::TemporaryDirectory directory;
    const auto file = directory / "stormcellard.toml";
    std::ofstream(file) << "[web]\n" << lines << "\n";
    return load_web_setup(file);
}

TEST(WebConfig, TheOriginsThatEmbedPagesAreRead) {
    const auto setup = setup_of("embed_in = ['https://news.example.org', 'HTTP://10.0.0.1:8080']");
    ASSERT_TRUE(setup) << setup.error().message;
    EXPECT_EQ(setup->web.embed_in,
              (std::vector<std::string>{"https://news.example.org", "http://10.0.0.1:8080"}));
    EXPECT_TRUE(setup_of("")->web.embed_in.empty());
}

TEST(WebConfig, OverlaysAreNamedAndHaveAbsolutePaths) {
    const auto setup = setup_of("[[overlay]]\nname = 'warnings'\npath = '/var/lib/warnings'");
    ASSERT_TRUE(setup) << setup.error().message;
    EXPECT_EQ(setup->web.overlays,
              (std::vector<ConfiguredOverlay>{{"warnings", "/var/lib/warnings"}}));
    const std::string good = "[[overlay]]\nname = 'a'\npath = '/a'\n";
    for (const char* lines :
         {"[[overlay]]\npath = '/a'", "[[overlay]]\nname = 'a/b'\npath = '/a'",
          "[[overlay]]\nname = '..'\npath = '/a'", "[[overlay]]\nname = 'b'",
          "[[overlay]]\nname = 'b'\npath = 'b.json'", "[[overlay]]\nname = 'a'\npath = '/b'"}) {
        const auto refused = setup_of(good + lines);
        ASSERT_FALSE(refused) << lines;
        EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
        EXPECT_NE(refused.error().message.find("[overlay]"), std::string::npos)
            << refused.error().message;
    }
}

TEST(WebConfig, WhatIsNoOriginIsRefusedByName) {
    for (const char* origin : {"*", "news.example.org", "https://news.example.org/path",
                               "https://a.example; script-src *", "https://a.example b.example"}) {
        const auto setup = setup_of(fmt::format("embed_in = ['{}']", origin));
        ASSERT_FALSE(setup) << origin;
        EXPECT_EQ(setup.error().code, ErrorCode::bad_argument);
        EXPECT_NE(setup.error().message.find(":2: [web] embed_in: "), std::string::npos)
            << setup.error().message;
    }
}

TEST(WebConfig, OtherTextsThatMakeNoSenseAreRefused) {
    for (const char* line :
         {"listen = ['localhost:80']", "names = ['a b']", "trusted_proxies = ['proxy.example']",
          "serve = ['everything']", "cors = 'some'", "bucket = 'No'", "public_address = 'here'"}) {
        const auto setup = setup_of(line);
        ASSERT_FALSE(setup) << line;
        const std::string key = std::string(line).substr(0, std::string(line).find(' '));
        EXPECT_NE(setup.error().message.find("[web] " + key + ": "), std::string::npos)
            << setup.error().message;
    }
}

}  // namespace
}  // namespace stormcellar::web
