// Tests how much space of the cache the grids of unknown stations may take.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <set>

#include "tests/fault/hostile_cases.h"
#include "tests/fault/hostile_watch.h"

namespace stormcellar::fault {
namespace {

namespace fs = std::filesystem;
using testing::slow_down;

class ProtectedNewest : public HostileCases {
  protected:
    static More with(const std::string& ingest) {
        return {.ingest = ingest, .cache = "bytes = \"20 MB\"\n"};
    }
    void expect_standing(const std::vector<UtcTime>& history) {
        const auto stand = std::count_if(history.begin(), history.end(), [&](UtcTime time) {
            return has_whole_grid(daemon_.cache(), "KTLX", time);
        });
        EXPECT_EQ(stand, static_cast<std::ptrdiff_t>(history.size()))
            << "grids of real history were evicted";
    }
    // Delivers volumes whose grids take some 300 kB each.
    void put_invented_sites(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            Claims claims = invented_claims(i, now_utc() - std::chrono::hours{1});
            claims.sweeps = 4;
            claims.gates = 900;
            claims.is_varied = true;
            put(claims.station + "20241003_010000", plain_volume_bytes(claims));
        }
    }
};

// The configuration of HostileCases, but with larger grids.
constexpr const char* large_grids = "[ingest]\nquiet_seconds = 2\nworkers = 2\nspacing_km = 4\n";

TEST_F(ProtectedNewest, GridsOfInventedSitesPushOutNoRealHistory) {
    const std::string config =
        "[watch]\nrescan_seconds = 2\n[cache]\npercent = 0\nbytes = \"20 MB\"\n" +
        std::string{large_grids} + "stations = \"any\"\n";
    start_until_ready(daemon_, config);
    std::vector<UtcTime> history;
    for (int i = 0; i < 12; ++i)
        history.push_back(put_good("KTLX", -7200 + 300 * i, 900));
    for (const UtcTime time : history)
        expect_gridded("KTLX", time, 2 * prompt_s);
    put_invented_sites(110);
    ASSERT_TRUE(rests(60 * slow_down)) << log_end();
    const auto invented = invented_among(domains_in(daemon_.cache()));
    std::printf("%zu invented sites have grids\n", invented.size());
    EXPECT_LE(invented.size(), 64U);
    expect_standing(history);
    for (const char* station : {"KTLX", "KFWS", "KINX"})
        expect_gridded(station, put_good(station, 0, 1200));
    EXPECT_EQ(lines_with("leave no room for"), 0U);
    EXPECT_LE(disk_bytes_below(daemon_.cache()), 20'000'000U);
    expect_standing(history);
    stop();
}

TEST_F(ProtectedNewest, ByDefaultAnInventedSiteHasNoGrid) {
    start(with(""));
    put_invented_sites(20);
    expect_gridded("KTLX", put_good("KTLX"));
    ASSERT_TRUE(rests(30 * slow_down)) << log_end();
    EXPECT_EQ(invented_among(domains_in(daemon_.cache())), std::set<std::string>{});
    expect_no_invented_database();
    const auto rows = catalog_rows(daemon_.catalog());
    const auto row = rows.find(daemon_.drop() / (invented_station(7) + "20241003_010000"));
    ASSERT_NE(row, rows.end());
    EXPECT_EQ(row->second.database, "_unknown");
    stop();
}

}  // namespace
}  // namespace stormcellar::fault
