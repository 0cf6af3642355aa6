// stormcellar/cache/grid_name.h -- the name of a grid in the cache, and the path of its file.
//
// A name is a domain, a moment and a time. Its file is
// DOMAIN/MOMENT/YYYYMMDD/DOMAIN_MOMENT_YYYYMMDD_HHMMSS_mmm.scg below the cache's directory. A
// domain is NAME, or NAME.ICAO for the part of one site in the grid of NAME. A domain and its parts
// form the group NAME, to which a budget applies.
//
// Threads   Pure functions.
// Errors    None; a text without the form of a name gives none or false.
#pragma once

#include <compare>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::cache {

struct GridName {
    std::string domain;
    level2::Moment moment = level2::Moment::ref;
    UtcTime time;
    // Ordered by domain, then moment, then time.
    // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes a defaulted <=> for a null.
    auto operator<=>(const GridName&) const = default;
};

// Returns true if a name has the form of a domain: [A-Za-z0-9][A-Za-z0-9_-]{0,63}, which may be
// followed by a part, '.' and an ICAO ([A-Z][A-Z0-9]{3}).
[[nodiscard]] bool is_domain_name(std::string_view name);

// Returns the text before the first '.', or all of it: "northeast" for "northeast" and for
// "northeast.KBOX".
[[nodiscard]] std::string_view group_of(std::string_view domain);
[[nodiscard]] bool is_part(std::string_view domain);

// Returns true for times from 1970 to 9999, the only times that can be in a name.
[[nodiscard]] bool is_possible(UtcTime time);
inline constexpr UtcTime last_possible_time{
    std::chrono::sys_days{std::chrono::year{10000} / 1 / 1} - std::chrono::milliseconds{1}};

[[nodiscard]] std::string day_name(UtcTime time);  // "20220317"
[[nodiscard]] bool is_day_name(std::string_view name);

// Returns the path below the cache's directory.
[[nodiscard]] std::filesystem::path relative_path(const GridName& name);

// Returns the time in a file name of exactly the form above; none for every other name.
[[nodiscard]] std::optional<UtcTime> time_in_file_name(std::string_view domain,
                                                       level2::Moment moment,
                                                       std::string_view file_name);

}  // namespace stormcellar::cache
