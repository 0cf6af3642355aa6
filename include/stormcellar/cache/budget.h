// stormcellar/cache/budget.h -- how much the cache may hold.
//
// A budget applies to one group (a domain and its parts, stormcellar/cache/grid_name.h) or to the
// whole cache. Every limit that is set applies. The oldest grids are evicted first.
//   bytes    The bytes on disk of grids, of files being written and of the leftovers of killed
//            writers, counted in the blocks that the file system allocates. A commit never exceeds
//            this limit, because it reserves the bytes before it writes them. Directories are not
//            counted (4 KiB for each day and domain).
//   percent  How full the file system may be with the data of all its users, as df counts. If it
//            is fuller, each roll evicts grids of this cache, as far as the rules below allow.
//   age      A grid's age counts from the newest grid of the same group, not from now, so that old
//            data stay while they are replayed. Times more than 10 minutes in the future do not
//            count as newest.
// If the cache exceeds a limit, it is brought down to low_watermark times the limit.
//
// A group is known if the opener of the store says so (Surroundings::is_known in store.h; by
// default is_known_group() below). Every other group counts as an invented station until it becomes
// known. Its grids are called grids of others below.
//   others     Grids of others are evicted before any grid of a known group, and no grid of a known
//              group is evicted for them. Together they hold at most a tenth of the space of the
//              total budget; grids beyond that are not kept. A roll also evicts grids of others
//              that were written longer ago than protected_for.
//   protected  The newest grid of each domain (or part) and moment of a known group is protected
//              until protected_for after it was written. Because the time of writing counts,
//              replayed old data are protected too. A part is not protected from the limit of age.
//              All grids that are protected from one limit may hold at most half of its space. If
//              they would hold more, the largest of them lose this protection first; among equally
//              large grids, the oldest. Protected grids are also evicted if the newest grid of a
//              known group would otherwise find no room.
//   pinned     Pinned grids are never evicted.
// The space of a budget is its bytes, or its percent of the file system, or the smaller of the two.
// If neither bytes nor percent is set, protected grids and grids of others may hold any space.
//
// Units     Bytes, percent, milliseconds.
// Threads   Plain data and pure functions.
// Errors    None.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace stormcellar::cache {

struct Budget {
    std::optional<std::uint64_t> bytes;
    std::optional<double> file_system_percent;     // above 0, up to 100
    std::optional<std::chrono::milliseconds> age;  // above 0
    [[nodiscard]] bool limits_space() const { return bytes || file_system_percent; }
    bool operator==(const Budget&) const = default;
};

struct Budgets {
    Budget total;  // its age applies to every group, counted from that group's own newest grid
    Budget every_domain;                                 // for each group that is not in `domains`
    std::map<std::string, Budget, std::less<>> domains;  // by group
    double low_watermark = 0.9;                          // above 0, up to 1; a share of each limit
    // 0: no time limit, so the newest known grids stay protected, and only the budgets limit the
    // grids of others.
    std::chrono::milliseconds protected_for = std::chrono::hours{168};

    [[nodiscard]] const Budget& of(std::string_view group) const;
    // Returns the shorter of the group's age and the total budget's age; none if neither is set.
    [[nodiscard]] std::optional<std::chrono::milliseconds> age_of(std::string_view group) const;
    // Returns true if grids may be evicted when the disk is full: if the group's budget or the
    // total budget limits bytes or percent. A budget of age alone does not allow evicting grids
    // sooner.
    [[nodiscard]] bool makes_room(std::string_view group) const;
    // Returns the size in bytes to which evicting brings a cache that has exceeded `limit`.
    [[nodiscard]] std::uint64_t low_mark(std::uint64_t limit) const;
    bool operator==(const Budgets&) const = default;
};

// Returns true for a name without the form of an ICAO, because only a configuration gives such
// names to domains. A name with that form is known if find_station() knows it.
[[nodiscard]] bool is_known_group(std::string_view group);

}  // namespace stormcellar::cache
