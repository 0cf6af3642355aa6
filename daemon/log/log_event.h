// daemon/log/log_event.h -- the kinds of log lines.
//
// The names are an interface: the journal has them as STORMCELLAR_EVENT, and docs/reference/log.md
// explains each name, as tests/repository/log_lines_test.cpp checks.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "pipeline/ingest/ingest.h"

namespace stormcellar::daemon {

enum class Event {
    ready,
    not_ready,
    stopping,
    stopped,
    stopped_with_jobs,
    reloaded,
    reload_failed,
    reload_ignored,
    hang,
    // events of a file
    gridded,
    living,
    no_moment,
    no_position,
    other_station,
    incomplete,
    rejected,
    unchanged,
    vanished,
    registered,
    store_failed,
    held_back,
    // events of the drop directory
    watch_failed,
    directory_problem,
    overflow,
    drop_lost,
    drop_back,
    files_gone,
    files_gone_failed,
    rows_deleted,
    behind,
    caught_up,
    // events of stored data
    stations_unknown,
    state_lost,
    state_mended,
    database_mended,
    database_trouble,
    database_back,
    databases_left_alone,
    cache_rolled,
    cache_problem,
    grid_damaged,
    grid_unchecked,
    grid_made_again,
    frame_made_again,
    care_failed,
    sites_compared,
    site_fault,
    // events of loops
    loop_started,
    loop_made,
    loop_said,
    loop_ended,
    loop_failed,
    // events of other machines
    partial_taken,
    partial_refused,
    partial_replaced,
    frame_problem,
    machine_late,
    machine_back,
    // events of the status
    status_answered,
    status_unanswered,
    status_unwritten,
};
inline constexpr std::size_t event_count = static_cast<std::size_t>(Event::status_unwritten) + 1;

[[nodiscard]] std::string_view name_of(Event event);
[[nodiscard]] constexpr std::size_t index_of(Event event) {
    return static_cast<std::size_t>(event);
}
[[nodiscard]] Event event_of(pipeline::IngestResult result);

}  // namespace stormcellar::daemon
