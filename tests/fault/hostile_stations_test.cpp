// Tests how many descriptors, databases and grids are taken by files of unknown stations, or of all
// known stations.
#include <chrono>
#include <set>
#include <string>
#include <thread>

#include "stormcellar/base/station_table.h"
#include "tests/fault/hostile_cases.h"
#include "tests/fault/hostile_watch.h"

namespace stormcellar::fault {
namespace {

namespace fs = std::filesystem;
namespace wire = level2::wire;
using std::chrono::milliseconds;
using testing::slow_down;

constexpr int few_descriptors = 512;

class InventedStations : public HostileCases {
  protected:
    // Sets the soft and the hard limit of descriptors, so that the daemon cannot raise it.
    InventedStations() {
        const std::string limit =
            std::to_string(few_descriptors) + ":" + std::to_string(few_descriptors);
        daemon_.run_under({"prlimit", "--nofile=" + limit});
    }
    void put_invented(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i)
            put(invented_station(i) + "20241003_010000", small_claim(invented_station(i), i));
    }
};

TEST_F(InventedStations, TakeNoDescriptorsAndNoDatabases) {
    start();
    put_invented(300);
    ASSERT_TRUE(rests(30 * slow_down)) << log_end();
    EXPECT_LT(open_descriptors(daemon_.id()), few_descriptors / 2);
    expect_gridded("KTLX", put_good("KTLX"));
    EXPECT_EQ(lines_with("Too many open files"), 0U);
    expect_no_invented_database();
    EXPECT_EQ(invented_among(domains_in(daemon_.cache())), std::set<std::string>{});
    stop();
    for (const auto& entry : fs::directory_iterator(daemon_.drop())) {
        if (entry.path().filename().native().starts_with('X')) fs::remove(entry.path());
    }
    start();
    expect_gridded("KTLX", put_good("KTLX", 60));
    EXPECT_LT(open_descriptors(daemon_.id()), few_descriptors / 4);
    expect_no_invented_database();
    stop();
}

// If the database of each known station stayed open, the descriptors would run out.
TEST_F(InventedStations, ClaimsOfEveryKnownStationLeaveDescriptorsForTheRest) {
    start();
    for (const Station& station : all_stations()) {
        if (station.icao == "KTLX") continue;
        put(std::string{station.icao} + "20241003_010000",
            small_claim(std::string{station.icao}, 0));
    }
    ASSERT_TRUE(rests(30 * slow_down)) << log_end();
    EXPECT_LT(open_descriptors(daemon_.id()), few_descriptors * 3 / 4);
    expect_gridded("KTLX", put_good("KTLX"));
    EXPECT_EQ(lines_with("Too many open files"), 0U);
    stop();
    start();
    expect_gridded("KTLX", put_good("KTLX", 60));
    EXPECT_LT(open_descriptors(daemon_.id()), few_descriptors * 3 / 4);
    stop();
}

// Starts the daemon beside databases such as an old version left, which accepted every station
// name.
TEST_F(InventedStations, TheDaemonStartsAndWorksWithDatabasesThatAnAttackLeft) {
    start();
    expect_gridded("KTLX", put_good("KTLX"));
    stop();
    for (std::size_t i = 0; i < 1500; ++i)
        fs::copy_file(daemon_.catalog() / "KTLX.sqlite",
                      daemon_.catalog() / (invented_station(i) + ".sqlite"));
    const double took_s = start();
    std::printf("ready after %.2f s with 1,500 databases of unknown stations\n", took_s);
    EXPECT_LT(open_descriptors(daemon_.id()), few_descriptors / 4);
    expect_gridded("KTLX", put_good("KTLX", 60));
    expect_gridded("KFWS", put_good("KFWS"));
    ASSERT_TRUE(rests(30 * slow_down)) << log_end();
    EXPECT_LT(open_descriptors(daemon_.id()), few_descriptors / 4);
    EXPECT_EQ(lines_with("Too many open files"), 0U);
    EXPECT_FALSE(daemon_.status().is_null()) << "the status could not be written";
    stop();
}

TEST_F(HostileCases, AVolumeOfDateZeroHasNoGridOf1970) {
    start();
    Claims claims = claims_of("KTLX", now_utc());
    claims.time = {0, 3'600'000};
    put("KTLX_zero", volume_bytes(claims));
    put("KTLX_plain_zero", plain_volume_bytes(claims));
    expect_gridded("KTLX", put_good("KTLX"));
    ASSERT_TRUE(rests(10 * slow_down)) << log_end();
    std::set<std::string> days;
    for (const auto& entry : fs::directory_iterator(daemon_.cache() / "KTLX/REF"))
        days.insert(entry.path().filename().native());
    for (const std::string& day : days)
        EXPECT_GE(day, "2020") << "no grid should be from before 2020";
    stop();
}

TEST_F(HostileCases, AnInventedStationInsideAMosaicDoesNotEnterIt) {
    start({.rest = "[[domain]]\nname = \"plains\"\ncenter = [35, -97]\nspacing_km = 10\n"
                   "extent_km = [300, 300]\nlevels_km = [1, 3]\n"});
    Claims claims = claims_of("KTLX", now_utc());
    claims.station = "XAAA";
    claims.is_varied = true;
    put("XAAA" + format_compact(now_utc()), volume_bytes(claims));
    expect_gridded("KTLX", put_good("KTLX"));
    EXPECT_TRUE(rests(10 * slow_down)) << log_end();
    EXPECT_TRUE(domains_in(daemon_.cache()).contains("plains.KTLX")) << log_end();
    EXPECT_FALSE(domains_in(daemon_.cache()).contains("plains.XAAA"));
    EXPECT_FALSE(domains_in(daemon_.cache()).contains("XAAA"));
    stop();
}

// Tests a file that first names no station or a known station, and then grows into a volume of an
// unknown station.
TEST_F(HostileCases, AGrowingFileOfAnInventedStationGetsNoGridAndNoDatabase) {
    start();
    Claims claims = claims_of("KTLX", now_utc());
    claims.station = "XAAA";
    claims.sweeps = 3;
    claims.is_varied = true;
    Claims nameless = claims;
    nameless.station = "    ";
    const Bytes sweep = wire::ldm_record(sweep_messages(claims, 0));
    append("nameless", file_header(nameless));
    append("KTLX_other", Bytes{});
    fs::create_directories(daemon_.drop() / "KTLX/7");
    const std::string chunk = "KTLX/7/20241003-010000-00";
    append(chunk + "1-S", wire::join({file_header(nameless), sweep}));
    EXPECT_TRUE(rests(15 * slow_down)) << log_end();
    append("nameless", sweep);
    append("KTLX_other", wire::join({file_header(claims), sweep}));
    append(chunk + "2-I", wire::ldm_record(sweep_messages(claims, 1)));
    for (const char* name : {"nameless", "KTLX_other"}) {
        EXPECT_TRUE(rests(15 * slow_down)) << log_end();
        append(name, wire::ldm_record(sweep_messages(claims, 1)));
    }
    expect_gridded("KTLX", put_good("KTLX"));
    EXPECT_TRUE(rests(15 * slow_down)) << log_end();
    EXPECT_EQ(invented_among(domains_in(daemon_.cache())), std::set<std::string>{});
    EXPECT_EQ(invented_among(databases_in(daemon_.catalog())), std::set<std::string>{});
    stop();
}

}  // namespace
}  // namespace stormcellar::fault
