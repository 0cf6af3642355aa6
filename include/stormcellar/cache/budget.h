// stormcellar/cache/budget.h -- how much the cache may hold.
//
// A budget is of one group (a domain and its parts, stormcellar/cache/grid_name.h) or of all that
// the cache holds. Each of its limits that is set counts; the oldest grids go first.
//   bytes    on disk, of grids, of files being written and of what a killed writer left; counted
//            in the blocks that the file system allocates. Never exceeded: bytes are reserved
//            before they are written. Directories are not counted (4 KiB for each day and domain).
//   percent  the file system may be filled so far, by all who fill it, as df counts. What is over
//            is taken from the cache within 10 s, as far as the cache has it.
//   age      before the newest grid of the same group, not before now, so that old data stay when
//            they are replayed. Times more than 10 minutes in the future do not count as newest.
// What was over is brought down to low_watermark times the limit.
//
// Known is every group that the store's opener calls known (Surroundings::is_known in store.h; by
// default is_known_group() below). Every other group is an invented station until somebody says
// otherwise, and its grids are the others' grids.
//   others     go before any known grid, whoever needs room, and make room only for one another.
//              Together they hold at most a tenth of the space of the total budget; what is beyond
//              that is not kept. They go at a roll when they were written longer ago than
//              protected_for, whatever the budgets.
//   protected  is the newest grid of each domain (or part) and moment of a known group, as long as
//              it was written less than protected_for ago; by when the file was written, so that
//              old data that are replayed are protected too. A part is not protected from the age.
//              All that are protected from one limit hold at most half of its space; the protection
//              of the largest of them lapses, and among equals that of the oldest. It also lapses
//              where the newest grid of a known group would otherwise find no room.
//   pinned     grids never go.
// The space of a budget is its bytes, or what its percent is of the file system, or the smaller of
// the two. Where a budget has neither, no protection lapses and the others' share has no limit.
// Thread contract: plain data, and pure functions.
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
    Budget total;         // its age holds for every group, from that group's own newest grid
    Budget every_domain;  // of each group that is not named
    std::map<std::string, Budget, std::less<>> domains;  // by group
    double low_watermark = 0.9;                          // above 0, up to 1; a share of each limit
    // 0: without limit, so that the newest of the known stay protected and the others' grids go by
    // the budgets alone.
    std::chrono::milliseconds protected_for = std::chrono::hours{168};

    [[nodiscard]] const Budget& of(std::string_view group) const;
    // The shorter of the group's and of all.
    [[nodiscard]] std::optional<std::chrono::milliseconds> age_of(std::string_view group) const;
    // Whether a full disk may be met by evicting: some budget of bytes or percent is set for it. A
    // budget of age alone says how long grids stay, not that they may go sooner.
    [[nodiscard]] bool makes_room(std::string_view group) const;
    [[nodiscard]] std::uint64_t low_mark(std::uint64_t limit) const;
    bool operator==(const Budgets&) const = default;
};

// Every name that has not the form of an ICAO: only a configuration gives such names to domains. Of
// those that have it the ones that find_station() knows.
[[nodiscard]] bool is_known_group(std::string_view group);

}  // namespace stormcellar::cache
