// What a Service reports: to its manager, to the status file and to the log.
#include <algorithm>
#include <chrono>
#include <mutex>
#include <utility>

#include <fmt/ranges.h>

#include "base/counted.h"
#include "base/printable.h"
#include "daemon/log/log.h"
#include "daemon/loops/others_loops.h"
#include "daemon/service/service.h"

namespace stormcellar::daemon {
namespace {

constexpr std::chrono::seconds between_state_looks{1}, between_backlog_looks{1},
    between_loops_looks{5}, between_catalog_looks{1}, behind_after{20};
constexpr std::size_t most_waits_named = 5;  // in the status

}  // namespace

std::optional<Step> Service::oldest_step() const {
    std::optional<Step> oldest = pulses_.oldest();
    const auto look_at = [&](const char* what, const WorkerPool& pool) {
        const auto job = pool.oldest();
        if (job && (!oldest || job->since < oldest->since))
            oldest = Step{what + job->path.native(), job->since};
    };
    look_at("ingest of ", pool_);
    look_at("registration of ", registrar_);
    return oldest;
}

// Handles a state directory that was deleted. Files that could not be stored meanwhile are tried
// again.
void Service::keep_state(SteadyTime now) {
    if (parts_.state == nullptr || now < next_state_look_) return;
    next_state_look_ = now + between_state_looks;
    const std::optional<Status> made = parts_.state->look();
    if (made && *made) {
        log_warning({Event::state_mended}, "state directory {} was deleted: it is made again",
                    printable(config_.state.native()));
        status_file_.changed();
    } else if (made && !state_lost_) {
        log_error({Event::state_lost},
                  "state directory {} was deleted, and cannot be made again: {}",
                  printable(config_.state.native()), printable((*made).error().message));
    }
    state_lost_ = made && !*made;
}

void Service::publish(bool at_once) {
    const Pending pending = intake_.pending();
    if (pending != published_) status_file_.changed();
    published_ = pending;
    const std::size_t directories = watcher_.directory_count();
    if (directories != status_.facts().directories) status_file_.changed();
    status_.set_directories(directories);
    if (!status_file_.publish(status_, pending, parts_.clock.steady(), at_once)) return;
    if (parts_.board != nullptr) parts_.board->post(status_.facts(), pending);
}

// Logs once when it begins, each minute while it lasts, and once when it is over.
void Service::report_backlog(SteadyTime now) {
    if (now < next_backlog_) return;
    next_backlog_ = now + between_backlog_looks;
    const auto wait = intake_.longest_wait();
    status_.set_longest_wait(std::chrono::duration<double>(wait).count());
    std::vector<WaitingFile> growing;
    for (const GrowingFiles::Wait& one : intake_.growing_waits(most_waits_named)) {
        growing.push_back({printable(one.file), std::chrono::duration<double>(one.left).count()});
    }
    status_.set_waiting_files(std::move(growing));
    const std::size_t waiting = intake_.pending().waiting;
    if (wait >= behind_after) {
        if (!is_behind_ || now >= next_behind_line_) {
            log_warning({Event::behind},
                        "behind: {} waiting, one of them for {} s; of growing volumes only the low "
                        "sweeps are gridded, whole volumes all",
                        counted(waiting, "file"),
                        std::chrono::duration_cast<std::chrono::seconds>(wait).count());
            next_behind_line_ = now + std::chrono::minutes{1};
        }
        is_behind_ = true;
    } else if (is_behind_ && wait < behind_after / 2) {
        log_info({Event::caught_up}, "no longer behind: {} waiting", counted(waiting, "file"));
        is_behind_ = false;
    }
}

void Service::report_repairs() {
    const std::vector<std::string> repairs = parts_.sink.take_repairs();
    for (const std::string& line : repairs)
        log_error({Event::database_mended}, "{}", printable(line));
    if (!repairs.empty()) intake_.forget_seen();
}

// Logs a database that cannot be used once when that begins, and once when it is over.
void Service::report_catalog(SteadyTime now) {
    if (now < next_catalog_look_) return;
    next_catalog_look_ = now + between_catalog_looks;
    CatalogState state = parts_.sink.catalog_state();
    const CatalogState& known = status_.facts().catalog;
    if (state == known) return;
    const auto named = [](const std::string& station) {
        return station.empty() ? std::string{"the files of no known station"} : station;
    };
    const auto stands_in = [](const CatalogState& there, const std::string& station) {
        return std::any_of(there.troubles.begin(), there.troubles.end(),
                           [&](const auto& trouble) { return trouble.first == station; });
    };
    for (const auto& [station, reason] : state.troubles) {
        if (stands_in(known, station)) continue;
        log_error({.event = Event::database_trouble, .station = station},
                  "the database of {} cannot be used: {}; its files wait, all others go on",
                  named(station), printable(reason));
    }
    for (const auto& [station, reason] : known.troubles) {
        if (stands_in(state, station)) continue;
        log_info({.event = Event::database_back, .station = station},
                 "the database of {} can be used again", named(station));
    }
    if (state.left_alone != known.left_alone && state.left_alone > 0) {
        log_warning(
            {Event::databases_left_alone},
            "{} of stations of which no data are taken in ({}{}): left alone, and files of "
            "these stations are cataloged among those of no known station; a [[station]] or "
            "[ingest] stations takes them in, stormcellar catalog check --clear-unknown "
            "removes them",
            counted(state.left_alone, "database"), fmt::join(state.some_left_alone, ", "),
            state.left_alone > state.some_left_alone.size() ? ", ..." : "");
    }
    status_.set_catalog(std::move(state));
    status_file_.changed();
}

// Failures because of a database in trouble are logged once, with the trouble.
void Service::report(const Finished& finished) {
    if (!finished.taken) {
        next_catalog_look_ = {};
        report_catalog(parts_.clock.steady());
    }
    const auto& troubles = status_.facts().catalog.troubles;
    const bool is_named =
        !finished.taken && std::any_of(troubles.begin(), troubles.end(), [&](const auto& trouble) {
            return trouble.second == finished.taken.error().message;
        });
    Reporter::report(finished, is_named ? Named::before : Named::not_yet);
}

void Service::sites_compared(pipeline::PairReport report) {
    {
        const std::scoped_lock lock(compared_mutex_);
        compared_.push_back(std::move(report));
    }
    wake_up_.set();
}

void Service::report_sites() {
    std::vector<pipeline::PairReport> reports;
    {
        const std::scoped_lock lock(compared_mutex_);
        reports.swap(compared_);
    }
    for (pipeline::PairReport& report : reports) {
        Reporter::report_sites(report);
        status_.add(std::move(report));
        status_file_.changed();
    }
}

// Loops that another service keeps are in this one's metrics, because that service answers no
// requests.
void Service::look_at_others_loops(SteadyTime now) {
    if (now < next_loops_look_) return;
    next_loops_look_ = now + between_loops_looks;
    auto loops = others_loops(config_.state, config_.loops);
    if (parts_.keeps_loops) {
        const bool twice = std::any_of(loops.begin(), loops.end(),
                                       [](const LoopState& loop) { return loop.is_running; });
        if (twice && !loops_kept_twice_) {
            log_warning({Event::loop_failed},
                        "another process keeps the loops, too, and writes the same files: start "
                        "this one with --no-loops");
        }
        loops_kept_twice_ = twice;
        return;
    }
    if (loops == status_.facts().others_loops) return;
    status_.set_others_loops(std::move(loops));
    status_file_.changed();
}

}  // namespace stormcellar::daemon
