#include "cli/reference/completed_names.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class CompletedNames : public ::testing::Test {
  protected:
    void SetUp() override {
        ::unsetenv("STORMCELLAR_CONFIG");
        for (const char* domain : {"KTLX", "oklahoma", "KFDR"})
            fs::create_directories(cache() / domain / "REF");
        std::ofstream(config()) << "[paths]\ndrop = \"drop\"\ncache = \"cache\"\n";
    }
    void TearDown() override { ::unsetenv("STORMCELLAR_CONFIG"); }
    [[nodiscard]] fs::path cache() const { return scratch_.path() / "cache"; }
    [[nodiscard]] fs::path config() const { return scratch_.path() / "d.toml"; }

    testing::TemporaryDirectory scratch_;
};

TEST_F(CompletedNames, AreTheDomainsOfTheCacheOnTheLine) {
    const auto domains = ElementsAre("KFDR", "KTLX", "oklahoma");
    const std::string cache = this->cache().native();
    EXPECT_THAT(completed_names("domains", {"stormcellar", "frame", "--cache", cache}), domains);
    EXPECT_THAT(completed_names("domains", {"stormcellar", "--cache=" + cache}), domains);
    EXPECT_THAT(completed_names("domains", {"stormcellar", "--cache", "=", cache, "K"}), domains)
        << "bash splits words at an equals sign";
    EXPECT_THAT(completed_names("domains", {"stormcellar", "--cache", cache + "/none"}), IsEmpty());
    EXPECT_THAT(completed_names("colors", {"--cache", cache}), IsEmpty());
}

TEST_F(CompletedNames, AreThoseOfAConfiguration) {
    EXPECT_THAT(completed_names("domains", {"stormcellar", "--config", config().native()}),
                ElementsAre("KFDR", "KTLX", "oklahoma"));
    ::setenv("STORMCELLAR_CONFIG", config().c_str(), 1);
    EXPECT_THAT(completed_names("domains", {"stormcellar"}),
                ElementsAre("KFDR", "KTLX", "oklahoma"));
}

TEST_F(CompletedNames, AreStationsOfTheCacheElseOfTheTable) {
    EXPECT_THAT(completed_names("stations", {"--cache", cache().native()}),
                ElementsAre("KFDR", "KTLX"));
    const auto all = completed_names("stations", {"--cache", cache().native() + "/none"});
    EXPECT_GT(all.size(), 150U);
    EXPECT_THAT(all, Contains("KTLX"));
}

}  // namespace
}  // namespace stormcellar::cli
