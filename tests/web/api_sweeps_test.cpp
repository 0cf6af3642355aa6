// The list of a volume's sweeps, and which of them pictures show.
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/web/served_volumes.h"
#include "web/service/sources.h"

namespace stormcellar::web {
namespace {

// 2026-11-28: of the split cuts of a volume the page showed the Doppler halves of reflectivity,
// with range-folded echo and half of the range.
TEST(ApiSweeps, SayWhichOfThemAPictureOfEachMomentShows) {
    STORMCELLAR_NEED_DATA();
    const ServedVolumes volumes;
    const testing::TemporaryDirectory cache;
    WebSetup setup;
    setup.catalog = volumes.state() / "catalog";
    setup.cache = cache.path();
    const auto sources = open_sources(setup);
    ASSERT_TRUE(sources) << sources.error().message;
    Measures measures;
    const auto doors = doors_to(*sources, measures);
    const std::string path = "/api/v1/stations/KTLX/volumes/2017-01-01T03:00:27Z/sweeps";
    const Answer answer = asked(*doors->find(path), path);
    ASSERT_EQ(answer.status, 200U) << body_of(answer);
    // The table of `stormcellar info`: sweeps 0 and 2 are surveillance, 1 and 3 their Doppler
    // halves.
    std::map<std::string, std::vector<int>> chosen;
    const auto list = nlohmann::json::parse(body_of(answer)).at("sweeps");
    for (const auto& sweep : list) {
        for (const auto& moment : sweep.at("moments")) {
            if (moment.at("chosen").get<bool>())
                chosen[moment.at("moment")].push_back(sweep.at("sweep"));
        }
    }
    EXPECT_EQ(chosen["REF"], (std::vector<int>{0, 2, 4, 5, 6}));
    EXPECT_EQ(chosen["VEL"], (std::vector<int>{1, 3, 4, 5, 6}));
    EXPECT_EQ(chosen["ZDR"], (std::vector<int>{0, 2, 4, 5, 6}));
}

}  // namespace
}  // namespace stormcellar::web
