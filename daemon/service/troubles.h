// daemon/service/troubles.h -- what can be wrong for a while: the log says so once when it begins
// and once when it is over, the status as long as it lasts.
//
// Each class remembers whether its trouble stands in the log, and looks at most as often as its
// source names: look() may be called at every turn of the service.
// Thread contract: the service's thread.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "daemon/care/state_keeper.h"
#include "daemon/config/loop_config.h"
#include "daemon/queue/intake.h"
#include "daemon/queue/sink.h"
#include "daemon/status/status.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

// The drop directory cannot be read.
class DropTrouble {
  public:
    // What a scan of it gave; it is scanned again after `rescan`.
    void scanned(const Status& scanned, const std::filesystem::path& drop,
                 std::chrono::milliseconds rescan, StatusBook& status);
    // The trouble as an error; that of not having been looked at is none.
    [[nodiscard]] Status is_over() const;

  private:
    bool is_lost_ = false;
    std::string why_;
};

// The state directory was deleted, and cannot be made again.
class StateTrouble {
  public:
    // True when it was made again: files that could not be stored meanwhile are tried again.
    bool look(SteadyTime now, StateKeeper& keeper, const std::filesystem::path& state);

  private:
    SteadyTime next_{};
    bool is_lost_ = false;
};

// A database that cannot be used.
class CatalogTrouble {
  public:
    // True when the status has news of it.
    bool look(SteadyTime now, Sink& sink, StatusBook& status);
    // The next call of look() is not too early: a file could not be stored.
    void look_soon() { next_ = {}; }

  private:
    SteadyTime next_{};
};

// More comes than can be taken in. While it lasts the log says so once a minute.
class BacklogTrouble {
  public:
    void look(SteadyTime now, const Intake& intake, StatusBook& status);

  private:
    SteadyTime next_{}, next_line_{};
    bool is_behind_ = false;
};

// Two processes keep the loops; or, where it is another one alone, what it says of them.
class OthersLoops {
  public:
    // `runs_loops`: this process keeps them. True when the status has news of them.
    bool look(SteadyTime now, const std::filesystem::path& state,
              const std::vector<LoopConfig>& loops, bool runs_loops, StatusBook& status);

  private:
    SteadyTime next_{};
    bool are_kept_twice_ = false;
};

}  // namespace stormcellar::daemon
