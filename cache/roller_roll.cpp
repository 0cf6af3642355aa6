// Examines the whole cache every few seconds. Finds changes by other programs, grids that are too
// old, and how full the file system is.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <sys/stat.h>

#include "base/byte_size.h"
#include "cache/roller.h"

namespace stormcellar::cache {
namespace {

namespace fs = std::filesystem;

// Number of files that are removed in one batch. The oldest grids are spread over the directories
// of all domains, and a batch syncs each of these directories once. So small batches would need a
// sync for nearly every file.
constexpr std::size_t batch = 2048;
// Every directory is read again after this many rolls, even if it seems unchanged.
constexpr int rolls_between_full_readings = 60;
// If a directory changed this recently, its next change may give it the same modification time.
constexpr std::int64_t settling_ns = 2'000'000'000;

std::int64_t nanoseconds_now() {
    return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

struct Span {
    UtcTime from, to;
};
std::optional<Span> span_of(const Day& day) {
    const auto from = parse_compact(day.day + "_000000");
    if (!from) return std::nullopt;  // not a date, so the directory holds no grids
    return Span{*from, *from + std::chrono::days{1} - std::chrono::milliseconds{1}};
}

std::string whose(const std::string& group) {
    return group.empty() ? "the cache" : group;
}

}  // namespace

Status Roller::reread(bool all, const OnStep& step) {
    const auto days = all_days(directory_);
    if (!days) return pass_on(days);
    for (const Day& day : *days) {
        if (Status read = reread_day(day, all); !read) return read;
        if (step) step();
    }
    const MutexLock lock(mutex_);
    for (auto day = days_.begin(); day != days_.end();) {
        const bool stands = std::binary_search(days->begin(), days->end(), day->first);
        if (!stands && !fs::exists(directory_ / relative_path(day->first))) {
            adopt(day->first, {});
            day = days_.erase(day);
        } else {
            ++day;
        }
    }
    return {};
}

// Holds the lock while it reads. So no grid of this process can appear or vanish before adopt()
// enters what was read.
Status Roller::reread_day(const Day& day, bool even_unchanged) {
    const MutexLock lock(mutex_);
    struct stat facts {};
    if (::stat((directory_ / relative_path(day)).c_str(), &facts) != 0) return {};
    const std::int64_t modified_ns =
        std::int64_t{facts.st_mtim.tv_sec} * 1'000'000'000 + facts.st_mtim.tv_nsec;
    DayState& state = days_[day];
    if (!even_unchanged && state.modified_ns == modified_ns) return {};
    const auto contents = read_day(directory_, day);
    if (!contents) return pass_on(contents);
    adopt(day, *contents);
    const bool settled = std::abs(nanoseconds_now() - modified_ns) > settling_ns;
    state.modified_ns = settled ? modified_ns : -1;
    return {};
}

// Enters the grids of a day into the account. Skips grids that are being written or evicted,
// because these operations update the account themselves.
void Roller::adopt(const Day& day, const DayContents& contents) {
    account_.set_now(surroundings_.now());
    if (const auto span = span_of(day)) {
        for (const GridName& name : account_.names(day.domain, day.moment, span->from, span->to)) {
            const auto found = std::lower_bound(
                contents.grids.begin(), contents.grids.end(), name.time,
                [](const FoundGrid& grid, UtcTime time) { return grid.time < time; });
            const bool stands = found != contents.grids.end() && found->time == name.time;
            if (!stands && !in_flight_.contains(name)) account_.erase(name);
        }
    }
    for (const FoundGrid& grid : contents.grids) {
        const GridName name{day.domain, day.moment, grid.time};
        if (in_flight_.contains(name)) continue;
        account_.put(name, {grid.bytes_on_disk, grid.written, grid.pinned});
    }
    // Files that this process is writing are not foreign: they are reserved, or among the
    // leftovers.
    std::uint64_t foreign = 0;
    for (const FoundTemporary& temporary : contents.temporaries) {
        if (!temporary.name.starts_with(own_temporary_prefix())) foreign += temporary.bytes_on_disk;
    }
    std::uint64_t& known = days_[day].foreign_bytes;
    const std::string_view group = group_of(day.domain);
    account_.reserve(group, foreign);
    account_.release(group, std::exchange(known, foreign));
}

void Roller::add_leftover(std::string_view group, const fs::path& path) {
    struct stat facts {};
    if (::lstat(path.c_str(), &facts) != 0) return;
    const MutexLock lock(mutex_);
    const std::uint64_t bytes = static_cast<std::uint64_t>(facts.st_blocks) * 512;
    leftovers_.push_back({path, std::string(group), bytes});
    account_.reserve(group, bytes);
}

void Roller::remove_leftovers() {
    std::erase_if(leftovers_, [&](const Leftover& leftover) STORMCELLAR_REQUIRES(mutex_) {
        const Status removed = file_system_.remove(leftover.path);
        if (!removed && removed.error().code != ErrorCode::not_found) return false;
        account_.release(leftover.group, leftover.bytes);
        return true;
    });
}

// Evicts grids of others (whose group is unknown) that were written long ago. If grids of others
// then still exceed their share of the space, evicts the oldest.
void Roller::limit_others(const OnStep& step) {
    const auto evict_each = [&](auto choose) STORMCELLAR_REQUIRES(mutex_) {
        evict_all([&]() STORMCELLAR_REQUIRES(mutex_) {
            if (step) step();
            return choose();
        });
    };
    evict_each([&]() STORMCELLAR_REQUIRES(mutex_) { return account_.outlived(budgets_, batch); });
    const auto limit = account_.others_limit(budgets_);
    if (!limit || account_.used_by_others() <= *limit) return;
    evict_each([&]() STORMCELLAR_REQUIRES(mutex_) {
        return account_.others_down_to(budgets_.low_mark(*limit), batch);
    });
}

// Enforces the budget of a group, or the total budget if the name is empty. Counts the space of
// grids as free if they were evicted after `filling` was measured.
void Roller::keep_budget(const std::string& group, const std::optional<Filling>& filling,
                         RollReport& report, const OnStep& step) {
    const Budget budget = group.empty() ? budgets_.total : budgets_.of(group);
    const auto held = [&]() STORMCELLAR_REQUIRES(mutex_) {
        return group.empty() ? account_.used() : account_.used(group);
    };
    const bool reached = reached_.erase(group) > 0;
    std::optional<std::uint64_t> target, limit;
    if (budget.bytes) {
        limit = budget.bytes;
        if (reached || held() > *limit) target = budgets_.low_mark(*limit);
    }
    bool disk_too_full = false;
    if (budget.file_system_percent && filling) {
        const auto allowed = static_cast<std::uint64_t>(
            static_cast<double>(filling->capacity_bytes) * *budget.file_system_percent / 100);
        const std::uint64_t over = filling->used_bytes - std::min(filling->used_bytes, allowed);
        const std::uint64_t ours = held() - std::min(held(), over);
        disk_too_full = over > 0 && ours < limit.value_or(ours + 1);
        if (disk_too_full) {
            limit = ours;
            target = std::min(target.value_or(ours), budgets_.low_mark(ours));
        }
    }
    if (target) {
        const Protection protection{budgets_.protected_for, account_.space_of(budget)};
        const auto bring_down = [&](Reach reach) STORMCELLAR_REQUIRES(mutex_) {
            evict_all([&]() STORMCELLAR_REQUIRES(mutex_) {
                if (step) step();
                return account_.down_to(group, *target, batch, protection, reach);
            });
        };
        // If grids of others alone exceed the budget, evict no grid of a known group.
        bring_down(Reach::others);
        if (reached || held() > *limit) bring_down(Reach::unprotected);
    }
    if (!limit || held() <= *limit) return;
    report.problems.push_back(
        disk_too_full
            ? fmt::format("the file system is more than {} % full, and {} has no grid left that "
                          "may be evicted: {} are pinned or the newest of their domains",
                          *budget.file_system_percent, whose(group), format_byte_size(held()))
            : fmt::format("{} holds {}, more than its limit of {}: the rest is pinned, the newest "
                          "of its domain, or cannot be removed",
                          whose(group), format_byte_size(held()), format_byte_size(*limit)));
}

RollReport Roller::roll(const OnStep& step) {
    const MutexLock one_at_a_time(rolling_);
    RollReport report;
    const bool all = ++rolls_ % rolls_between_full_readings == 0;
    if (const Status read = reread(all, step); !read)
        report.problems.push_back(read.error().message);

    const MutexLock lock(mutex_);
    remove_leftovers();
    account_.set_now(surroundings_.now());
    account_.ask_who_is_known();
    const std::vector<std::string> groups = account_.groups();
    for (const std::string& group : groups)
        evict_all([&]() STORMCELLAR_REQUIRES(mutex_) {
            if (step) step();
            return account_.expired(group, budgets_, batch);
        });

    auto filling = surroundings_.filling(directory_);
    if (!filling) report.problems.push_back(filling.error().message);
    if (filling) account_.set_capacity(filling->capacity_bytes);
    std::uint64_t counted = evicted_bytes_;
    limit_others(step);
    const auto filling_now = [&]() STORMCELLAR_REQUIRES(mutex_) -> std::optional<Filling> {
        if (!filling) return std::nullopt;
        const std::uint64_t freed = evicted_bytes_ - std::exchange(counted, evicted_bytes_);
        filling->used_bytes -= std::min(filling->used_bytes, freed);
        return *filling;
    };
    for (const std::string& group : groups)
        keep_budget(group, filling_now(), report, step);
    keep_budget("", filling_now(), report, step);

    report.evicted = evicted_ - std::exchange(reported_, evicted_);
    report.evicted_bytes = evicted_bytes_ - std::exchange(reported_bytes_, evicted_bytes_);
    report.problems.insert(report.problems.end(), problems_.begin(), problems_.end());
    problems_.clear();
    return report;
}

}  // namespace stormcellar::cache
