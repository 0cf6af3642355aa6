// daemon/status/status_names.h -- the words for results and errors in the status and in metrics.
// These words are an interface: dashboards and alerts use them.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <array>
#include <string_view>

#include "pipeline/ingest/ingest.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

inline constexpr std::array all_results = {
    pipeline::IngestResult::gridded,     pipeline::IngestResult::no_moment,
    pipeline::IngestResult::no_position, pipeline::IngestResult::other_station,
    pipeline::IngestResult::incomplete,  pipeline::IngestResult::rejected,
    pipeline::IngestResult::unchanged,   pipeline::IngestResult::vanished,
    pipeline::IngestResult::registered,
};
inline constexpr std::array all_error_codes = {
    ErrorCode::bad_argument, ErrorCode::not_found,   ErrorCode::empty,      ErrorCode::truncated,
    ErrorCode::corrupt,      ErrorCode::unsupported, ErrorCode::not_level2, ErrorCode::not_a_file,
    ErrorCode::io,           ErrorCode::exhausted,   ErrorCode::busy,       ErrorCode::no_space,
    ErrorCode::over_budget,  ErrorCode::unmet,       ErrorCode::permission, ErrorCode::internal,
};

// A counter for each value of an enumeration.
template <class T>
using PerResult = std::array<T, all_results.size()>;
template <class T>
using PerErrorCode = std::array<T, all_error_codes.size()>;
[[nodiscard]] constexpr std::size_t index_of(pipeline::IngestResult result) {
    return static_cast<std::size_t>(result);
}
[[nodiscard]] constexpr std::size_t index_of(ErrorCode code) {
    return static_cast<std::size_t>(code);
}
static_assert(all_error_codes.back() == ErrorCode::internal &&
                  index_of(ErrorCode::internal) + 1 == all_error_codes.size(),
              "every code is in the list, in the order of the enumeration");

[[nodiscard]] std::string_view name_of(pipeline::IngestResult result);
[[nodiscard]] std::string_view name_of(ErrorCode code);

}  // namespace stormcellar::daemon
