#include "daemon/loops/loops_service.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/counted.h"
#include "base/printable.h"
#include "daemon/log/log.h"
#include "daemon/process/main_loop.h"
#include "daemon/status/status.h"
#include "service/program.h"

namespace stormcellar::daemon {
namespace {

constexpr std::chrono::seconds longest_wait{10};

}  // namespace

LoopsService::LoopsService(Config config, std::filesystem::path config_file, Parts parts)
    : config_(std::move(config)),
      config_file_(std::move(config_file)),
      parts_(parts),
      watchdog_(parts_.notifier.watchdog()),
      status_file_(parts_.file_system, directory(config_), parts_.notifier),
      keeper_(config_.fixed.paths.cache, [this] { wake_up_.set(); }) {
    pulses_.watch("loops", keeper_.pulse());
}

std::filesystem::path LoopsService::directory(const Config& config) {
    return config.fixed.paths.state / "loops";
}

void LoopsService::request_stop() {
    stop_requested_ = true;
    wake_up_.set();
}

void LoopsService::run() {
    publish("running", true);
    parts_.notifier.send("READY=1");
    log_info({Event::ready}, "ready: running {} on the cache {}",
             counted(config_.reloadable.loops.size(), "loop"),
             printable(config_.fixed.paths.cache.native()));
    keeper_.set(config_.reloadable.loops);
    while (true) {
        handle_signals();
        if (stop_requested_) break;
        wake_up_.clear();
        const SteadyTime now = std::chrono::steady_clock::now();
        if (auto loops = keeper_.news()) {
            loops_ = std::move(*loops);
            status_file_.changed();
        }
        publish("running", false);
        log_held_back();
        feed(watchdog_, parts_.notifier, now, pulses_.oldest());
        wait(now);
    }
    parts_.notifier.send("STOPPING=1");
    keeper_.stop();
    keeper_.wait();
    if (auto loops = keeper_.news()) loops_ = std::move(*loops);
    publish("stopped", true);
    log_all_held_back();
    log_info({Event::stopped}, "stopped");
}

void LoopsService::wait(SteadyTime now) {
    SteadyTime until = now + longest_wait;
    if (const auto due = status_file_.next_time()) until = std::min(until, *due);
    if (const auto due = watchdog_.next_time()) until = std::min(until, *due);
    std::array<pollfd, 2> sources = {
        pollfd{wake_up_.descriptor(), POLLIN, 0},
        {parts_.signals == nullptr ? -1 : parts_.signals->descriptor(), POLLIN, 0}};
    poll_until(sources, now, until);
}

void LoopsService::handle_signals() {
    if (take_signals(parts_.signals, [this] { reload(); })) stop_requested_ = true;
}

void LoopsService::reload() {
    parts_.notifier.send(reloading_state());
    if (const Result<Config> fresh = load_config(config_file_)) {
        const PathsConfig& asked = fresh->fixed.paths;
        const PathsConfig& used = config_.fixed.paths;
        if (asked.state != used.state || asked.cache != used.cache) {
            log_warning({Event::reload_ignored},
                        "reload: restart the service for the change of [paths] to take effect");
        }
        config_.reloadable = fresh->reloadable;
        keeper_.set(config_.reloadable.loops);
        set_log_level(config_.reloadable.log_level);
        log_info({Event::reloaded}, "reloaded: the configuration now has {}",
                 counted(config_.reloadable.loops.size(), "loop"));
    } else {
        log_error({Event::reload_failed},
                  "reload failed: {}; the service keeps its previous configuration",
                  printable(fresh.error().message));
    }
    parts_.notifier.send("READY=1");
}

void LoopsService::publish(const char* state, bool force) {
    const auto texts = [&] {
        return StatusFile::Texts{loops_line(loops_),
                                 loops_json(loops_, state, started_, now_utc())};
    };
    (void)status_file_.publish(texts, std::chrono::steady_clock::now(), force);
}

}  // namespace stormcellar::daemon
