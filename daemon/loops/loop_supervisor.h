// daemon/loops/loop_supervisor.h -- keeps animations up to date by running `stormcellar loop
// --follow` for each of them.
//
// A loop runs as a separate program, so that a fault in drawing never stops ingest. If the program
// ends, the supervisor logs its exit status and its last line on stderr, and starts it again. The
// first restart comes after 1 s; the delay doubles with each restart, up to 60 s. After a run of at
// least a minute, the delay is 1 s again. The programs end with the daemon, however the daemon
// ends. The supervisor has one thread, which it starts only if there are loops.
//
// Threads   One thread at a time. `wake` is called from the supervisor's own thread and must only
//           signal.
#pragma once

#include <atomic>
#include <functional>
#include <list>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/steady_time.h"
#include "daemon/config/loop_config.h"
#include "daemon/process/wake_up.h"
#include "daemon/watch/file_stamp.h"
#include "service/child.h"
#include "service/pulse.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::daemon {

class LoopSupervisor {
  public:
    // Runs `program`; empty: the stormcellar beside this program or on PATH.
    LoopSupervisor(std::filesystem::path cache, std::function<void()> wake,
                   std::filesystem::path program = {});
    LoopSupervisor(const LoopSupervisor&) = delete;
    LoopSupervisor& operator=(const LoopSupervisor&) = delete;
    ~LoopSupervisor();

    // Sets the loops to run. If neither a loop nor its scene file has changed, the loop goes on
    // undisturbed.
    void set(std::vector<LoopConfig> loops);
    // Tells all programs to end, and returns at once. wait() and the destructor wait until the
    // programs have ended, for a few seconds at most.
    void stop();
    void wait();
    // Returns the pulse of the supervisor's thread; it is at rest if there is no thread.
    [[nodiscard]] const Pulse& pulse() const { return pulse_; }
    // Returns the states of all loops if a state has changed since the last call, else none.
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
    Mutex mutex_;
    std::optional<std::vector<LoopConfig>> wanted_ STORMCELLAR_GUARDED_BY(mutex_);
    std::vector<LoopState> states_ STORMCELLAR_GUARDED_BY(mutex_);
    bool is_news_ STORMCELLAR_GUARDED_BY(mutex_) = false;
    std::thread thread_;  // the last member: it uses the members above
};

}  // namespace stormcellar::daemon
