// cache/roller.h -- keeps a cache within its budgets while it is written. Used only inside the
// cache room; stormcellar/cache/store.h is the public header.
//
// It holds the account of the grids in the cache. The account is made from the names at the start.
// Each roll() corrects it and notices files that others removed, added or pinned. A commit reserves
// the largest size that its file may take before it writes the first byte. If that does not fit, it
// evicts first. The removed names are synced before their room is used again. Files are removed one
// by one, each in one step, so a crash leaves a grid whole or not at all.
//
// Threads   Any thread. No lock is held while files are removed or written, and a thread that waits
//           for another's commit or eviction holds nothing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cache/account.h"
#include "cache/directories.h"
#include "cache/file_io.h"
#include "cache/pins.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/budget.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::cache {

class Roller;

// Room for one file that is being written. The destructor enters into the account the grid that
// then exists at the path: the new one, the old one or none.
class Reservation {
  public:
    Reservation(Roller& roller, GridName name, std::uint64_t bytes)
        : roller_(&roller), name_(std::move(name)), bytes_(bytes) {}
    Reservation(Reservation&& other) noexcept
        : roller_(std::exchange(other.roller_, nullptr)),
          name_(std::move(other.name_)),
          bytes_(other.bytes_) {}
    Reservation& operator=(Reservation&&) = delete;
    Reservation(const Reservation&) = delete;
    Reservation& operator=(const Reservation&) = delete;
    ~Reservation();

  private:
    Roller* roller_;
    GridName name_;
    std::uint64_t bytes_;
};

class Roller {
  public:
    // Removes the leftovers of a killed writer and brings the cache within its budgets. Errors:
    // busy if another process has opened it for rolling.
    static Result<std::unique_ptr<Roller>> open(FileSystem& file_system,
                                                std::filesystem::path directory, Budgets budgets,
                                                Surroundings surroundings);

    // Reserves room for a grid. Returns none if the budgets would not keep it, so that it need not
    // be written. Commits of the same name wait for each other. Errors: over_budget if the grid is
    // pinned or the newest of a known domain, and evicting all grids that may be evicted is not
    // enough.
    Result<std::optional<Reservation>> reserve(const GridName& name, std::uint64_t bytes);
    // Evicts the oldest grids that hold this many bytes, because a full disk refused this grid.
    // Returns false if the budgets do not provide for that or nothing may be evicted.
    bool make_room(const GridName& name, std::uint64_t bytes);
    // Returns true if the grid is left out because the disk is full. This is the case for a grid of
    // others, for which nobody should wait. It counts as not kept.
    bool leaves_out(const GridName& name);
    // Counts a temporary file that could not be removed; a later roll removes it.
    void add_leftover(std::string_view group, const std::filesystem::path& path);

    using OnStep = std::function<void()>;
    RollReport roll(const OnStep& step = {});  // store.h
    void set_budgets(Budgets budgets);
    [[nodiscard]] StoreUsage usage() const;
    // Answers by the account and the time of the last reservation, settlement or roll.
    [[nodiscard]] bool would_keep(const GridName& name) const;
    [[nodiscard]] std::uint64_t block_bytes() const { return block_bytes_; }

  private:
    friend class Reservation;
    struct DayState {
        std::int64_t modified_ns = -1;  // of the directory when it was read; -1: read it again
        std::uint64_t foreign_bytes = 0;
    };
    struct Leftover {
        std::filesystem::path path;
        std::string group;
        std::uint64_t bytes = 0;
    };

    Roller(FileSystem& file_system, std::filesystem::path directory, Budgets budgets,
           Surroundings surroundings, Descriptor lock);
    void settle(const GridName& name, std::uint64_t reserved);
    // Removes the files and syncs their directories; call it without the lock.
    [[nodiscard]] std::vector<Result<Evicted>> remove_files(const std::vector<GridName>& victims,
                                                            std::vector<std::string>& problems)
        STORMCELLAR_EXCLUDES(mutex_);
    // Gives up the lock while it removes files.
    void evict(const std::vector<GridName>& victims) STORMCELLAR_REQUIRES(mutex_);
    void evict_all(const std::function<std::vector<GridName>()>& choose)
        STORMCELLAR_REQUIRES(mutex_);
    void keep_budget(const std::string& group, const std::optional<Filling>& filling,
                     RollReport& report, const OnStep& step) STORMCELLAR_REQUIRES(mutex_);
    void limit_others(const OnStep& step) STORMCELLAR_REQUIRES(mutex_);
    void note_reached(const std::string& group, std::uint64_t bytes) STORMCELLAR_REQUIRES(mutex_);
    Status reread(bool all, const OnStep& step);
    Status reread_day(const Day& day, bool even_unchanged);
    void adopt(const Day& day, const DayContents& contents) STORMCELLAR_REQUIRES(mutex_);
    void remove_leftovers() STORMCELLAR_REQUIRES(mutex_);
    [[nodiscard]] std::filesystem::path path_of(const GridName& name) const {
        return directory_ / relative_path(name);
    }

    FileSystem& file_system_;
    const std::filesystem::path directory_;
    const Surroundings surroundings_;
    const Descriptor lock_;  // on the directory itself, to exclude a second writer
    std::uint64_t block_bytes_ = 4096;

    Mutex rolling_;  // one roll at a time
    int rolls_ STORMCELLAR_GUARDED_BY(rolling_) = 0;
    mutable Mutex mutex_;
    ConditionVariable changed_;
    Budgets budgets_ STORMCELLAR_GUARDED_BY(mutex_);
    Account account_ STORMCELLAR_GUARDED_BY(mutex_);
    std::set<GridName> in_flight_ STORMCELLAR_GUARDED_BY(mutex_);  // being written or evicted
    // Groups that reached a limit since the last roll; empty name: all.
    std::set<std::string> reached_ STORMCELLAR_GUARDED_BY(mutex_);
    std::map<Day, DayState> days_ STORMCELLAR_GUARDED_BY(mutex_);
    std::vector<Leftover> leftovers_ STORMCELLAR_GUARDED_BY(mutex_);
    std::uint64_t evicted_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    std::uint64_t evicted_bytes_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    std::uint64_t not_kept_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    std::uint64_t reported_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    std::uint64_t reported_bytes_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    std::vector<std::string> problems_ STORMCELLAR_GUARDED_BY(mutex_);  // since the last roll
};

}  // namespace stormcellar::cache
