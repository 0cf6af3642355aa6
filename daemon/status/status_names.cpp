#include "daemon/status/status_names.h"

namespace stormcellar::daemon {

std::string_view name_of(pipeline::IngestResult result) {
    // The names, in the order of the enumeration.
    constexpr PerResult<std::string_view> names = {"gridded",       "no_moment",  "no_position",
                                                   "other_station", "incomplete", "rejected",
                                                   "unchanged",     "vanished",   "registered"};
    return names.at(index_of(result));
}

std::string_view name_of(ErrorCode code) {
    // The names, in the order of the enumeration. When a file is ingested, bad_argument means that
    // its data allow no grid.
    constexpr PerErrorCode<std::string_view> names = {
        "contradictory", "not_found",  "empty",      "truncated", "corrupt", "unsupported",
        "not_level2",    "not_a_file", "io",         "exhausted", "busy",    "no_space",
        "over_budget",   "unmet",      "permission", "internal"};
    return names.at(index_of(code));
}

}  // namespace stormcellar::daemon
