// daemon/status/station_book.h -- records for each station when data arrived, how fast, and what
// was wrong.
//
// Times come from two clocks. The radar's clock gives the start and the newest radial of a volume;
// a time more than 10 minutes ahead of this machine's clock does not count. This machine's clock
// says when data were last seen, and when a volume was last put into the cache.
//
// antenna_to_cache is the time from the newest radial of a volume until its grids are in the cache.
// Only values that may be of live data (at most an hour old, and at most 10 minutes in the future)
// enter the timings. Other values, for example of old data that are replayed, are only counted.
// last_antenna_s is the last value, live or not.
//
// Memory is bounded, however many stations the files claim. Beyond `most_stations`, a new station
// is left out, and only the number of its files is kept.
//
// Threads   Plain data; one thread changes it.
#pragma once

#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemon/queue/worker_pool.h"
#include "daemon/status/status_names.h"
#include "service/timings.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::daemon {

// Chunks of one volume that never arrived.
struct MissingChunks {
    std::optional<UtcTime> volume_time;
    std::optional<int> volume_number;  // 0 to 999
    std::vector<int> numbers;          // the first 64 missing chunks, counted from 1
    std::size_t count = 0;             // of all missing chunks
};

struct StationState {
    std::optional<UtcTime> volume_time;    // start of the newest gridded volume
    std::optional<UtcTime> newest_radial;  // of the newest gridded volume
    std::optional<UtcTime> ingested_at;    // when a volume was last gridded
    std::optional<UtcTime> data_at;        // when a file or a part of a file was last seen
    PerResult<std::uint64_t> results{};    // numbers of files
    std::uint64_t partial = 0;             // gridded files whose volume was not complete
    Timings close_to_cache{128};
    // Number of grids of volumes that had not ended; each update counts.
    std::uint64_t living = 0;
    // From the close of the file that completed a sweep to the grid of the sweep.
    Timings close_to_living{128};
    Timings antenna_to_cache{128};
    std::optional<double> last_antenna_s;  // the last value, even if it is not live
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

    // Adds the outcome of a job. Does nothing if the outcome has no station. `latency_s` is the
    // time in seconds from the close of the file to the end of its job. `at` is the end of the job
    // by this machine's clock.
    void add(const pipeline::IngestOutcome& outcome, std::optional<double> latency_s, UtcTime at);
    // add_data() notes that data arrived. add_missing_chunks() notes the chunks of a volume that
    // never came; the service calls it when it has given up waiting for them.
    void add_data(const std::string& station, UtcTime at);
    void add_missing_chunks(const std::string& station, MissingChunks missing);
    // Adds a station with its newest volume in the catalog, so that a restart does not forget a
    // silent station. Does nothing if the volume is older than a week.
    void add_known(const std::string& station, UtcTime newest_volume, UtcTime now);

    [[nodiscard]] const std::map<std::string, StationState>& stations() const { return stations_; }
    // Number of files and chunks.
    [[nodiscard]] std::uint64_t left_out() const { return left_out_; }

  private:
    StationState* find(const std::string& station);

    std::map<std::string, StationState> stations_;
    std::uint64_t left_out_ = 0;
};

// Returns the seconds from the newest radial of the volume to `at`; none if no radial has a time.
[[nodiscard]] std::optional<double> antenna_latency_of(const pipeline::IngestOutcome& outcome,
                                                       UtcTime at);
// Returns true if data with this latency may be live.
[[nodiscard]] bool is_live(double antenna_latency_s);

}  // namespace stormcellar::daemon
