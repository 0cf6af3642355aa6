// cache/roller.h -- keeps a cache within its limits while it is written to. Inside the cache room
// only; stormcellar/cache/store.h is its public interface.
//
// It holds the account of what the cache holds. The account is made from the file names at the
// start and corrected from them at each roll(), which so notices files that others removed, added
// or pinned. Before it writes the first byte, a commit reserves the most that its file may take. If
// that does not fit, it evicts grids first, and syncs the unlinked names before it uses their room
// again. Files are removed one by one and each removal is whole, so a crash leaves complete grids
// or none. Thread contract: any thread. No lock is held while files are removed or written, and a
// thread that waits for another's commit or eviction holds nothing.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cache/account.h"
#include "cache/directories.h"
#include "cache/file_io.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/budget.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::cache {

class Roller;

// Room for one file that is being written. The destructor updates the account with what is then in
// the grid's place: the new file, the old one, or nothing.
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
    // Removes what a killed writer left, and brings the cache within its limits. Errors: busy if
    // another process has opened it in this way.
    static Result<std::unique_ptr<Roller>> open(FileSystem& file_system,
                                                std::filesystem::path directory, Budgets budgets,
                                                Surroundings surroundings);

    // None: the limits would not keep the grid, so it need not be written. Errors: over_budget if
    // the grid is the newest of a known domain or pinned, and the other grids cannot be evicted or
    // are not enough. Commits of the same name wait for each other.
    Result<std::optional<Reservation>> reserve(const GridName& name, std::uint64_t bytes);
    // Call it when a full disk refused this grid: evicts the oldest grids that hold this many
    // bytes. Returns false if the limits do not provide for that, or no grid may be evicted.
    bool make_room(const GridName& name, std::uint64_t bytes);
    // Returns true if a grid is not stored because the disk is full: it is a grid of others, and
    // nobody waits for room for those. It is counted as not kept.
    bool leaves_out(const GridName& name);
    // A temporary file that could not be removed: it is counted, and removed at a later roll.
    void add_leftover(std::string_view group, const std::filesystem::path& path);

    using OnStep = std::function<void()>;
    RollReport roll(const OnStep& step = {});  // store.h
    void set_budgets(Budgets budgets);
    [[nodiscard]] StoreUsage usage() const;
    [[nodiscard]] bool would_keep(const GridName& name);
    [[nodiscard]] std::uint64_t block_bytes() const { return block_bytes_; }

  private:
    friend class Reservation;
    using Lock = std::unique_lock<std::mutex>;
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
    void evict(Lock& lock, const std::vector<GridName>& victims);
    void evict_all(Lock& lock, const std::function<std::vector<GridName>()>& choose);
    void keep_budget(Lock& lock, const std::string& group, const std::optional<Filling>& filling,
                     RollReport& report, const OnStep& step);
    void limit_others(Lock& lock, const OnStep& step);
    void note_reached(const std::string& group, std::uint64_t bytes);
    Status reread(bool all, const OnStep& step);
    Status reread_day(const Day& day, bool even_unchanged);
    void adopt(const Day& day, const DayContents& contents);
    void remove_leftovers();
    [[nodiscard]] std::filesystem::path path_of(const GridName& name) const {
        return directory_ / relative_path(name);
    }

    FileSystem& file_system_;
    const std::filesystem::path directory_;
    const Surroundings surroundings_;
    const Descriptor lock_;  // on the directory itself, to exclude a second writer
    std::uint64_t block_bytes_ = 4096;

    std::mutex rolling_;        // one roll at a time
    int rolls_ = 0;             // guarded by rolling_
    mutable std::mutex mutex_;  // guards all members below
    std::condition_variable changed_;
    Budgets budgets_;
    Account account_;
    std::set<GridName> in_flight_;  // being written or evicted
    std::set<std::string>
        reached_;  // groups that reached a limit since the last roll; empty name: all
    std::map<Day, DayState> days_;
    std::vector<Leftover> leftovers_;
    std::uint64_t evicted_ = 0, evicted_bytes_ = 0, not_kept_ = 0;
    std::uint64_t reported_ = 0, reported_bytes_ = 0;
    std::vector<std::string> problems_;  // since the last roll
};

}  // namespace stormcellar::cache
