// web/doors/index/page.h -- the index page as HTML: stations with their ages, domains, and help for
// each client program. It needs no script. Its style is a separate file, since the
// Content-Security-Policy allows no style within the page.
//
// Threads   Pure functions.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/utc_time.h"

namespace stormcellar::web {

struct IndexStation {
    std::string icao;
    std::string place;  // "Oklahoma City, OK"; empty: unknown
    std::optional<UtcTime> newest_volume, newest_grid;
    std::optional<UtcTime> heard;      // when something last came
    std::vector<std::string> moments;  // of its grids
    bool is_silent = false;
};

struct IndexDomain {
    std::string name;
    std::vector<std::string> moments;
    std::optional<UtcTime> newest;
};

struct IndexFacts {
    UtcTime now{};
    std::string base;                // the server's address, without a slash at the end
    std::vector<std::string> doors;  // their prefixes; links to absent doors are left out
    std::string bucket;
    std::vector<IndexStation> stations;
    std::vector<IndexDomain> domains;  // domains that are not single stations
    bool is_cut = false;               // more stations exist than are listed
};

[[nodiscard]] std::string index_html(const IndexFacts& facts);
// The style sheet, at "/index.css".
[[nodiscard]] std::string_view index_style();

// Returns "42 s", "3 min", "5 h 20 min", "12 days", "3 years"; "in the future" if `to` is over a
// minute before `from`.
[[nodiscard]] std::string age_text(UtcTime from, UtcTime to);
// Returns the path of an address: "/storms" of "https://example.org/storms", empty if it has none.
[[nodiscard]] std::string_view path_of_base(std::string_view base);

}  // namespace stormcellar::web
