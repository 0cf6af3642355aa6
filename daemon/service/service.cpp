#include "daemon/service/service.h"

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include <poll.h>

#include "base/counted.h"
#include "base/memory.h"
#include "base/printable.h"
#include "daemon/log/log.h"

namespace stormcellar::daemon {
namespace {

// Scans take at most about a tenth of the time, however often something asks for one.
constexpr std::chrono::milliseconds least_scan_gap{100};
constexpr int scan_rest = 10;
constexpr std::chrono::seconds longest_sleep{10};
constexpr std::chrono::seconds time_to_drain{20};
constexpr std::chrono::seconds between_held_back{1};
constexpr std::chrono::milliseconds between_memory_looks{250};
constexpr std::chrono::seconds longest_start{60};  // the longest time between two looks
// At the start, a missing drop directory is looked for this often instead of once a minute.
constexpr std::chrono::seconds between_first_scans{1};

// Free memory beyond this is returned to the system. Volumes that are decoded one after the other
// leave less, which is used again at once.
constexpr std::size_t most_kept_bytes(int workers) {
    return (32 + 16 * static_cast<std::size_t>(workers)) << 20U;
}

// If the configuration names no socket, it was chosen at the start.
bool same_listening(const Config& fresh, const Config& running) {
    const bool same_socket =
        fresh.status.socket.empty() || fresh.status.socket == running.status.socket;
    return same_socket && fresh.status.http_port == running.status.http_port;
}

// The parts of the configuration that are used only at the start.
bool same_at_the_start(const Config& fresh, const Config& running) {
    return fresh.living == running.living && fresh.bunzip == running.bunzip &&
           fresh.ingest.living.chunk_timeout == running.ingest.living.chunk_timeout &&
           fresh.ingest.living.chunk_grace == running.ingest.living.chunk_grace &&
           fresh.refill == running.refill && fresh.packing == running.packing &&
           fresh.stations.same_as(running.stations) &&
           fresh.added_stations == running.added_stations;
}

Result<Taken> take(Sink& sink, const Job& job) {
    const bool is_last = job.failures + 1 >= Intake::most_tries;
    return sink.take(job.path, job.finish_partial,
                     is_last ? pipeline::Tries::last : pipeline::Tries::more_follow);
}

Result<Taken> note(Sink& sink, const Job& job) {
    const auto noted = sink.note(job.path);
    if (!noted) return pass_on(noted);
    Taken taken;
    taken.ingest.result = *noted;
    return taken;
}

}  // namespace

Service::Service(Config config, std::filesystem::path config_file, ServiceParts parts)
    : config_(std::move(config)),
      config_file_(std::move(config_file)),
      parts_(std::move(parts)),
      intake_(config_, parts_.clock),
      watcher_(config_.drop, parts_.events, intake_),
      status_(config_.drop, config_.cache),
      status_file_(parts_.file_system, config_.state, parts_.notifier),
      watchdog_(parts_.notifier.watchdog()),
      pool_([this](const Job& job) { return take(parts_.sink, job); }, "ingest",
            config_.worker_count(), [this] { wake_up_.set(); }),
      registrar_([this](const Job& job) { return note(parts_.sink, job); }, "register", 1,
                 [this] { wake_up_.set(); }),
      row_keeper_(parts_.sink),
      cache_keeper_(parts_.sink, [this] { wake_up_.set(); }),
      loop_keeper_(config_.cache, [this] { wake_up_.set(); }) {
    need([this]() -> Status {
        if (!drop_missing_) return {};
        return fail(ErrorCode::not_found, "drop directory {}", drop_problem_);
    });
    need([this] { return can_write_in(parts_.file_system, config_.state); });
    need([this] { return parts_.sink.can_store(); });
    watcher_.on_step([this] { keep_workers_busy(); });
    status_.set_listening(config_.status.socket, config_.status.http_port);
    watch("missing", row_keeper_.pulse());
    watch("cache", cache_keeper_.pulse());
    watch("loops", loop_keeper_.pulse());
    if (parts_.board != nullptr) parts_.board->post(status_.facts(), {});
}

void Service::know_station(const std::string& station, UtcTime newest_volume) {
    status_.stations().add_known(station, newest_volume, now_utc());
}

void Service::request_stop() {
    stop_requested_ = true;
    wake_up_.set();
}

Stopped Service::run() {
    start();
    turn();
    while (!stop_requested_) {
        wait();
        turn();
    }
    return stop();
}

void Service::start() {
    scan();
    if (parts_.keeps_loops) loop_keeper_.set(config_.loops);
}

// Without READY, systemd would give up after TimeoutStartSec, so it is told that we still wait.
void Service::get_ready() {
    if (!readiness_.look(parts_.clock.steady())) return;
    if (!readiness_.is_ready()) {
        parts_.notifier.send(fmt::format("STATUS=waiting: {}\nEXTEND_TIMEOUT_USEC={}",
                                         printable(readiness_.missing()),
                                         std::chrono::microseconds{longest_start}.count()));
        if (readiness_.is_news()) {
            log_warning({Event::not_ready}, "not ready: {}; looking again every second",
                        printable(readiness_.missing()));
        }
        publish(true);
        return;
    }
    const Pending pending = intake_.pending();
    status_.set_state("running");
    publish(true);
    parts_.notifier.send("READY=1");
    log_info({Event::ready}, "ready: watching {} ({}), {} to look at, {}",
             printable(config_.drop.native()),
             counted(watcher_.directory_count(), "directory", "directories"),
             counted(pending.waiting + pending.growing, "file"),
             counted(static_cast<std::uint64_t>(config_.worker_count()), "worker"));
}

void Service::turn() {
    handle_signals();
    if (stop_requested_) return;
    wake_up_.clear();
    keep_workers_busy();
    watcher_.read_events();
    keep_workers_busy();
    scan_if_due();
    intake_.poll_growing();
    get_ready();
    keep_workers_busy();
    keep_house();
    const std::size_t waiting = intake_.pending().waiting;
    idle_ = waiting == 0;
    parts_.sink.set_pressed(waiting > static_cast<std::size_t>(config_.worker_count()));
}

SteadyTime Service::next_time() const {
    SteadyTime time =
        std::min({parts_.clock.steady() + longest_sleep, next_scan_, cache_keeper_.next_time()});
    const auto work = intake_.next_time(pool_.has_free_worker(), registrar_.has_free_worker());
    for (const auto& due :
         {work, status_file_.next_time(), watchdog_.next_time(), readiness_.next_time()}) {
        if (due) time = std::min(time, *due);
    }
    if (intake_.needs_scan()) time = std::min(time, rested_);
    if (const auto again = intake_.look_again_at())
        time = std::min(time, std::max(*again, rested_));
    return time;
}

void Service::wait() {
    std::array<pollfd, 3> sources = {
        pollfd{wake_up_.descriptor(), POLLIN, 0},
        {parts_.events.descriptor(), POLLIN, 0},
        {parts_.signals == nullptr ? -1 : parts_.signals->descriptor(), POLLIN, 0}};
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(next_time() - parts_.clock.steady());
    // An interrupted poll is only a short sleep; negative descriptors are ignored.
    ::poll(sources.data(), sources.size(),
           static_cast<int>(std::max<std::int64_t>(0, left.count())));
}

void Service::handle_signals() {
    if (take_signals(parts_.signals, [this] { reload(); })) stop_requested_ = true;
}

void Service::reload() {
    parts_.notifier.send(reloading_state());
    if (const Result<Config> fresh = load_config(config_file_)) {
        apply(*fresh);
    } else {
        log_error({Event::reload_failed}, "reload: {}; the configuration stays as it was",
                  printable(fresh.error().message));
    }
    // A service that is not ready yet says so once it is.
    if (readiness_.is_ready()) parts_.notifier.send("READY=1");
}

void Service::apply(const Config& fresh) {
    if (fresh.drop != config_.drop || fresh.state != config_.state ||
        fresh.cache != config_.cache) {
        log_warning({Event::reload_ignored},
                    "reload: [paths] cannot change while the service runs: restart it");
    }
    if (!same_grids(fresh.ingest, config_.ingest) || fresh.queue_limit != config_.queue_limit) {
        log_warning({Event::reload_ignored},
                    "reload: the grid, mosaics, threads and queue_limit change at a restart only");
    }
    if (!same_at_the_start(fresh, config_)) {
        log_warning({Event::reload_ignored},
                    "reload: stations, living, bunzip, the chunks' times, refill_hours and "
                    "compression change at a restart only");
    }
    if (!same_listening(fresh, config_))
        log_warning({Event::reload_ignored}, "reload: [status] changes at a restart only");
    config_.workers = fresh.workers;
    config_.quiet = fresh.quiet;
    config_.reread = fresh.reread;
    config_.rescan = fresh.rescan;
    config_.poll = fresh.poll;
    if (fresh.budgets != config_.budgets) cache_keeper_.roll_soon();
    config_.budgets = fresh.budgets;
    config_.gone_kept = fresh.gone_kept;
    config_.log_level = fresh.log_level;
    config_.loops = fresh.loops;
    if (parts_.keeps_loops) loop_keeper_.set(config_.loops);
    pool_.resize(config_.worker_count());
    intake_.set_times(config_);
    next_scan_ = std::min(next_scan_, parts_.clock.steady() + config_.rescan);
    set_log_level(config_.log_level);
    log_info({Event::reloaded}, "reloaded: {}, quiet after {} s, log level {}",
             counted(static_cast<std::uint64_t>(config_.worker_count()), "worker"),
             std::chrono::duration<double>(config_.quiet).count(), config_.log_level);
}

void Service::collect() {
    for (const Finished& finished : pool_.collect()) {
        if (status_.add(finished)) report(finished);
        intake_.job_ended(finished);
        status_file_.changed();
    }
    for (const Finished& noted : registrar_.collect()) {
        const bool is_gone =
            noted.taken && noted.taken->ingest.result == pipeline::IngestResult::vanished;
        if (is_gone) status_.add(noted);
        intake_.registered(noted);
    }
}

void Service::scan_if_due() {
    const SteadyTime now = parts_.clock.steady();
    if (now >= next_scan_ || (intake_.needs_scan() && now >= rested_)) scan();
}

void Service::note_drop(const Status& scanned) {
    if (!scanned && !drop_missing_) {
        log_error({Event::drop_lost}, "drop directory {}; looking again every {} s",
                  printable(scanned.error().message),
                  std::chrono::duration<double>(config_.rescan).count());
    } else if (scanned && drop_missing_) {
        log_info({Event::drop_back}, "drop directory {} is back", printable(config_.drop.native()));
    }
    drop_missing_ = !scanned;
    drop_problem_ = scanned ? std::string{} : scanned.error().message;
    status_.set_drop_lost(scanned ? std::string{} : printable(scanned.error().message));
}

// Called between two parts of long work: a scan of many files takes seconds, a burst of events a
// tenth of a second.
void Service::keep_workers_busy() {
    collect();
    start_jobs();
}

void Service::scan() {
    const SteadyTime began = parts_.clock.steady();
    const bool is_poll = watcher_.is_blind() && !intake_.needs_scan() && began < next_rescan_;
    intake_.begin_scan();
    const Status scanned = watcher_.scan();
    intake_.end_scan(scanned.has_value());
    note_drop(scanned);
    if (scanned && !is_poll) row_keeper_.look(began, config_.gone_kept);
    status_.count_scan();
    status_file_.changed();
    const SteadyTime ended = parts_.clock.steady();
    rested_ = ended + std::max<SteadyTime::duration>(least_scan_gap, scan_rest * (ended - began));
    if (!is_poll) next_rescan_ = ended + config_.rescan;
    auto gap = watcher_.is_blind() ? std::min(config_.poll, config_.rescan) : config_.rescan;
    if (!scanned && !readiness_.is_ready())
        gap = std::min<std::chrono::milliseconds>(gap, between_first_scans);
    next_scan_ = std::max(ended + gap, rested_);
}

void Service::start_jobs() {
    if (registrar_.has_free_worker()) {
        if (std::optional<Job> job = intake_.next_unregistered()) {
            registrar_.submit(std::move(*job));
        }
    }
    while (pool_.has_free_worker()) {
        std::optional<Job> job = intake_.next_job();
        if (!job) return;
        pool_.submit(std::move(*job));
        status_file_.changed();
    }
}

void Service::keep_house() {
    const SteadyTime now = parts_.clock.steady();
    if (const std::uint64_t overflows = intake_.take_overflows(); overflows > 0) {
        for (std::uint64_t i = 0; i < overflows; ++i)
            status_.count_overflow();
        log_warning({Event::overflow},
                    "the kernel dropped events (fs.inotify.max_queued_events): scanning");
    }
    keep_state(now);
    status_.count_unseen(intake_.take_unseen());
    report_repairs();
    report_catalog(now);
    report_backlog(now);
    report_sites();
    for (const Error& problem : intake_.take_directory_problems())
        Reporter::report_directory(problem);
    if (now >= next_memory_look_) {
        next_memory_look_ = now + between_memory_looks;
        (void)give_back_freed_memory(most_kept_bytes(config_.worker_count()));
    }
    if (now >= next_held_back_) {
        next_held_back_ = now + between_held_back;
        log_held_back();
    }
    if (const auto usage = cache_keeper_.poll(now, config_.budgets)) {
        status_.set_usage(*usage);
        status_file_.changed();
    }
    if (auto loops = loop_keeper_.news()) {
        status_.set_loops(std::move(*loops));
        status_file_.changed();
    }
    look_at_others_loops(now);
    publish(false);
    feed(watchdog_, parts_.notifier, now, oldest_step());
}

Stopped Service::stop() {
    idle_ = false;
    parts_.notifier.send("STOPPING=1");
    status_.set_state("stopping");
    publish(true);
    loop_keeper_.stop();
    const auto until = std::chrono::steady_clock::now() + time_to_drain;
    bool drained = pool_.drain(time_to_drain);
    drained = registrar_.drain(std::max(std::chrono::milliseconds{0},
                                        std::chrono::duration_cast<std::chrono::milliseconds>(
                                            until - std::chrono::steady_clock::now()))) &&
              drained;
    loop_keeper_.wait();
    if (auto loops = loop_keeper_.news()) status_.set_loops(std::move(*loops));
    collect();
    const std::size_t left = intake_.pending().waiting;
    log_all_held_back();
    if (!drained) {
        log_error({Event::stopped_with_jobs}, "stopped with files still being read after {} s",
                  time_to_drain.count());
        return Stopped::with_jobs;
    }
    status_.set_state("stopped");
    publish(true);
    log_info({Event::stopped}, "stopped: {} ingested, {} left for the next start",
             counted(status_.ingested(), "file"), left);
    return Stopped::cleanly;
}

}  // namespace stormcellar::daemon
