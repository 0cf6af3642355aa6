// tests/fault/hostile_cases.h -- a daemon under one kind of attack, and what good volumes may
// expect of it meanwhile.
//
// Each case once stopped ingest, or took something from stations that did nothing wrong. Whatever
// is claimed, known stations must go on as before.
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

// Additions to the configuration that makes the daemon quick.
struct More {
    std::string watch = {}, ingest = {}, cache = {}, rest = {};
    int quiet_s = 2;
};

class HostileCases : public ::testing::Test {
  protected:
    // Returns the seconds until it was ready.
    double start(const More& more = {});
    void stop() { EXPECT_EQ(daemon_.terminate(), 0) << log_end(); }
    // Writes like a script: under a dot-name, then renamed.
    void put(const std::filesystem::path& name, const Bytes& bytes);
    // Writes like LDM: under its own name.
    void append(const std::filesystem::path& name, const Bytes& bytes);
    // Writes a valid volume whose time is the current second plus `plus_s`. Returns its time.
    UtcTime put_good(const std::string& station, int plus_s = 0, unsigned gates = 400);

    // Returns the seconds until it is gridded; fails if that takes more than `most_s`.
    double expect_gridded(const std::string& station, UtcTime time, double most_s = prompt_s);
    void expect_no_invented_database();
    bool rests(double most_s);
    // Returns those of these files that no row reports as rejected with a reason; empty: none.
    [[nodiscard]] std::string not_rejected(const std::vector<std::filesystem::path>& names) const;

    // Returns the number of lines of the log with this text, of this severity or of any.
    [[nodiscard]] std::size_t lines_with(const std::string& text,
                                         const std::string& severity = {}) const;
    [[nodiscard]] std::size_t complaints_about(const std::string& text) const;
    [[nodiscard]] std::string log_end() const;

    daemon::RunningDaemon daemon_;
};

// A file of 300 bytes that claims to be of a station.
[[nodiscard]] Bytes small_claim(const std::string& station, std::size_t number);

}  // namespace stormcellar::fault
