// daemon/status/station_book.h -- the results of each station: when, how fast, and what was wrong.
//
// Times are those of two clocks. The radar's clock gives the start of a volume and its newest
// radial; times more than 10 minutes ahead of the system's clock do not count. The system's clock
// tells when data were last read, and when a volume was last put into the cache. antenna_to_cache
// is the time from the newest radial of a volume to its grids in the cache. Only data that can have
// come live (at most an hour old, not more than 10 minutes ahead) enter the timings. Other volumes,
// such as replayed ones, are counted, and the last value is stored as it is. Memory is bounded
// however many stations the files claim: beyond `most_stations` a new station is left out, and its
// files are counted. Thread contract: plain data; one thread changes it.
#pragma once

#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemon/queue/worker_pool.h"
#include "daemon/status/status_names.h"
#include "daemon/status/timings.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::daemon {

// The missing chunks of one volume.
struct MissingChunks {
    std::optional<UtcTime> volume_time;
    std::optional<int> volume_number;  // 0 to 999
    std::vector<int> numbers;          // the first 64 of them, counted from 1
    std::size_t count = 0;             // all of them
};

struct StationState {
    std::optional<UtcTime> volume_time;    // start of the newest gridded volume
    std::optional<UtcTime> newest_radial;  // of the newest gridded volume
    std::optional<UtcTime> ingested_at;    // when a volume was last gridded
    std::optional<UtcTime> data_at;        // when a file or chunk was last read
    PerResult<std::uint64_t> results{};    // files
    std::uint64_t partial = 0;             // incomplete ones among the gridded files
    Timings close_to_cache{128};
    std::uint64_t living = 0;      // living grids, each time that sweeps entered one
    Timings close_to_living{128};  // from the close that completed a sweep to its grid
    Timings antenna_to_cache{128};
    std::optional<double> last_antenna_s;  // whatever its value
    std::uint64_t not_live = 0;            // volumes that antenna_to_cache leaves out
    std::uint64_t missing_chunks = 0;
    std::deque<MissingChunks> missing;  // the last 8 volumes with missing chunks, oldest first
};

class StationBook {
  public:
    static constexpr std::size_t most_stations = 512;
    static constexpr std::chrono::minutes most_ahead{10};
    static constexpr std::chrono::hours most_live_age{1};
    static constexpr std::chrono::hours known_for{7 * 24};

    // `latency_s`: from the close, if it was seen, to the end of the job; `at`: the system's clock
    // when the job ended.
    void add(const pipeline::IngestOutcome& outcome, std::optional<double> latency_s, UtcTime at);
    // For volumes of chunks: counts a chunk that came and, when the volume stopped waiting, the
    // chunks that did not come.
    void add_data(const std::string& station, UtcTime at);
    void add_missing_chunks(const std::string& station, MissingChunks missing);
    // Takes the newest volume of the catalog from before the start, so that a restart does not
    // forget a station that fell silent. A station that has been silent for longer than a week is
    // forgotten.
    void add_known(const std::string& station, UtcTime newest_volume, UtcTime now);

    [[nodiscard]] const std::map<std::string, StationState>& stations() const { return stations_; }
    [[nodiscard]] std::uint64_t left_out() const { return left_out_; }  // files and chunks

  private:
    StationState* find(const std::string& station);

    std::map<std::string, StationState> stations_;
    std::uint64_t left_out_ = 0;
};

// Seconds from the volume's newest radial to `at`; none if no radial has a time.
[[nodiscard]] std::optional<double> antenna_latency_of(const pipeline::IngestOutcome& outcome,
                                                       UtcTime at);
// Returns true if data with this latency can have come live.
[[nodiscard]] bool is_live(double antenna_latency_s);

}  // namespace stormcellar::daemon
