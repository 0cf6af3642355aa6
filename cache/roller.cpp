#include "cache/roller.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/statvfs.h>

#include "base/byte_size.h"

namespace stormcellar::cache {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_problems = 16;

// Locks the cache directory itself, so that no lock file is needed in the cache.
Result<Descriptor> lock_against_writers(const fs::path& directory) {
    Descriptor lock(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (lock.number() < 0) return directory_failure(directory, {errno, std::system_category()});
    if (::flock(lock.number(), LOCK_EX | LOCK_NB) != 0) {
        if (errno == EWOULDBLOCK) {
            return fail(ErrorCode::busy, "{}: another process writes to this cache",
                        directory.native());
        }
        return directory_failure(directory, {errno, std::system_category()});
    }
    return lock;
}

std::uint64_t block_bytes_of(const fs::path& directory) {
    struct statvfs facts {};
    if (::statvfs(directory.c_str(), &facts) != 0) return 4096;
    return std::max<std::uint64_t>({facts.f_bsize, facts.f_frsize, 4096});
}

}  // namespace

Result<Filling> filling_of(const fs::path& directory) {
    struct statvfs facts {};
    if (::statvfs(directory.c_str(), &facts) != 0) {
        return directory_failure(directory, {errno, std::system_category()});
    }
    const std::uint64_t unit = facts.f_frsize;
    const std::uint64_t used = (facts.f_blocks - facts.f_bfree) * unit;
    return Filling{used, used + facts.f_bavail * unit};
}

Reservation::~Reservation() {
    if (roller_ != nullptr) roller_->settle(name_, bytes_);
}

Roller::Roller(FileSystem& file_system, fs::path directory, Budgets budgets,
               Surroundings surroundings, Descriptor lock)
    : file_system_(file_system),
      directory_(std::move(directory)),
      surroundings_(std::move(surroundings)),
      lock_(std::move(lock)),
      block_bytes_(block_bytes_of(directory_)),
      budgets_(std::move(budgets)),
      account_(surroundings_.is_known) {}

Result<std::unique_ptr<Roller>> Roller::open(FileSystem& file_system, fs::path directory,
                                             Budgets budgets, Surroundings surroundings) {
    auto lock = lock_against_writers(directory);
    if (!lock) return pass_on(lock);
    if (Status swept = sweep_temporaries(file_system, directory); !swept) return pass_on(swept);
    std::unique_ptr<Roller> roller(new Roller(file_system, std::move(directory), std::move(budgets),
                                              std::move(surroundings), std::move(*lock)));
    if (Status read = roller->reread(true, {}); !read) return pass_on(read);
    RollReport report = roller->roll();
    const MutexLock guard(roller->mutex_);
    roller->reported_ = 0;
    roller->reported_bytes_ = 0;
    roller->problems_ = std::move(report.problems);
    return roller;
}

// Grids whose group is unknown do not count for the total limit here. Otherwise they could cause
// grids of known groups to be evicted down to the low mark.
void Roller::note_reached(const std::string& group, std::uint64_t bytes) {
    const auto is_full = [&](std::uint64_t used, const Budget& budget) {
        return budget.bytes && used + bytes > *budget.bytes;
    };
    if (is_full(account_.used(group), budgets_.of(group))) reached_.insert(group);
    const std::uint64_t used_by_known = account_.used() - account_.used_by_others();
    if (account_.is_known(group) && is_full(used_by_known, budgets_.total)) reached_.insert("");
}

Result<std::optional<Reservation>> Roller::reserve(const GridName& name, std::uint64_t bytes) {
    const std::string group(group_of(name.domain));
    const MutexLock lock(mutex_);
    account_.ask_who_is_known(group);
    for (;;) {
        while (in_flight_.contains(name))
            changed_.wait(mutex_);
        account_.set_now(surroundings_.now());
        if (account_.is_expired(name, budgets_)) break;
        if (account_.fits(group, bytes, budgets_)) {
            account_.reserve(group, bytes);
            account_.set_busy(name);
            in_flight_.insert(name);
            return std::optional<Reservation>(std::in_place, *this, name, bytes);
        }
        note_reached(group, bytes);
        auto victims = account_.room_for(name, bytes, budgets_);
        if (!victims && in_flight_.empty() && account_.is_to_stay(name)) {
            victims = account_.room_for(name, bytes, budgets_, Reach::all);
        }
        if (victims && !victims->empty()) {
            evict(*victims);
        } else if (!in_flight_.empty()) {
            changed_.wait(mutex_);  // writes and evictions of other threads may still make room
        } else if (account_.is_to_stay(name)) {
            return fail(
                ErrorCode::over_budget,
                "{}: the cache's limits leave no room for {}: a limit is smaller than that, or the "
                "grids in the cache ({}; {} of {}) are pinned or cannot be removed",
                path_of(name).native(), format_byte_size(bytes), format_byte_size(account_.used()),
                format_byte_size(account_.used(group)), group);
        } else {
            break;
        }
    }
    ++not_kept_;
    return std::optional<Reservation>{};
}

void Roller::settle(const GridName& name, std::uint64_t reserved) {
    const MutexLock lock(mutex_);
    const fs::path path = path_of(name);
    account_.set_now(surroundings_.now());
    if (const auto found = look_at_grid(path, name.time)) {
        account_.put(name, {found->bytes_on_disk, found->written, found->pinned});
    } else {
        account_.erase(name);
    }
    account_.release(group_of(name.domain), reserved);
    in_flight_.erase(name);
    changed_.notify_all();
}

std::vector<Result<Evicted>> Roller::remove_files(const std::vector<GridName>& victims,
                                                  std::vector<std::string>& problems) {
    std::vector<Result<Evicted>> outcomes;
    std::set<fs::path> days;
    for (const GridName& name : victims) {
        const fs::path path = path_of(name);
        outcomes.push_back(evict_grid(file_system_, path));
        if (outcomes.back() && *outcomes.back() == Evicted::gone) days.insert(path.parent_path());
    }
    for (const fs::path& day : days) {
        const Status synced = file_system_.sync_directory(day);
        if (!synced && synced.error().code != ErrorCode::not_found) {
            problems.push_back(synced.error().message);
        }
        remove_empty_directories(day);
    }
    return outcomes;
}

// The victims count until their removal is synced. Before that, a power cut may bring them back.
void Roller::evict(const std::vector<GridName>& victims) {
    for (const GridName& name : victims) {
        account_.set_leaving(name);
        in_flight_.insert(name);
    }
    std::vector<Result<Evicted>> outcomes;
    std::vector<std::string> problems;
    {
        const MutexUnlock unlocked(mutex_);
        outcomes = remove_files(victims, problems);
    }
    for (std::size_t i = 0; i < victims.size(); ++i) {
        const Result<Evicted>& outcome = outcomes[i];
        in_flight_.erase(victims[i]);
        if (!outcome) {
            problems.push_back("cannot evict: " + outcome.error().message);
            account_.set_stuck(victims[i]);
        } else if (*outcome == Evicted::pinned) {
            account_.set_pinned(victims[i]);
        } else {
            if (*outcome == Evicted::gone) {
                ++evicted_;
                evicted_bytes_ += account_.find(victims[i])->bytes;
            }
            account_.erase(victims[i]);
        }
    }
    for (std::string& problem : problems) {
        if (problems_.size() < most_problems) problems_.push_back(std::move(problem));
    }
    changed_.notify_all();
}

// The loop ends because evict() takes the victims out of the orders of eviction, even if their
// files cannot be removed.
void Roller::evict_all(const std::function<std::vector<GridName>()>& choose) {
    for (auto victims = choose(); !victims.empty(); victims = choose())
        evict(victims);
}

bool Roller::make_room(const GridName& name, std::uint64_t bytes) {
    const MutexLock lock(mutex_);
    if (!budgets_.makes_room(group_of(name.domain))) return false;
    account_.set_now(surroundings_.now());
    const std::uint64_t before = evicted_;
    evict(account_.oldest(name, bytes, budgets_));
    return evicted_ > before;
}

bool Roller::leaves_out(const GridName& name) {
    const MutexLock lock(mutex_);
    if (account_.is_known(group_of(name.domain))) return false;
    ++not_kept_;
    return true;
}

bool Roller::would_keep(const GridName& name) const {
    const std::string_view group = group_of(name.domain);
    const MutexLock lock(mutex_);
    // The station became known after the account had asked. The commit will make the account ask
    // again.
    if (!account_.is_known(group) && surroundings_.is_known(group)) return true;
    if (account_.is_expired(name, budgets_)) return false;
    if (account_.is_to_stay(name)) return true;
    const std::uint64_t mean = account_.used() / std::max<std::size_t>(1, account_.grid_count());
    return account_.room_for(name, mean, budgets_).has_value();
}

void Roller::set_budgets(Budgets budgets) {
    const MutexLock lock(mutex_);
    budgets_ = std::move(budgets);
}

StoreUsage Roller::usage() const {
    const MutexLock lock(mutex_);
    StoreUsage usage;
    usage.grids = account_.grid_count();
    usage.pinned = account_.pinned_count();
    usage.bytes = account_.used();
    usage.budget_bytes = budgets_.total.bytes;
    usage.evicted = evicted_;
    usage.evicted_bytes = evicted_bytes_;
    usage.not_kept = not_kept_;
    return usage;
}

}  // namespace stormcellar::cache
