#include "daemon/status/status_names.h"

namespace stormcellar::daemon {

using pipeline::IngestResult;

std::string_view name_of(IngestResult result) {
    switch (result) {
        case IngestResult::gridded:
            return "gridded";
        case IngestResult::no_moment:
            return "no_moment";
        case IngestResult::no_position:
            return "no_position";
        case IngestResult::other_station:
            return "other_station";
        case IngestResult::incomplete:
            return "incomplete";
        case IngestResult::rejected:
            return "rejected";
        case IngestResult::unchanged:
            return "unchanged";
        case IngestResult::vanished:
            return "vanished";
        case IngestResult::registered:
            return "registered";
    }
    return "unknown";
}

std::string_view name_of(ErrorCode code) {
    switch (code) {
        case ErrorCode::bad_argument:
            return "contradictory";  // the file's own data allow no grid
        case ErrorCode::not_found:
            return "not_found";
        case ErrorCode::empty:
            return "empty";
        case ErrorCode::truncated:
            return "truncated";
        case ErrorCode::corrupt:
            return "corrupt";
        case ErrorCode::unsupported:
            return "unsupported";
        case ErrorCode::not_level2:
            return "not_level2";
        case ErrorCode::not_a_file:
            return "not_a_file";
        case ErrorCode::io:
            return "io";
        case ErrorCode::exhausted:
            return "exhausted";
        case ErrorCode::busy:
            return "busy";
        case ErrorCode::no_space:
            return "no_space";
        case ErrorCode::over_budget:
            return "over_budget";
        case ErrorCode::unmet:
            return "unmet";
        case ErrorCode::permission:
            return "permission";
        case ErrorCode::internal:
            return "internal";
    }
    return "unknown";
}

}  // namespace stormcellar::daemon
