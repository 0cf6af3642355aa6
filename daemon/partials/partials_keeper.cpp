#include "daemon/partials/partials_keeper.h"

#include <algorithm>
#include <exception>
#include <utility>

#include <poll.h>
#include <pthread.h>

#include "base/printable.h"
#include "daemon/log/log.h"
#include "daemon/status/status_names.h"
#include "pipeline/keep/keep_rule.h"

namespace stormcellar::daemon {
namespace {

constexpr std::chrono::milliseconds longest_poll{1000};
// An incomplete file may still be written to; complain only if it is older than this.
constexpr std::chrono::seconds settled_after{30};
// Pause after a frame could not be made again, or after memory ran out.
constexpr std::chrono::milliseconds pause_after_failure{5000};

bool is_unsettled(const std::filesystem::path& file) {
    const FileFound found = look_at(file, {});
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    const auto modified = std::chrono::nanoseconds{found.stamp.modified_ns};
    return now - modified < settled_after;
}

std::unique_ptr<EventSource> open_events(const std::filesystem::path& directory) {
    auto events = open_inotify();
    if (events) return std::move(*events);
    log_warning({Event::watch_failed}, "cannot watch {}: {}; the service polls it instead",
                printable(directory.native()), printable(events.error().message));
    return no_events();
}

template <class Duration>
std::string whole_seconds(Duration time) {
    return fmt::format("{} s", std::chrono::duration_cast<std::chrono::seconds>(time).count());
}

}  // namespace

PartialsKeeper::PartialsKeeper(PartialsConfig config, PartialsOf of, PartialsTimes times)
    : config_(std::move(config)), of_(std::move(of)), times_(times) {
    for (const std::filesystem::path& directory : config_.directories) {
        Machine machine;
        machine.directory = std::make_unique<MachineDirectory>(directory, open_events(directory));
        machine.facts.name = machine.directory->name();
        machine.facts.directory = printable(directory.native());
        machines_.push_back(std::move(machine));
    }
    if (machines_.empty()) return;
    publish();
    thread_ = std::thread([this] { run(); });
}

PartialsKeeper::~PartialsKeeper() {
    stopping_ = true;
    wake_up_.set();
    if (thread_.joinable()) thread_.join();
}

std::vector<MachineFacts> PartialsKeeper::facts() const {
    const MutexLock lock(mutex_);
    return published_;
}

void PartialsKeeper::run() {
    ::pthread_setname_np(::pthread_self(), "partials");
    while (!stopping_) {
        try {
            turn();
        } catch (const std::exception& error) {
            // Usually memory is short. The next scan finds the partials that were not taken.
            log_error({Event::partial_refused},
                      "cannot take partials of other machines: {}; the service tries again",
                      error.what());
            for (Machine& machine : machines_)
                machine.next_scan = {};
            pulse_.rest();
            pollfd stop = {wake_up_.descriptor(), POLLIN, 0};
            ::poll(&stop, 1, static_cast<int>(pause_after_failure.count()));
            continue;
        }
        wait();
    }
    pulse_.rest();
}

void PartialsKeeper::turn() {
    pulse_.beat();
    for (Machine& machine : machines_) {
        machine.directory->read_events();
        if (machine.directory->take_lost()) machine.next_scan = {};
        if (steady_now() >= machine.next_scan) scan(machine);
    }
    has_more_ = take_one() || mend_one();
    judge();
    publish();
}

void PartialsKeeper::wait() {
    if (has_more_) return;
    pulse_.rest();
    std::vector<pollfd> sources = {{wake_up_.descriptor(), POLLIN, 0}};
    for (const Machine& machine : machines_)
        sources.push_back({machine.directory->descriptor(), POLLIN, 0});
    ::poll(sources.data(), sources.size(), static_cast<int>(longest_poll.count()));
}

void PartialsKeeper::scan(Machine& machine) {
    ++machine.scans;
    const Status scanned = machine.directory->scan();
    machine.next_scan = steady_now() + (machine.directory->is_blind() || !scanned
                                            ? std::min(times_.poll, times_.rescan)
                                            : times_.rescan);
    if (!scanned) {
        machine.facts.last_problem = printable(scanned.error().message);
        return;
    }
    take_lost(machine);
}

// Makes the next scan report partials that the cache would keep but has lost.
void PartialsKeeper::take_lost(Machine& machine) {
    for (const cache::GridName& name : machine.directory->known()) {
        pulse_.beat();
        const auto path = of_.store.path_of(name.domain, name.moment, name.time);
        std::error_code ignored;
        if (!path || std::filesystem::exists(*path, ignored) || !is_wanted(name)) continue;
        if (!pipeline::has_an_hours_volumes(of_.store, name.domain, name.moment, name.time))
            machine.directory->forget(name);
    }
}

// Ingests the newest waiting partial of each machine. Returns true if a partial waited.
bool PartialsKeeper::take_one() {
    bool took = false;
    std::exception_ptr failure;
    for (Machine& machine : machines_) {
        if (stopping_) return false;
        const auto name = machine.directory->take_news();
        if (!name) continue;
        pulse_.beat();
        try {
            take(machine, *name);
        } catch (...) {  // the partial may be in the cache without its frames
            machine.directory->forget(*name);
            failure = std::current_exception();
        }
        took = true;
    }
    if (failure) std::rethrow_exception(failure);
    return took;
}

// Looks at one frame that may lack a partial. If the frame lacks one, makes the frame again.
// Returns true if there was a frame to look at and nothing failed.
bool PartialsKeeper::mend_one() {
    if (stopping_ || steady_now() < next_mending_) return false;
    pulse_.beat();
    std::vector<std::string> problems;
    const auto looked = of_.mosaics.make_stale(of_.threads, problems);
    for (const std::string& problem : problems)
        log_warning({Event::frame_problem}, "frame of partials: {}", printable(problem));
    if (!looked) {
        log_warning({Event::frame_problem}, "cannot make a frame of partials again: {}",
                    printable(looked.error().message));
        next_mending_ = steady_now() + pause_after_failure;
        return false;
    }
    if (!*looked) return false;
    const auto& [name, made] = **looked;
    if (made) {
        log_info({.event = Event::frame_made_again, .volume = name.time, .domain = name.domain},
                 "frame {} {} lacked a part and was made again", name.domain,
                 format_utc(name.time));
    }
    return true;
}

// Returns true if this machine has the partial's domain and its cache would keep the grid.
bool PartialsKeeper::is_wanted(const cache::GridName& name) const {
    return !of_.mosaics.is_idle() &&
           of_.mosaics.find(cache::group_of(name.domain), name.moment) != nullptr &&
           of_.store.would_keep(name.domain, name.moment, name.time);
}

// Checks that the machine may bring the station. Each station of a mosaic takes a descriptor, and
// time in every frame, so machines must not invent stations.
Status PartialsKeeper::check_station(const Machine& machine, const cache::GridName& name,
                                     const std::string& station) const {
    if (!config_.may_bring(machine.facts.name, station))
        return fail(ErrorCode::bad_argument, "[partials.stations] does not assign {} to it",
                    station);
    const auto has_it = [&](const std::vector<std::string>& stations) {
        return std::ranges::find(stations, station) != stations.end();
    };
    const auto listed = config_.stations.find(machine.facts.name);
    const auto* const domain = of_.mosaics.find(cache::group_of(name.domain), name.moment);
    if ((listed != config_.stations.end() && has_it(listed->second)) ||
        (domain != nullptr && has_it(domain->stations)) || StationRule{}.knows(station) ||
        of_.stations->knows(station))
        return {};
    return fail(ErrorCode::bad_argument,
                "{} is not a known station; name it in [partials.stations], [ingest] stations or a "
                "[[station]]",
                station);
}

void PartialsKeeper::take(Machine& machine, const cache::GridName& name) {
    if (!is_wanted(name)) return;
    const std::filesystem::path file = machine.directory->path() / cache::relative_path(name);
    const auto start = steady_now();
    const std::string station = name.domain.substr(name.domain.find('.') + 1);
    if (const Status allowed = check_station(machine, name, station); !allowed)
        return refuse(
            machine, name,
            {allowed.error().code, fmt::format("{}: {}", file.native(), allowed.error().message)});
    const auto kept = of_.mosaics.take_partial(
        {file, name, machine.facts.name, [this] { pulse_.beat(); }}, of_.threads);
    const About about{
        .event = Event::partial_taken, .volume = name.time, .file = file, .domain = name.domain};
    if (!kept) {
        if (kept.error().code == ErrorCode::not_found) return;  // the file was removed meanwhile
        const bool is_of_data = kept.error().cause() == Cause::data;
        const bool may_change = is_of_data && is_unsettled(file);
        const bool is_tried_again = may_change || kept.error().cause() == Cause::system;
        if (!may_change) refuse(machine, name, kept.error());
        if (is_tried_again) machine.directory->forget(name);
        return;
    }
    for (const std::string& problem : kept->problems)
        log_warning({Event::frame_problem}, "frame of partials: {}", printable(problem));
    machine.last_news = steady_now();
    machine.facts.arrived = now_utc();
    if (kept->won) note_rival(machine, name, *kept->won);
    if (kept->partials.empty()) return;
    ++machine.facts.taken;
    log_debug(about, "partial of {}: {} {}, {} frames, in {:.0f} ms", machine.facts.name,
              name.domain, format_utc(name.time), kept->frames.size(), 1000 * seconds_since(start));
}

// Reports that a partial of one machine has replaced a partial of another machine. Machines that
// have the same files bring the same partials. So two partials of a complete volume differ only if
// the machines had different files or one sends wrong data.
void PartialsKeeper::note_rival(Machine& machine, const cache::GridName& name, bool won) {
    for (Machine& other : machines_) {
        if (&other == &machine || !other.directory->has(name)) continue;
        Machine &winner = won ? machine : other, &loser = won ? other : machine;
        ++winner.facts.replaced;
        const About about{.event = Event::partial_replaced,
                          .volume = name.time,
                          .file = winner.directory->path() / cache::relative_path(name),
                          .domain = name.domain};
        return log_warning(about,
                           "partial of {}: {} {} replaces one of {}; name the "
                           "stations of each machine in [partials.stations]",
                           winner.facts.name, name.domain, format_utc(name.time), loser.facts.name);
    }
}

void PartialsKeeper::refuse(Machine& machine, const cache::GridName& name, const Error& why) {
    machine.directory->refuse(name);
    ++machine.facts.refused;
    machine.facts.last_problem = printable(why.message);
    const About about{.event = Event::partial_refused,
                      .volume = name.time,
                      .file = machine.directory->path() / cache::relative_path(name),
                      .domain = name.domain,
                      .reason = name_of(why.code)};
    log_warning(about, "partial of {}: {}", machine.facts.name, printable(why.message));
}

// Updates which machines are late, and logs changes.
void PartialsKeeper::judge() {
    std::optional<UtcTime> newest;
    for (Machine& machine : machines_) {
        // Ignore a volume with a time in the future, because it would make other machines late.
        machine.facts.newest = of_.sources->newest_of(machine.facts.name);
        if (machine.facts.newest) machine.facts.newest = std::min(*machine.facts.newest, now_utc());
        if (machine.facts.newest)
            newest = std::max(newest.value_or(UtcTime{}), *machine.facts.newest);
    }
    for (Machine& machine : machines_) {
        const auto silent = steady_now() - machine.last_news;
        std::string why;
        if (silent > config_.late_after) {
            why = "nothing came for " + whole_seconds(silent);
        } else if (machine.facts.newest && *newest - *machine.facts.newest > config_.late_after) {
            why = fmt::format("its newest volume is of {}, {} behind the others",
                              format_utc(*machine.facts.newest),
                              whole_seconds(*newest - *machine.facts.newest));
        }
        const bool is_late = !why.empty();
        if (is_late && !machine.facts.is_late)
            log_warning({Event::machine_late}, "machine {} is late: {}; frames leave it out",
                        machine.facts.name, why);
        if (!is_late && machine.facts.is_late)
            log_info({Event::machine_back}, "machine {} has caught up", machine.facts.name);
        // `why` counts seconds. Update it only when is_late changes, so that the status does not
        // change every second.
        if (is_late != machine.facts.is_late) machine.facts.why = why;
        machine.facts.is_late = is_late;
    }
}

void PartialsKeeper::publish() {
    std::vector<MachineFacts> facts;
    std::uint64_t scans = machines_.front().scans;
    for (const Machine& machine : machines_) {
        facts.push_back(machine.facts);
        scans = std::min(scans, machine.scans);
    }
    {
        const MutexLock lock(mutex_);
        published_ = std::move(facts);
    }
    published_scans_ = scans;
}

}  // namespace stormcellar::daemon
