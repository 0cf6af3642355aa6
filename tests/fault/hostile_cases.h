// tests/fault/hostile_cases.h -- a daemon under one kind of attack, and checks that it still grids
// good volumes.
//
// Each attack once stopped ingest or harmed honest stations. Whatever files claim, known stations
// must go on as before.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "stormcellar/base/utc_time.h"
#include "tests/daemon/running_daemon.h"
#include "tests/fault/hostile_files.h"
#include "tests/testing/slow_down.h"

namespace stormcellar::fault {

// the longest wait of a good volume during an attack
inline constexpr double prompt_s = 5.0 * testing::slow_down;

// Additions to the quick configuration of the daemon.
struct More {
    std::string watch = {}, ingest = {}, cache = {}, rest = {};
    int quiet_s = 2;
};

class HostileCases : public ::testing::Test {
  protected:
    // Starts the daemon. Returns the seconds until it was ready.
    double start(const More& more = {});
    void stop() { EXPECT_EQ(daemon_.terminate(), 0) << log_end(); }
    // Writes a file as a script does: under a dot-name, then renames it.
    void put(const std::filesystem::path& name, const Bytes& bytes);
    // Appends to a file under its own name, as LDM does.
    void append(const std::filesystem::path& name, const Bytes& bytes);
    // Writes a valid volume whose time is the current second plus `plus_s`. Returns its time.
    UtcTime put_good(const std::string& station, int plus_s = 0, unsigned gates = 400);

    // Waits until the volume is gridded. Returns how many seconds that took; fails if it takes more
    // than `most_s`.
    double expect_gridded(const std::string& station, UtcTime time, double most_s = prompt_s);
    void expect_no_invented_database();
    bool rests(double most_s);
    // Returns the files that no row of the catalog reports as rejected with a reason; empty: all
    // are rejected.
    [[nodiscard]] std::string not_rejected(const std::vector<std::filesystem::path>& names) const;

    // Returns the number of log lines with this text; an empty `severity` means any severity.
    [[nodiscard]] std::size_t lines_with(const std::string& text,
                                         const std::string& severity = {}) const;
    [[nodiscard]] std::size_t complaints_about(const std::string& text) const;
    [[nodiscard]] std::string log_end() const;

    daemon::RunningDaemon daemon_;
};

// Returns a file of 300 bytes that claims to be of a station.
[[nodiscard]] Bytes small_claim(const std::string& station, std::size_t number);

}  // namespace stormcellar::fault
