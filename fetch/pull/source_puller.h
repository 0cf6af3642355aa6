// fetch/pull/source_puller.h -- pulls partials from one machine, turn by turn. A partial is the
// grid of one site on the cells of a mosaic.
//
// A turn requests the list of grids, and fetches missing grids, newest first. It also requests the
// newest grids again, in case they were made again. The turn fails if the machine does not answer.
// After a failed turn, the pause is one second; it doubles with each further failure, up to a
// minute. If the machine requests a longer pause, that pause applies, up to a minute. A grid that
// is cut off or fails a check is refused. It is requested again after a pause of its own, so that
// it does not delay other grids. A turn makes at most 1,000 requests for grids. It fails after 16
// refusals in a row, so that a machine that sends only junk is paused like a machine that is down.
// When the machine no longer lists a grid, the puller forgets the refusals of that grid.
//
// Threads   One thread calls turn(); any thread may call status().
// Errors    turn() returns the reason why it ended early. The next turn may succeed.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <optional>
#include <string>

#include "base/rate_limit.h"
#include "base/steady_time.h"
#include "fetch/pull/http_client.h"
#include "fetch/pull/pull_config.h"
#include "fetch/pull/pull_status.h"
#include "fetch/pull/pulled_grids.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::pull {

// Returns the pause after this many failures in a row: 1 s after the first, twice as long after
// each further failure, but at most a minute.
[[nodiscard]] std::chrono::milliseconds pause_after(int failures);

class SourcePuller {
  public:
    // `grids` is the directory of this source. A turn ends soon after `stop` is set.
    SourcePuller(PullSource source, const PullConfig& config, PulledGrids grids,
                 const std::atomic<bool>& stop);

    Status turn();
    // Returns the time to wait before the next turn.
    [[nodiscard]] std::chrono::milliseconds pause() const;
    [[nodiscard]] SourceStatus status() const;
    [[nodiscard]] const PullSource& source() const { return source_; }
    // Returns the larger of the sizes of asked_ and bad_; for tests.
    [[nodiscard]] std::size_t remembered() const { return std::max(asked_.size(), bad_.size()); }
    // Returns when a turn, or a transfer in it, last made progress.
    [[nodiscard]] SteadyTime last_beat() const { return beat_.load(); }
    void beat() { beat_ = steady_now(); }

  private:
    Status pull();
    Status try_to_pull();
    Result<bool> list(UtcTime from, UtcTime now);
    Status fetch_missing();
    Status ask_again(UtcTime now);
    Status fetch(const cache::GridName& name);
    Status get(const cache::GridName& name);
    void forget_unlisted(UtcTime from, UtcTime now);
    void complain(const Error& why);
    [[nodiscard]] bool may_fetch() const;
    bool make_room_for(const cache::GridName& name);
    void note_outcome(const Status& done);

    struct Bad {
        int tries = 0;
        SteadyTime next{};
    };
    // The grid that was last removed as soon as it was fetched, because all other grids are newer.
    struct NoRoom {
        UtcTime time;
        std::uint64_t bytes = 0;
    };
    [[nodiscard]] bool has_room_for(const cache::GridName& name) const;
    const PullSource source_;
    const PullConfig config_;
    PulledGrids grids_;
    const std::atomic<bool>& stop_;
    std::atomic<SteadyTime> beat_{steady_now()};
    HttpClient client_;
    std::string list_url_, list_tag_;
    std::vector<cache::GridName> listed_;  // newest first
    SteadyTime next_long_list_{};
    std::map<cache::GridName, SteadyTime> asked_;  // when each young grid was last requested
    std::map<cache::GridName, Bad> bad_;
    std::optional<NoRoom> no_room_;
    int failures_ = 0;          // failed turns in a row
    int fetched_ = 0;           // number of requests in this turn
    int refused_in_a_row_ = 0;  // in this turn
    RateLimit lines_{20, std::chrono::seconds{60}};

    mutable Mutex mutex_;
    SourceStatus status_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::pull
