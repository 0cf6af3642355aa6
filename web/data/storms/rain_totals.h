// web/data/storms/rain_totals.h -- makes rain totals of the last hours of a domain, as `stormcellar
// frame --product rain-total` does (render/products/rain_of_domain.h), and keeps them as open
// grids.
//
// A total is named by a grid of reflectivity, or of rain rates if the domain has none of
// reflectivity. It ends at the middle of the time of that grid, and takes no later grid. If a grid
// of its time comes, changes or goes, the total is made again.
//
// A million columns full of echo take 2.7 s, so an hour of a radar takes 7 s and a day 160 s. One
// thread makes all totals, one after another. One request at a time waits for its total, for at
// most `patience`; others are told to come back. Totals of too many columns or grids are refused.
//
// Units     Hours are whole, from 1 to 24.
// Threads   Many threads may use it.
// Errors    See each function.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>

#include "base/recently_used.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"
#include "web/data/grids/grids.h"
#include "web/http/work_queue.h"

namespace stormcellar::web {

struct RainTotalsOptions {
    std::shared_ptr<Grids> grids = {};
    std::uint64_t budget_bytes = 32'000'000;  // of the totals that are kept
    std::chrono::milliseconds patience{3000};
    std::size_t most_in_line = 16;
    // The most grids of one total, and the most columns of all its grids.
    std::size_t most_grids = 800;
    double most_columns = 1e8;
    int threads = 1;  // for one total
};

class RainTotals {
  public:
    using Total = std::shared_ptr<const OpenGrid>;
    static constexpr int most_hours = 24;

    explicit RainTotals(RainTotalsOptions options);
    RainTotals(const RainTotals&) = delete;
    RainTotals& operator=(const RainTotals&) = delete;
    ~RainTotals();

    // Returns the moment whose grids name the domain's totals.
    [[nodiscard]] static level2::Moment listed_moment(const Grids& grids, std::string_view domain);

    // Returns the total, whose `time` is that of the grid that names it. Errors: not_found if there
    // is no such grid; busy if the total is not ready yet; bad_argument if it is too large, or if
    // there is only one grid in its time; those of the cache.
    [[nodiscard]] Result<Total> find(const std::string& domain, int hours, UtcTime time);
    // Returns the total if it is kept and nothing has changed in the domain since it was last
    // looked for; else null. Takes microseconds.
    [[nodiscard]] Total find_if_kept(const std::string& domain, int hours, UtcTime time);
    // Returns the number of totals that were made.
    [[nodiscard]] std::uint64_t made() const { return made_; }

  private:
    using Name = std::tuple<std::string, int, UtcTime>;  // domain, hours, time
    struct Kept {
        std::string inputs;         // names and stamps of the grids
        std::uint64_t changes = 0;  // in the domain when the inputs were last compared
        Result<Total> total;        // an error of the input, which a second try would repeat
    };
    struct Wish;
    [[nodiscard]] Result<Wish> wish_of(const Name& name) const;
    [[nodiscard]] Result<Total> make(const Wish& wish) const;
    [[nodiscard]] Kept made_now(const Name& name) const;
    [[nodiscard]] Result<Total> wait_for(const Name& name, const std::string& inputs)
        STORMCELLAR_REQUIRES(mutex_);

    const RainTotalsOptions options_;
    std::atomic<std::uint64_t> made_{0};
    std::atomic<bool> is_stopping_{false};
    Mutex mutex_;
    ConditionVariable ready_;
    RecentlyUsed<Name, Kept> kept_ STORMCELLAR_GUARDED_BY(mutex_);
    std::set<Name> making_ STORMCELLAR_GUARDED_BY(mutex_);  // in line or being made
    bool is_waiting_ STORMCELLAR_GUARDED_BY(mutex_) = false;
    WorkQueue makers_;  // the last member, so that it ends first
};

}  // namespace stormcellar::web
