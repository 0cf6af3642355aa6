#include "daemon/service/service.h"

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include "base/counted.h"
#include "base/memory.h"
#include "base/printable.h"
#include "daemon/log/log.h"
#include "daemon/process/main_loop.h"
#include "service/program.h"

namespace stormcellar::daemon {
namespace {

constexpr std::chrono::seconds longest_sleep{10};
constexpr std::chrono::seconds time_to_drain{20};
constexpr std::chrono::seconds between_held_back{1};
constexpr std::chrono::milliseconds between_memory_looks{250};
// Time between searches for a missing drop directory.
constexpr std::chrono::seconds between_drop_looks{1};

// If the live file whose job began last waited longer than this, ended volumes are late.
constexpr std::chrono::milliseconds most_live_wait{100};

// Returns how many bytes of free memory the process keeps for reuse; it gives further free memory
// back to the system. Decoding and gridding volumes one after another leaves less free memory than
// this. If the process kept too little, a tenth of the time would go into new pages for each
// volume.
constexpr std::size_t most_kept_bytes(int workers) {
    return (32 + 64 * static_cast<std::size_t>(workers)) << 20U;
}

Result<Taken> take(Sink& sink, const Job& job) {
    const bool is_last = job.failures + 1 >= Intake::most_tries;
    return sink.take(job.path, job.finish_as_is,
                     is_last ? pipeline::Tries::last : pipeline::Tries::more_follow);
}

Result<Taken> note(Sink& sink, const Job& job) {
    const auto noted = sink.note(job.path);
    if (!noted) return pass_on(noted);
    Taken taken;
    if (*noted == pipeline::Noted::gone) {
        taken.ingest.ending = pipeline::ended::Vanished{};
    } else {
        taken.ingest.ending = pipeline::ended::Registered{};
    }
    return taken;
}

}  // namespace

void Service::hold_back(const std::map<std::filesystem::path, std::chrono::seconds>& waits) {
    for (const auto& [path, wait] : waits)
        log_warning({.event = Event::held_back, .file = path},
                    "{} was being read when the service ended; it waits {} s",
                    printable(path.native()), wait.count());
    intake_.hold_back(waits);
}

Service::Service(const Config& config, std::filesystem::path config_file, ServiceParts parts)
    : fixed_(config.fixed),
      config_(config.reloadable),
      config_file_(std::move(config_file)),
      parts_(std::move(parts)),
      intake_(config, parts_.clock),
      watcher_(fixed_.paths.drop, parts_.events, intake_),
      status_(fixed_.paths.drop, fixed_.paths.cache),
      status_file_(parts_.file_system, fixed_.paths.state, parts_.notifier),
      watchdog_(parts_.notifier.watchdog()),
      pool_([this](const Job& job) { return take(parts_.sink, job); }, "ingest",
            config_.worker_count(), [this] { wake_up_.set(); }),
      registrar_([this](const Job& job) { return note(parts_.sink, job); }, "register", 1,
                 [this] { wake_up_.set(); }),
      row_keeper_(parts_.sink),
      cache_keeper_(parts_.sink, [this] { wake_up_.set(); }),
      loop_keeper_(fixed_.paths.cache, [this] { wake_up_.set(); }) {
    need([this] { return can_write_in(parts_.file_system, fixed_.paths.state); });
    need([this] { return parts_.sink.can_store(); });
    hold_back(parts_.sink.waits());
    watcher_.on_step([this] { keep_workers_busy(); });
    status_.set_listening(parts_.socket, fixed_.status.http_port);
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
    if (parts_.runs_loops) loop_keeper_.set(config_.loops);
}

// Reports READY once the service is ready. If that takes longer than TimeoutStartSec, systemd
// starts the service again, so that the boot of the machine does not wait forever for a missing
// disk.
void Service::get_ready() {
    if (!readiness_.look(parts_.clock.steady())) return;
    if (!readiness_.is_ready()) {
        parts_.notifier.send("STATUS=waiting: " + printable(readiness_.missing()));
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
    const bool is_lost = !status_.facts().drop_lost.empty();
    log_info({Event::ready}, "ready: {} {} ({}) with {}; {} to look at",
             is_lost ? "waiting for" : "watching", printable(fixed_.paths.drop.native()),
             counted(watcher_.directory_count(), "directory", "directories"),
             counted(static_cast<std::uint64_t>(config_.worker_count()), "worker"),
             counted(pending.waiting + pending.growing, "file"));
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
    idle_ = intake_.pending().waiting == 0;
    parts_.sink.set_load(load());
}

pipeline::Load Service::load() const {
    if (intake_.pending().waiting <= static_cast<std::size_t>(config_.worker_count()))
        return pipeline::Load::light;
    return intake_.last_wait() > most_live_wait ? pipeline::Load::late : pipeline::Load::heavy;
}

SteadyTime Service::next_time() const {
    SteadyTime time = std::min(
        {parts_.clock.steady() + longest_sleep, scan_times_.next(), cache_keeper_.next_time()});
    const auto work = intake_.next_time(pool_.has_free_worker(), registrar_.has_free_worker());
    for (const auto& due :
         {work, status_file_.next_time(), watchdog_.next_time(), readiness_.next_time()}) {
        if (due) time = std::min(time, *due);
    }
    if (intake_.needs_scan()) time = std::min(time, scan_times_.rested());
    if (const auto again = intake_.look_again_at())
        time = std::min(time, std::max(*again, scan_times_.rested()));
    return time;
}

void Service::wait() {
    std::array<pollfd, 3> sources = {
        pollfd{wake_up_.descriptor(), POLLIN, 0},
        {parts_.events.descriptor(), POLLIN, 0},
        {parts_.signals == nullptr ? -1 : parts_.signals->descriptor(), POLLIN, 0}};
    poll_until(sources, parts_.clock.steady(), next_time());
}

void Service::handle_signals() {
    if (take_signals(parts_.signals, [this] { reload(); })) stop_requested_ = true;
}

void Service::reload() {
    parts_.notifier.send(reloading_state());
    if (const Result<Config> fresh = load_config(config_file_)) {
        apply(*fresh);
    } else {
        log_error({Event::reload_failed},
                  "reload failed: {}; the service keeps its previous configuration",
                  printable(fresh.error().message));
    }
    // If the service is not ready yet, it reports READY later.
    if (readiness_.is_ready()) parts_.notifier.send("READY=1");
}

void Service::apply(const Config& fresh) {
    const auto& [fixed, reloadable] = fresh;  // both parts of the configuration
    for (const std::string& sentence : needs_restart(fixed, fixed_))
        log_warning({Event::reload_ignored}, "reload: {}", sentence);
    if (reloadable.budgets != config_.budgets) cache_keeper_.roll_soon();
    config_ = reloadable;
    if (parts_.runs_loops) loop_keeper_.set(reloadable.loops);
    pool_.resize(reloadable.worker_count());
    intake_.reload(reloadable);
    scan_times_.no_later_than(parts_.clock.steady() + reloadable.rescan);
    set_log_level(reloadable.log_level);
    log_info({Event::reloaded},
             "reloaded: the configuration now has {}, quiet_seconds {} and log level {}",
             counted(static_cast<std::uint64_t>(reloadable.worker_count()), "worker"),
             std::chrono::duration<double>(reloadable.quiet).count(), reloadable.log_level);
}

void Service::collect() {
    for (const Finished& finished : pool_.collect()) {
        if (status_.add(finished)) report(finished);
        intake_.job_ended(finished);
        status_file_.changed();
    }
    for (const Finished& noted : registrar_.collect()) {
        const bool is_gone =
            noted.taken && noted.taken->ingest.result() == pipeline::IngestResult::vanished;
        if (is_gone) status_.add(noted);
        intake_.registered(noted);
    }
}

void Service::scan_if_due() {
    if (scan_times_.is_due(parts_.clock.steady(), intake_.needs_scan())) scan();
}

// Starts waiting jobs. Long work calls this now and then: a scan of many files takes seconds, and a
// burst of events a tenth of a second.
void Service::keep_workers_busy() {
    collect();
    start_jobs();
}

void Service::scan() {
    const SteadyTime began = parts_.clock.steady();
    const bool is_poll =
        watcher_.is_blind() && !intake_.needs_scan() && !scan_times_.is_regular(began);
    intake_.begin_scan();
    const Status scanned = watcher_.scan();
    intake_.end_scan(scanned.has_value());
    drop_trouble_.scanned(scanned, fixed_.paths.drop, status_);
    note_unreadable();
    if (scanned && !is_poll) row_keeper_.look(began, config_.gone_rows_kept_for);
    status_.count_scan();
    status_file_.changed();
    const SteadyTime ended = parts_.clock.steady();
    if (!is_poll) scan_times_.set_next_regular(ended + config_.rescan);
    auto gap = watcher_.is_blind() ? std::min(config_.poll, config_.rescan) : config_.rescan;
    if (!scanned) gap = std::min<std::chrono::milliseconds>(gap, between_drop_looks);
    scan_times_.scanned(began, ended, gap);
}

void Service::note_unreadable() {
    if (status_.set_unreadable(watcher_.unreadable())) status_file_.changed();
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

void Service::look_for_troubles(SteadyTime now) {
    if (parts_.state != nullptr && state_trouble_.look(now, *parts_.state, fixed_.paths.state))
        status_file_.changed();
    const std::vector<std::string> repairs = parts_.sink.take_repairs();
    for (const std::string& line : repairs)
        log_error({Event::database_mended}, "{}", printable(line));
    if (!repairs.empty()) intake_.forget_seen();
    look_at_catalog(now);
    backlog_trouble_.look(now, intake_, status_);
    const bool has_news =
        others_loops_.look(now, fixed_.paths.state, config_.loops, parts_.runs_loops, status_);
    if (has_news) status_file_.changed();
}

void Service::look_at_catalog(SteadyTime now) {
    if (catalog_trouble_.look(now, parts_.sink, status_)) status_file_.changed();
}

// Reports a job. If a job failed because a database is in trouble, logs only the trouble, and only
// once.
void Service::report(const Finished& finished) {
    if (!finished.taken) {
        catalog_trouble_.look_soon();
        look_at_catalog(parts_.clock.steady());
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
        const MutexLock lock(compared_mutex_);
        compared_.push_back(std::move(report));
    }
    wake_up_.set();
}

void Service::report_sites() {
    std::vector<pipeline::PairReport> reports;
    {
        const MutexLock lock(compared_mutex_);
        reports.swap(compared_);
    }
    for (pipeline::PairReport& report : reports) {
        Reporter::report_sites(report);
        status_.add(std::move(report));
        status_file_.changed();
    }
}

void Service::keep_house() {
    const SteadyTime now = parts_.clock.steady();
    if (const std::uint64_t overflows = intake_.take_overflows(); overflows > 0) {
        for (std::uint64_t i = 0; i < overflows; ++i)
            status_.count_overflow();
        log_warning({Event::overflow},
                    "the kernel dropped file events because their queue was full "
                    "(fs.inotify.max_queued_events); scanning the drop directory instead");
    }
    status_.count_unseen(intake_.take_unseen());
    look_for_troubles(now);
    report_sites();
    for (const Error& problem : intake_.take_directory_problems())
        Reporter::report_directory(problem);
    note_unreadable();
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
    if (parts_.machines) {
        auto machines = parts_.machines();
        if (machines != status_.facts().machines) {
            status_.set_machines(std::move(machines));
            status_file_.changed();
        }
    }
    publish(false);
    feed(watchdog_, parts_.notifier, now, oldest_step());
}

void Service::publish(bool at_once) {
    const Pending pending = intake_.pending();
    if (pending != published_) status_file_.changed();
    published_ = pending;
    const std::size_t directories = watcher_.directory_count();
    if (directories != status_.facts().directories) status_file_.changed();
    status_.set_directories(directories);
    const auto texts = [&] {
        return StatusFile::Texts{status_.line(pending), status_.json(pending, now_utc())};
    };
    if (!status_file_.publish(texts, parts_.clock.steady(), at_once)) return;
    if (parts_.board != nullptr) parts_.board->post(status_.facts(), pending);
}

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
        log_error(
            {Event::stopped_with_jobs},
            "stopped while files were still being read after {} s; the next start reads them again",
            time_to_drain.count());
        return Stopped::with_jobs;
    }
    status_.set_state("stopped");
    publish(true);
    log_info({Event::stopped}, "stopped: ingested {}, left {} for the next start",
             counted(status_.ingested(), "file"), left);
    return Stopped::cleanly;
}

}  // namespace stormcellar::daemon
