#include "daemon/loops/loop_supervisor.h"

#include <algorithm>
#include <csignal>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "base/counted.h"
#include "base/printable.h"
#include "base/spawn.h"
#include "daemon/log/log.h"
#include "daemon/process/main_loop.h"
#include "daemon/queue/schedule.h"

namespace stormcellar::daemon {
namespace {

constexpr std::chrono::seconds time_to_end{3};    // a program that runs longer is killed
constexpr std::chrono::minutes long_enough{1};    // a loop that has run this long counts as stable
constexpr std::chrono::seconds longest_rest{60};  // the longest sleep if nothing happens
constexpr double most_frames = 1e9;               // fits in an int

// A scene may be a symbolic link, unlike a raw file.
FileStamp stamp_of_scene(const std::filesystem::path& scene) {
    struct stat facts {};
    if (scene.empty() || ::stat(scene.c_str(), &facts) != 0) return {};
    return stamp_of(facts);
}

}  // namespace

LoopSupervisor::LoopSupervisor(std::filesystem::path cache, std::function<void()> wake,
                               std::filesystem::path program)
    : cache_(std::move(cache)), wake_(std::move(wake)), program_(std::move(program)) {}

LoopSupervisor::~LoopSupervisor() {
    stop();
    wait();
}

void LoopSupervisor::set(std::vector<LoopConfig> loops) {
    if (loops.empty() && !thread_.joinable()) return;
    {
        const MutexLock lock(mutex_);
        wanted_ = std::move(loops);
    }
    wake_up_.set();
    if (thread_.joinable()) return;
    try {
        thread_ = std::thread([this] { run(); });
    } catch (const std::system_error& error) {  // the system has no thread left
        log_error({Event::loop_failed}, "cannot run loops: {}", error.what());
    }
}

void LoopSupervisor::stop() {
    stopping_ = true;
    wake_up_.set();
}

void LoopSupervisor::wait() {
    if (thread_.joinable()) thread_.join();
}

std::optional<std::vector<LoopState>> LoopSupervisor::news() {
    const MutexLock lock(mutex_);
    if (!std::exchange(is_news_, false)) return std::nullopt;
    return states_;
}

void LoopSupervisor::run() {
    while (true) {
        const SteadyTime now = std::chrono::steady_clock::now();
        pulse_.beat(now);
        wake_up_.clear();
        for (Slot& slot : slots_)
            listen(slot, now);
        take_wanted();
        if (stopping_) {
            for (Slot& slot : slots_)
                dismiss(slot, now);
        }
        slots_.remove_if([](const Slot& slot) { return slot.is_leaving && !slot.child; });
        if (stopping_ && slots_.empty()) break;
        start_due(now);
        publish();
        pulse_.rest();
        sleep(now);
    }
    publish();
    pulse_.rest();
}

void LoopSupervisor::take_wanted() {
    std::optional<std::vector<LoopConfig>> loops;
    {
        const MutexLock lock(mutex_);
        loops = std::exchange(wanted_, std::nullopt);
    }
    if (!loops) return;
    const SteadyTime now = std::chrono::steady_clock::now();
    std::vector<Wanted> all;
    for (LoopConfig& loop : *loops) {
        const FileStamp stamp = stamp_of_scene(loop.scene);
        all.push_back({std::move(loop), stamp});
    }
    for (Slot& slot : slots_) {
        const auto same = std::find(all.begin(), all.end(), slot.wanted);
        if (same == all.end()) {
            dismiss(slot, now);
        } else if (!slot.is_leaving) {
            all.erase(same);
        }
    }
    for (Wanted& wanted : all) {
        Slot& slot = slots_.emplace_back();
        slot.state.name = wanted.loop.name;
        slot.wanted = std::move(wanted);
    }
}

void LoopSupervisor::dismiss(Slot& slot, SteadyTime now) {
    if (slot.is_leaving) return;
    slot.is_leaving = true;
    if (!slot.child) return;
    slot.child->signal(SIGTERM);
    slot.kill_at = now + time_to_end;
}

void LoopSupervisor::start_due(SteadyTime now) {
    for (Slot& slot : slots_) {
        if (slot.child || slot.is_leaving || now < slot.not_before) continue;
        // A loop must wait until the old process of the same name has ended.
        const bool waits = std::any_of(slots_.begin(), slots_.end(), [&](const Slot& other) {
            return other.is_leaving && other.state.name == slot.state.name;
        });
        if (!waits) start(slot, now);
    }
}

void LoopSupervisor::start(Slot& slot, SteadyTime now) {
    const std::filesystem::path program = program_.empty() ? find_program("stormcellar") : program_;
    Result<Child> child = fail(ErrorCode::not_found,
                               "there is no program stormcellar beside stormcellard or on PATH");
    if (!program.empty()) {
        child = Child::start(program, arguments_of(slot.wanted.loop, cache_, ::getpid()));
    }
    slot.started = now;
    slot.last_line.clear();
    if (!child) {
        slot.state.last_problem = printable(child.error().message);
        delay(slot, now);
        log_error({.event = Event::loop_failed, .loop = slot.state.name},
                  "loop {}: cannot be started: {}; trying again in {} s", slot.state.name,
                  slot.state.last_problem, Schedule::retry_delay(slot.failures).count());
        return;
    }
    if (slot.failures > 0) ++slot.state.restarts;
    slot.child = std::move(*child);
    slot.state.is_running = true;
    log_info({.event = Event::loop_started, .loop = slot.state.name},
             "loop {}: started as process {}", slot.state.name, slot.child->id());
}

void LoopSupervisor::listen(Slot& slot, SteadyTime now) {
    if (!slot.child) return;
    if (slot.kill_at && now >= *slot.kill_at) {
        slot.child->signal(SIGKILL);
        slot.kill_at.reset();
    }
    const std::string how = slot.child->ended();  // call first: once the program has ended, all of
                                                  // its output is available
    for (const std::string& line : slot.child->out.read())
        note_made(slot, line);
    for (const std::string& line : slot.child->err.read())
        note_line(slot, line);
    if (!how.empty()) note_end(slot, how, now);
}

// Reads a line of the program's output: a JSON document about an animation that the program made.
void LoopSupervisor::note_made(Slot& slot, const std::string& line) {
    const auto document = nlohmann::json::parse(line, nullptr, false);
    if (!document.is_object()) return;
    const auto number = [&](const char* key) {
        const auto found = document.find(key);
        return found != document.end() && found->is_number() ? found->get<double>() : 0.0;
    };
    ++slot.state.made;
    slot.last_line.clear();  // a line about this animation does not tell why the program ends later
    slot.state.last_made = now_utc();
    slot.state.frames = static_cast<int>(std::clamp(number("frames"), 0.0, most_frames));
    const double took_s = number("total_s");
    log_info({.event = Event::loop_made, .took_s = took_s, .loop = slot.state.name},
             "loop {}: made from {} in {:.1f} s", slot.state.name,
             counted(static_cast<std::uint64_t>(slot.state.frames), "frame"), took_s);
}

void LoopSupervisor::note_line(Slot& slot, const std::string& line) {
    constexpr std::string_view speaker = "stormcellar: ";
    slot.last_line = printable(line.starts_with(speaker) ? line.substr(speaker.size()) : line);
    const bool is_note = slot.last_line.starts_with("note: ");
    log_line(is_note ? LogLevel::info : LogLevel::warning,
             {.event = Event::loop_said, .loop = slot.state.name},
             fmt::format("loop {}: {}", slot.state.name, slot.last_line));
}

void LoopSupervisor::note_end(Slot& slot, const std::string& how, SteadyTime now) {
    slot.child.reset();
    slot.kill_at.reset();
    slot.state.is_running = false;
    if (slot.is_leaving) {
        log_info({.event = Event::loop_ended, .loop = slot.state.name},
                 "loop {}: ended as requested", slot.state.name);
        return;
    }
    if (now - slot.started >= long_enough) slot.failures = 0;
    delay(slot, now);
    // If a signal ended the program, its last line does not tell the reason.
    const bool was_killed = how.starts_with("signal");
    slot.state.last_problem =
        was_killed || slot.last_line.empty() ? how : fmt::format("{}: {}", how, slot.last_line);
    log_error({.event = Event::loop_failed, .loop = slot.state.name},
              "loop {}: ended with {}; starting it again in {} s", slot.state.name,
              slot.state.last_problem, Schedule::retry_delay(slot.failures).count());
}

void LoopSupervisor::delay(Slot& slot, SteadyTime now) {
    ++slot.failures;
    slot.not_before = now + Schedule::retry_delay(slot.failures);
}

void LoopSupervisor::sleep(SteadyTime now) {
    SteadyTime until = now + longest_rest;
    std::vector<pollfd> sources{{wake_up_.descriptor(), POLLIN, 0}};
    for (const Slot& slot : slots_) {
        if (slot.child) {
            for (const int descriptor : {slot.child->descriptor(), slot.child->out.descriptor(),
                                         slot.child->err.descriptor()}) {
                sources.push_back({descriptor, POLLIN, 0});  // -1 is ignored
            }
            if (slot.kill_at) until = std::min(until, *slot.kill_at);
        } else if (!slot.is_leaving) {
            until = std::min(until, std::max(now, slot.not_before));
        }
    }
    poll_until(sources, std::chrono::steady_clock::now(), until);
}

void LoopSupervisor::publish() {
    std::vector<LoopState> states;
    for (const Slot& slot : slots_) {
        if (!slot.is_leaving) states.push_back(slot.state);
    }
    {
        const MutexLock lock(mutex_);
        if (states == states_) return;
        states_ = std::move(states);
        is_news_ = true;
    }
    wake_();
}

}  // namespace stormcellar::daemon
