#include "daemon/service/troubles.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/ranges.h>

#include "base/counted.h"
#include "base/printable.h"
#include "daemon/log/log.h"
#include "daemon/loops/others_loops.h"
#include "daemon/watch/unreadable.h"

namespace stormcellar::daemon {
namespace {

constexpr std::chrono::seconds between_state_looks{1}, between_backlog_looks{1},
    between_loops_looks{5}, between_catalog_looks{1}, behind_after{20};
constexpr std::size_t most_waits_named = 5;  // number of waiting files that the status names

std::string named(const std::string& station) {
    return station.empty() ? std::string{"the files of no known station"} : station;
}

bool stands_in(const CatalogState& state, const std::string& station) {
    return std::any_of(state.troubles.begin(), state.troubles.end(),
                       [&](const auto& trouble) { return trouble.first == station; });
}

void log_troubles(const CatalogState& state, const CatalogState& known) {
    for (const auto& [station, reason] : state.troubles) {
        if (stands_in(known, station)) continue;
        log_error(
            {.event = Event::database_trouble, .station = station},
            "the database of {} cannot be used: {}; files that belong in it wait, all others go on",
            named(station), printable(reason));
    }
    for (const auto& [station, reason] : known.troubles) {
        if (stands_in(state, station)) continue;
        log_info({.event = Event::database_back, .station = station},
                 "the database of {} can be used again", named(station));
    }
}

void log_left_alone(const CatalogState& state) {
    log_warning(
        {Event::databases_left_alone},
        "{} of stations that [ingest] stations does not accept ({}{}): the service does not open "
        "them, and catalogs files of these stations among those of no known station; to accept a "
        "station, add a [[station]] or name it in [ingest] stations; to remove the databases, stop "
        "the service and run stormcellar catalog check --clear-unknown",
        counted(state.left_alone, "database"), fmt::join(state.some_left_alone, ", "),
        state.left_alone > state.some_left_alone.size() ? ", ..." : "");
}

}  // namespace

void DropTrouble::scanned(const Status& scanned, const std::filesystem::path& drop,
                          StatusBook& status) {
    std::string why;
    if (!scanned) why = scanned.error().message + remedy_for(drop, scanned.error().code);
    if (!scanned && !is_lost_) {
        log_error({Event::drop_lost},
                  "cannot read the drop directory {}; looking again every second", printable(why));
    } else if (scanned && is_lost_) {
        log_info({Event::drop_back}, "the drop directory {} can be read again",
                 printable(drop.native()));
    }
    is_lost_ = !scanned;
    status.set_drop_lost(printable(why));
}

bool StateTrouble::look(SteadyTime now, StateKeeper& keeper, const std::filesystem::path& state) {
    if (now < next_) return false;
    next_ = now + between_state_looks;
    const std::optional<Status> made = keeper.look();
    const bool is_made = made && *made;
    if (is_made) {
        log_warning({Event::state_mended},
                    "state directory {} was deleted; the service made it again",
                    printable(state.native()));
    } else if (made && !is_lost_) {
        log_error(
            {Event::state_lost},
            "state directory {} was deleted and cannot be made again: {}; restart the service",
            printable(state.native()), printable((*made).error().message));
    }
    is_lost_ = made && !*made;
    return is_made;
}

bool CatalogTrouble::look(SteadyTime now, Sink& sink, StatusBook& status) {
    if (now < next_) return false;
    next_ = now + between_catalog_looks;
    CatalogState state = sink.catalog_state();
    const CatalogState& known = status.facts().catalog;
    if (state == known) return false;
    log_troubles(state, known);
    if (state.left_alone != known.left_alone && state.left_alone > 0) log_left_alone(state);
    status.set_catalog(std::move(state));
    return true;
}

void BacklogTrouble::look(SteadyTime now, const Intake& intake, StatusBook& status) {
    if (now < next_) return;
    next_ = now + between_backlog_looks;
    const auto wait = intake.longest_wait();
    status.set_longest_wait(std::chrono::duration<double>(wait).count());
    std::vector<WaitingFile> growing;
    for (const GrowingFiles::Wait& one : intake.growing_waits(most_waits_named)) {
        growing.push_back({printable(one.file), std::chrono::duration<double>(one.left).count()});
    }
    status.set_waiting_files(std::move(growing));
    const std::size_t waiting = intake.pending().waiting;
    if (wait >= behind_after) {
        if (!is_behind_ || now >= next_line_) {
            log_warning({Event::behind},
                        "behind: {} waiting, the oldest for {} s; until it catches up, the service "
                        "grids complete volumes as usual, but only the low sweeps of growing ones",
                        counted(waiting, "file"),
                        std::chrono::duration_cast<std::chrono::seconds>(wait).count());
            next_line_ = now + std::chrono::minutes{1};
        }
        is_behind_ = true;
    } else if (is_behind_ && wait < behind_after / 2) {
        log_info({Event::caught_up}, "no longer behind: {} waiting", counted(waiting, "file"));
        is_behind_ = false;
    }
}

// Copies the state of loops that another process runs into the status of this process, because
// `stormcellard --loops-only` serves no metrics.
bool OthersLoops::look(SteadyTime now, const std::filesystem::path& state,
                       const std::vector<LoopConfig>& loops, bool runs_loops, StatusBook& status) {
    if (now < next_) return false;
    next_ = now + between_loops_looks;
    auto others = others_loops(state, loops);
    if (runs_loops) {
        const bool are_kept_twice = std::any_of(
            others.begin(), others.end(), [](const LoopState& loop) { return loop.is_running; });
        if (are_kept_twice && !are_kept_twice_) {
            log_warning({Event::loop_failed},
                        "another process runs the same loops and writes the same files; restart "
                        "this one with --no-loops");
        }
        are_kept_twice_ = are_kept_twice;
        return false;
    }
    if (others == status.facts().others_loops) return false;
    status.set_others_loops(std::move(others));
    return true;
}

}  // namespace stormcellar::daemon
