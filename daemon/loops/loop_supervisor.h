// daemon/loops/loop_supervisor.h -- keeps animations up to date by running `stormcellar loop
// --follow` for each.
//
// A loop runs as another program, so that nothing that goes wrong with a picture stops ingest. If a
// program ends by itself, the supervisor logs its status and its last line on stderr, and starts it
// again: 1 s later at first, doubling to 60 s, and from 1 s again after it ran for a minute. The
// programs end with the daemon, however that ends. All of this happens in one thread, which exists
// only if there are loops. Thread contract: one thread. `wake` is called from the supervisor's own
// thread, and must only signal.
#pragma once

#include <atomic>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/steady_time.h"
#include "daemon/config/loop_config.h"
#include "daemon/process/child.h"
#include "daemon/process/pulse.h"
#include "daemon/process/wake_up.h"
#include "daemon/watch/file_stamp.h"

namespace stormcellar::daemon {

class LoopSupervisor {
  public:
    // Runs `program`; if it is empty, stormcellar, beside this program or on PATH.
    LoopSupervisor(std::filesystem::path cache, std::function<void()> wake,
                   std::filesystem::path program = {});
    LoopSupervisor(const LoopSupervisor&) = delete;
    LoopSupervisor& operator=(const LoopSupervisor&) = delete;
    ~LoopSupervisor();

    // Sets the loops to run. A loop continues undisturbed if neither it nor its scene file has
    // changed.
    void set(std::vector<LoopConfig> loops);
    // Asks all programs to end, without waiting; the destructor or wait() waits, a few seconds at
    // most.
    void stop();
    void wait();
    // The pulse of its thread; it rests if there is no thread.
    [[nodiscard]] const Pulse& pulse() const { return pulse_; }
    // What has changed since the last call; none if nothing has.
    std::optional<std::vector<LoopState>> news();

  private:
    struct Wanted {
        LoopConfig loop;
        FileStamp scene;
        bool operator==(const Wanted&) const = default;
    };
    struct Slot {
        Wanted wanted;
        LoopState state;
        std::optional<Child> child;
        SteadyTime started{}, not_before{};
        int failures = 0;
        std::string last_line;
        bool is_leaving = false;
        std::optional<SteadyTime> kill_at;
    };
    void run();
    void take_wanted();
    void dismiss(Slot& slot, SteadyTime now);
    void start_due(SteadyTime now);
    void start(Slot& slot, SteadyTime now);
    void listen(Slot& slot, SteadyTime now);
    void note_made(Slot& slot, const std::string& line);
    static void note_line(Slot& slot, const std::string& line);
    void note_end(Slot& slot, const std::string& how, SteadyTime now);
    void delay(Slot& slot, SteadyTime now);
    void sleep(SteadyTime now);
    void publish();

    std::filesystem::path cache_;
    std::function<void()> wake_;
    std::filesystem::path program_;
    WakeUp wake_up_;
    std::atomic<bool> stopping_ = false;
    Pulse pulse_;
    std::list<Slot> slots_;  // used only by the thread
    std::mutex mutex_;
    std::optional<std::vector<LoopConfig>> wanted_;  // guarded by mutex_, like the next two
    std::vector<LoopState> states_;
    bool is_news_ = false;
    std::thread thread_;  // the last member: the thread uses the members above
};

}  // namespace stormcellar::daemon
