// daemon/status/station_book.h -- what came of each station: when, how fast, and what was wrong.
//
// Times are those of two clocks. The radar's: the volume's start and its newest radial; more than
// 10 minutes ahead of ours they do not count. Ours: when data were last looked at, when a volume
// was last put into the cache.
// antenna_to_cache: from the newest radial of a volume to its grids in the cache. Only what can
// have come live (at most an hour old, not more than 10 minutes ahead) enters the timings; the
// others, as when old data are replayed, are counted, and the last one is kept as it was.
// Memory is bounded however many stations files claim to be of: beyond `most_stations` a station
// that is not known yet is left out, and its files are counted.
// Thread contract: plain data; one thread changes it.
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

// Chunks of one volume that never came.
struct MissingChunks {
    std::optional<UtcTime> volume_time;
    std::optional<int> volume_number;  // 0 to 999
    std::vector<int> numbers;          // the first 64 of them, counted from 1
    std::size_t count = 0;             // all of them
};

struct StationState {
    std::optional<UtcTime> volume_time;    // start of the newest volume that was gridded
    std::optional<UtcTime> newest_radial;  // of the newest volume that was gridded
    std::optional<UtcTime> ingested_at;    // when a volume was last gridded
    std::optional<UtcTime> data_at;        // when a file or a piece of one was last looked at
    PerResult<std::uint64_t> results{};    // files
    std::uint64_t partial = 0;             // of those gridded: not whole
    Timings close_to_cache{128};
    std::uint64_t living = 0;      // grids of volumes that had not ended, each time
    Timings close_to_living{128};  // from the close with which a sweep was complete to its grid
    Timings antenna_to_cache{128};
    std::optional<double> last_antenna_s;  // whatever it is
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

    // `latency_s`: from the close that was seen to the end; `at`: our clock, when the job ended.
    void add(const pipeline::IngestOutcome& outcome, std::optional<double> latency_s, UtcTime at);
    // For chunks that are put together: one that came, and, when its volume was given up waiting
    // for, those that did not.
    void add_data(const std::string& station, UtcTime at);
    void add_missing_chunks(const std::string& station, MissingChunks missing);
    // What was known before the start: the newest volume of the catalog. So a station that fell
    // silent is not forgotten by a restart; one that has been silent for longer than a week is.
    void add_known(const std::string& station, UtcTime newest_volume, UtcTime now);

    [[nodiscard]] const std::map<std::string, StationState>& stations() const { return stations_; }
    [[nodiscard]] std::uint64_t left_out() const { return left_out_; }  // files and chunks

  private:
    StationState* find(const std::string& station);

    std::map<std::string, StationState> stations_;
    std::uint64_t left_out_ = 0;
};

// Seconds from the volume's newest radial to `at`; none where no radial has a time.
[[nodiscard]] std::optional<double> antenna_latency_of(const pipeline::IngestOutcome& outcome,
                                                       UtcTime at);
// Whether such a latency can be that of data that came live.
[[nodiscard]] bool is_live(double antenna_latency_s);

}  // namespace stormcellar::daemon
