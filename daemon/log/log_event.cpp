#include "daemon/log/log_event.h"

namespace stormcellar::daemon {
namespace {

// The names, in the order of the enumeration.
constexpr std::array<std::string_view, event_count> names = {
    "ready",
    "not_ready",
    "stopping",
    "stopped",
    "stopped_with_jobs",
    "reloaded",
    "reload_failed",
    "reload_ignored",
    "hang",
    "gridded",
    "living",
    "no_moment",
    "no_position",
    "other_station",
    "incomplete",
    "rejected",
    "unchanged",
    "vanished",
    "registered",
    "store_failed",
    "held_back",
    "watch_failed",
    "directory_problem",
    "overflow",
    "drop_lost",
    "drop_back",
    "files_gone",
    "files_gone_failed",
    "rows_deleted",
    "behind",
    "caught_up",
    "stations_unknown",
    "state_lost",
    "state_mended",
    "database_mended",
    "database_trouble",
    "database_back",
    "databases_left_alone",
    "cache_rolled",
    "cache_problem",
    "grid_damaged",
    "grid_unchecked",
    "grid_made_again",
    "frame_made_again",
    "care_failed",
    "sites_compared",
    "site_fault",
    "loop_started",
    "loop_made",
    "loop_said",
    "loop_ended",
    "loop_failed",
    "partial_taken",
    "partial_refused",
    "partial_replaced",
    "frame_problem",
    "machine_late",
    "machine_back",
    "status_answered",
    "status_unanswered",
    "status_unwritten",
};

}  // namespace

std::string_view name_of(Event event) {
    return names.at(index_of(event));
}

Event event_of(pipeline::IngestResult result) {
    // The events, in the order of the enumeration.
    constexpr std::array events = {Event::gridded,       Event::no_moment,  Event::no_position,
                                   Event::other_station, Event::incomplete, Event::rejected,
                                   Event::unchanged,     Event::vanished,   Event::registered};
    return events.at(static_cast<std::size_t>(result));
}

}  // namespace stormcellar::daemon
