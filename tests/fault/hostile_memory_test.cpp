// Tests files that grow without end, and so take memory and places among the followed files.
#include <chrono>
#include <cstdio>
#include <functional>
#include <string_view>
#include <thread>

#include "stormcellar/base/station_table.h"
#include "tests/fault/faulty_daemon.h"
#include "tests/fault/hostile_cases.h"

namespace stormcellar::fault {
namespace {

namespace fs = std::filesystem;
namespace wire = level2::wire;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::slow_down;

constexpr long most_mib = 512;

class LivingMemory : public HostileCases {
  protected:
    static constexpr int files = 100;

    // Makes files that begin a record which never comes. Each file unpacks to 50 MB of a sweep that
    // has no end.
    void put_endless(const std::function<std::string(int)>& station_of) {
        for (int i = 0; i < files; ++i) {
            const std::string station = station_of(i);
            const Bytes bytes =
                wire::join({endless_bytes(claims_of(station, now_utc())), begun_record(500'000)});
            append(station + "_grow" + std::to_string(i), bytes);
        }
    }
    void grow_all() {
        for (const auto& entry : fs::directory_iterator(daemon_.drop())) {
            if (entry.path().native().find("_grow") != std::string::npos)
                append(entry.path(), Bytes(1, std::byte{'x'}));
        }
    }
    void expect_bounded() {
        const long peak = daemon_.peak_mib();
        std::printf("peak %ld MiB\n", peak);
        if (!is_sanitized) {
            EXPECT_LT(peak, most_mib);
        }
    }
};

TEST_F(LivingMemory, SweepsThatNeverEndAreCounted) {
    start();
    put_endless([](int) { return "KTLX"; });
    expect_gridded("KFWS", put_good("KFWS"), 2 * prompt_s);
    grow_all();
    expect_gridded("KTLX", put_good("KTLX"), 2 * prompt_s);
    EXPECT_TRUE(rests(60 * slow_down)) << log_end();
    expect_bounded();
    EXPECT_GT(daemon_.status()["growing_given_up"], 0);
    stop();
}

TEST_F(LivingMemory, SweepsOfManyStationsThatNeverEndAreCounted) {
    start();
    const auto stations = all_stations();
    put_endless([&](int i) { return std::string{stations[static_cast<std::size_t>(i)].icao}; });
    expect_gridded("KTLX", put_good("KTLX"), 2 * prompt_s);
    grow_all();
    expect_gridded("KFWS", put_good("KFWS"), 2 * prompt_s);
    EXPECT_TRUE(rests(60 * slow_down)) << log_end();
    expect_bounded();
    stop();
}

// The bytes of the unfinished record are a hole in the file, which costs the sender nothing.
TEST_F(LivingMemory, RecordsThatNeverEndAreCounted) {
    constexpr std::uint32_t record_bytes = 30'000'000;  // the longest that is allowed
    start();
    for (int i = 0; i < 30; ++i) {
        Claims claims = claims_of("KTLX", now_utc());
        const Bytes bytes =
            wire::join({endless_bytes(claims, 125, 100), begun_record(record_bytes)});
        const std::string name = "KTLX_begun" + std::to_string(i);
        append(name, bytes);
        fs::resize_file(daemon_.drop() / name, bytes.size() + record_bytes - 1000);
    }
    expect_gridded("KFWS", put_good("KFWS"), 2 * prompt_s);
    EXPECT_TRUE(rests(60 * slow_down)) << log_end();
    expect_bounded();
    stop();
}

// Begins more files and volumes of chunks than the service follows, and never continues them.
TEST_F(LivingMemory, WhatOnlyBeginsTakesNoPlaceFromWhatGoesOn) {
    start({.quiet_s = 60});
    const auto begun = [](std::string_view station) {
        Claims claims = claims_of(station, now_utc() - std::chrono::hours{1});
        claims.sweeps = 2;
        return wire::join({file_header(claims), wire::ldm_record(sweep_messages(claims, 0))});
    };
    for (int i = 0; i < 2; ++i) {
        for (const Station& station : all_stations()) {
            const std::string name{station.icao};
            put(name + "_begun" + std::to_string(i), begun(name));
            put(fs::path{name} / std::to_string(i) / "20241003-010000-001-S", begun(name));
        }
    }
    EXPECT_TRUE(rests(20 * slow_down));
    Claims growing = claims_of("KTLX", std::chrono::floor<seconds>(now_utc()));
    Claims of_chunks = claims_of("KFWS", std::chrono::floor<seconds>(now_utc()));
    growing.sweeps = of_chunks.sweeps = 3;
    for (unsigned sweep = 0; sweep < 3; ++sweep) {
        const auto record = [&](const Claims& claims) {
            const Bytes bytes = wire::ldm_record(sweep_messages(claims, sweep), sweep == 2);
            return sweep == 0 ? wire::join({file_header(claims), bytes}) : bytes;
        };
        const Bytes bytes = record(growing);
        append("KTLX_real", bytes);
        const std::string kind{"SIE"[sweep]};
        put("KFWS/77/20241003-020000-00" + std::to_string(sweep + 1) + "-" + kind,
            record(of_chunks));
        EXPECT_TRUE(rests(20 * slow_down)) << log_end();
    }
    const auto time_of = [](const Claims& claims) {
        return time_from_nexrad(claims.time.day, claims.time.milliseconds);
    };
    expect_gridded("KTLX", time_of(growing));
    expect_gridded("KFWS", time_of(of_chunks));
    stop();
}

}  // namespace
}  // namespace stormcellar::fault
