// Runs the daemon with a configuration and a state of a version that accepted every name of four
// letters as a station. The configuration and the state must still work, and the log must say what
// has changed.
#include <string>

#include "stormcellar/catalog/catalog.h"
#include "tests/fault/hostile_cases.h"
#include "tests/fault/hostile_watch.h"

namespace stormcellar::fault {
namespace {

namespace fs = std::filesystem;

// A radar of the user, which is not in the table.
constexpr const char* own_radar = "XABC";
constexpr const char* own_radar_table =
    "[[station]]\nicao = \"XABC\"\nlatitude_deg = 35.3\nlongitude_deg = -97.3\n"
    "antenna_altitude_m = 400\n";

class Upgrade : public HostileCases {
  protected:
    UtcTime put_own(int plus_s) {
        const UtcTime time =
            std::chrono::floor<std::chrono::seconds>(now_utc()) + std::chrono::seconds{plus_s};
        Claims claims = claims_of("KTLX", time);
        claims.station = own_radar;
        claims.sweeps = 2;
        put(own_radar + format_compact(time), volume_bytes(claims));
        return time;
    }
    // Makes the state of the old version, which gridded the files of any station. With "any", the
    // present daemon still grids the files of up to 64 unknown stations.
    void make_state_of_before() {
        start({.ingest = "stations = \"any\"\n"});
        old_volume_ = put_good("KTLX");
        old_own_volume_ = put_own(0);
        expect_gridded("KTLX", old_volume_);
        expect_gridded(own_radar, old_own_volume_);
        EXPECT_TRUE(rests(10 * testing::slow_down)) << log_end();
        stop();
        EXPECT_TRUE(fs::remove(daemon_.catalog() / "drop-directory"));
    }
    std::size_t complete_rows_of(const std::string& station) {
        auto catalog = *catalog::CatalogReader::open(daemon_.catalog());
        const auto rows = catalog.list(station, {});
        std::size_t complete = 0;
        for (const auto& row : *rows)
            complete += row.state == catalog::FileState::complete ? 1 : 0;
        return complete;
    }
    UtcTime old_volume_, old_own_volume_;
};

TEST_F(Upgrade, AnOldStateKeepsWorkingAndTheLogSaysWhatIsOfNoStation) {
    make_state_of_before();
    start();
    EXPECT_TRUE(
        daemon_.wait_for_log("1 database of stations that [ingest] stations does not accept (" +
                             std::string{own_radar} + "): the service does not open"))
        << daemon_.log();
    expect_gridded("KTLX", put_good("KTLX", 60));
    const UtcTime second = put_own(60);
    EXPECT_TRUE(
        daemon_.wait_for_log("is of XABC, a station that [ingest] stations does not accept"))
        << log_end();
    EXPECT_TRUE(rests(10 * testing::slow_down)) << log_end();
    EXPECT_EQ(daemon_.status()["catalog"]["left_alone"], 1);
    EXPECT_FALSE(has_whole_grid(daemon_.cache(), own_radar, second));
    EXPECT_TRUE(has_whole_grid(daemon_.cache(), own_radar, old_own_volume_))
        << "the grid of the old version must stay";
    EXPECT_TRUE(has_whole_grid(daemon_.cache(), "KTLX", old_volume_));
    stop();
    EXPECT_EQ(complete_rows_of("KTLX"), 2U);
    EXPECT_EQ(complete_rows_of(own_radar), 1U) << "the old row must stay";
    EXPECT_TRUE(fs::exists(daemon_.catalog() / "drop-directory"));
}

// The log advises the user to add this table.
TEST_F(Upgrade, WithATableOfItsOwnAnOldStationGoesOn) {
    make_state_of_before();
    start();
    stop();
    start({.rest = own_radar_table});
    expect_gridded(own_radar, put_own(60));
    EXPECT_TRUE(rests(10 * testing::slow_down)) << log_end();
    EXPECT_EQ(daemon_.status()["catalog"]["left_alone"], 0);
    stop();
    EXPECT_EQ(complete_rows_of(own_radar), 2U) << "the new row and the old row";
}

}  // namespace
}  // namespace stormcellar::fault
