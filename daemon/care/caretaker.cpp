#include "daemon/care/caretaker.h"

#include <algorithm>
#include <exception>
#include <utility>

#include <pthread.h>

#include "base/printable.h"
#include "daemon/log/log.h"
#include "daemon/status/status_names.h"

namespace stormcellar::daemon {

using pipeline::GridCondition;
using pipeline::MendDepth;

namespace {

constexpr std::chrono::milliseconds look_again{100};
constexpr std::chrono::milliseconds pause_after_failure{60'000};

void log_problem(std::string_view what, const Error& error) {
    log_warning({.event = Event::care_failed, .reason = name_of(error.code)}, "{}: {}", what,
                printable(error.message));
}

// Returns true if the database cannot be used at all. The caretaker does not report such a
// database, because the service does.
bool is_in_trouble(const catalog::CatalogReader& catalog, const std::string& station) {
    const auto troubles = catalog.troubles();
    return std::any_of(troubles.begin(), troubles.end(),
                       [&](const catalog::Trouble& trouble) { return trouble.station == station; });
}

}  // namespace

Caretaker::Caretaker(CareOf of, CareTimes times, CareLinks links)
    : of_(of), times_(times), links_(std::move(links)), thread_([this] { run(); }) {}

Caretaker::~Caretaker() {
    {
        const MutexLock lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

bool Caretaker::is_stopped_within(std::chrono::milliseconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    while (!stopping_ && std::chrono::steady_clock::now() < end)
        changed_.wait_until(mutex_, end);
    return stopping_;
}

bool Caretaker::pause(std::chrono::milliseconds least) {
    pulse_.rest();
    const MutexLock lock(mutex_);
    if (is_stopped_within(least)) return false;
    while (!links_.is_idle()) {
        if (is_stopped_within(look_again)) return false;
    }
    pulse_.beat();
    return true;
}

bool Caretaker::rest(std::chrono::milliseconds least) {
    const auto until = std::chrono::steady_clock::now() + least;
    while (true) {
        const auto left =
            std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
        if (!pause(std::clamp(left, std::chrono::milliseconds{0}, times_.between_looks))) {
            return false;
        }
        if (!compare_sites()) return false;
        if (std::chrono::steady_clock::now() >= until) return true;
    }
}

bool Caretaker::compare_sites() {
    if (std::chrono::steady_clock::now() < next_look_) return true;
    while (true) {
        if (!pause({})) return false;
        auto report = of_.sites.compare_next();
        if (!report || !*report) break;  // the rounds report that the cache cannot be read
        links_.compared(std::move(**report));
    }
    next_look_ = std::chrono::steady_clock::now() + times_.between_looks;
    return true;
}

bool Caretaker::look_at_all() {
    if (!pause({})) return false;
    examine_databases();
    return check_grids(MendDepth::header, {});
}

bool Caretaker::round() {
    refill();
    return check_grids(MendDepth::all, times_.between_grids) && rest(times_.between_rounds);
}

void Caretaker::run() {
    ::pthread_setname_np(::pthread_self(), "caretaker");
    for (bool is_first = true, goes_on = true; goes_on;) {
        try {
            goes_on = (!is_first || look_at_all()) && round();
            is_first = false;
        } catch (const std::exception& error) {  // memory is short
            log_error({Event::care_failed},
                      "cannot verify and mend grids: {}; the service tries again", error.what());
            goes_on = pause(std::min(times_.between_rounds, pause_after_failure));
        }
    }
    pulse_.rest();
}

// Examines and repairs the databases. The service logs the repairs, then scans the drop directory
// for files whose rows were lost.
void Caretaker::examine_databases() {
    const auto stations = of_.catalog.station_names();
    if (!stations) return log_problem("cannot examine the catalog", stations.error());
    for (const std::string& station : *stations) {
        if (!pause({})) return;
        const Status sound = of_.catalog.examine(station);
        if (!sound && !is_in_trouble(of_.catalog, station))
            log_problem("cannot mend a database", sound.error());
    }
}

bool Caretaker::check_grids(MendDepth depth, std::chrono::milliseconds between) {
    const auto domains = of_.store.domains();
    if (!domains) {
        log_problem("cannot list the grids in the cache", domains.error());
        return true;
    }
    for (const std::string& domain : *domains) {
        for (const level2::Moment moment : level2::all_moments) {
            pulse_.beat();
            const auto entries = of_.store.list(domain, moment, std::nullopt, std::nullopt);
            if (!entries) {
                log_problem("cannot list the grids in the cache", entries.error());
                continue;
            }
            for (auto entry = entries->rbegin(); entry != entries->rend(); ++entry) {
                if (!rest(between)) return false;
                mend(*entry, depth);
            }
        }
    }
    return true;
}

void Caretaker::mend(const cache::StoreEntry& entry, MendDepth depth) {
    const auto mended = of_.mender.mend(entry, depth);
    if (!mended) return log_problem("cannot mend a damaged grid", mended.error());
    const std::string reason = printable(mended->reason);
    const About about{.event = Event::grid_damaged,
                      .volume = entry.time,
                      .file = entry.path,
                      .domain = entry.domain};
    About unchecked = about;
    unchecked.event = Event::grid_unchecked;
    switch (mended->condition) {
        case GridCondition::sound:
            break;
        case GridCondition::made_again:
            log_warning(about, "damaged grid {}; the service removed it and made it again from {}",
                        reason, printable(mended->from));
            break;
        case GridCondition::dropped:
            log_warning(about,
                        "damaged grid {}; the service removed it and cannot make it again: {}",
                        reason, printable(mended->why_not));
            break;
        case GridCondition::left_alone:
            log_warning(unchecked, "cannot verify grid {}; the service left it alone", reason);
            break;
    }
}

void Caretaker::refill() {
    if (times_.refill <= std::chrono::milliseconds{0}) return;
    const auto missing = of_.mender.missing(times_.refill, [this] { pulse_.beat(); });
    if (!missing) return log_problem("cannot look for missing grids", missing.error());
    for (const pipeline::MissingGrid& grid : *missing) {
        if (!pause({})) return;
        const auto made = of_.mender.make(grid);
        if (!made) log_problem("cannot make a missing grid", made.error());
        if (!made && is_shortage(made.error().code)) return;
        if (!made) continue;
        if (made->result() != pipeline::IngestResult::gridded && made->partials.empty()) continue;
        log_info({.event = Event::grid_made_again,
                  .volume = grid.time,
                  .file = grid.raw,
                  .domain = grid.names.front().domain},
                 "missing grid {} {} was made again from {}", grid.names.front().domain,
                 format_utc(grid.time), printable(grid.raw.native()));
    }
    refill_frames();
}

// Makes the missing frames of mosaics. Call it after the missing partials were made.
void Caretaker::refill_frames() {
    const auto missing = of_.mender.missing_frames(times_.refill);
    if (!missing) return log_problem("cannot look for missing frames", missing.error());
    for (const cache::GridName& frame : *missing) {
        if (!pause({})) return;
        const auto made = of_.mender.make(frame);
        if (!made) return log_problem("cannot make a missing frame", made.error());
        if (!*made) continue;
        log_info({.event = Event::frame_made_again, .volume = frame.time, .domain = frame.domain},
                 "missing frame {} {} was made again from {}", frame.domain, format_utc(frame.time),
                 **made);
    }
}

}  // namespace stormcellar::daemon
