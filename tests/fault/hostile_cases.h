// tests/fault/hostile_cases.h -- a daemon that is attacked in one way, and what good volumes may
// expect of it meanwhile.
//
// Each case stopped ingest once, or took from stations that did nothing wrong; whatever is claimed,
// the stations that are known go on as before.
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

// What a good volume may wait beside an attack.
inline constexpr double prompt_s = 5.0 * testing::slow_down;

// What a configuration says beyond what makes the daemon quick.
struct More {
    std::string watch = {}, ingest = {}, cache = {}, rest = {};
    int quiet_s = 2;
};

class HostileCases : public ::testing::Test {
  protected:
    // Gives the seconds until it was ready.
    double start(const More& more = {});
    void stop() { EXPECT_EQ(daemon_.terminate(), 0) << log_end(); }
    // As a script does it: under a dot-name, then renamed.
    void put(const std::filesystem::path& name, const Bytes& bytes);
    // As LDM does it: under its own name.
    void append(const std::filesystem::path& name, const Bytes& bytes);
    // A volume that nobody could object to, of this second plus so many. Gives its time.
    UtcTime put_good(const std::string& station, int plus_s = 0, unsigned gates = 400);

    // Seconds until it is gridded; it fails where it is not within `most_s`.
    double expect_gridded(const std::string& station, UtcTime time, double most_s = prompt_s);
    void expect_no_invented_database();
    bool rests(double most_s);
    // Of these files those of which no row says that they were rejected, and why; empty: none.
    [[nodiscard]] std::string not_rejected(const std::vector<std::filesystem::path>& names) const;

    // Lines of the log with this text, of this severity or of any one.
    [[nodiscard]] std::size_t lines_with(const std::string& text,
                                         const std::string& severity = {}) const;
    [[nodiscard]] std::size_t complaints_about(const std::string& text) const;
    [[nodiscard]] std::string log_end() const;

    daemon::RunningDaemon daemon_;
};

// A file of 300 bytes that claims to be of a station.
[[nodiscard]] Bytes small_claim(const std::string& station, std::size_t number);

}  // namespace stormcellar::fault
