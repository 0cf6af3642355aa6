// fetch/pull/source_puller.h -- pulls the partials of one machine, turn by turn.
//
// A turn asks for the list of grids, fetches missing grids, newest first, and asks whether the
// newest grids were made again. A machine that does not answer ends the turn. The next turn begins
// after a pause that doubles from one second to a minute, or that the machine asks for. A grid that
// is cut off or fails a check is asked for again after its own pause, so that it delays no others.
// A turn fetches at most 1,000 grids and fails after 16 refusals in a row, so a machine that sends
// only junk is paused like one that is down. The puller forgets a grid when the machine no longer
// lists it.
//
// Threads   turn() by one thread; status() by any.
// Errors    turn() says why it ended early; the next turn may succeed.
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

// Returns the pause after this many failures, which doubles from the shortest to the longest.
[[nodiscard]] std::chrono::milliseconds pause_after(int failures);

class SourcePuller {
  public:
    // `grids` is the directory of this source. The flag ends a turn.
    SourcePuller(PullSource source, const PullConfig& config, PulledGrids grids,
                 const std::atomic<bool>& stop);

    Status turn();
    // Returns the time to wait before the next turn.
    [[nodiscard]] std::chrono::milliseconds pause() const;
    [[nodiscard]] SourceStatus status() const;
    [[nodiscard]] const PullSource& source() const { return source_; }
    // Returns the size of the larger of its two memories: grids asked for lately, and bad ones.
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
    // The last grid that was removed as soon as it came, because all others are newer.
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
    std::map<cache::GridName, SteadyTime> asked_;  // when each young grid was last asked for
    std::map<cache::GridName, Bad> bad_;
    std::optional<NoRoom> no_room_;
    int failures_ = 0;          // consecutive turns
    int fetched_ = 0;           // requests in this turn
    int refused_in_a_row_ = 0;  // in this turn
    RateLimit lines_{20, std::chrono::seconds{60}};

    mutable Mutex mutex_;
    SourceStatus status_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::pull
