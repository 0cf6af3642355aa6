// daemon/service/troubles.h -- watches for troubles that may last for a while. The log reports most
// troubles when they begin and when they are over; the status shows a trouble as long as it lasts.
//
// Each class remembers whether the log has reported its trouble. The service may call look() at
// every turn, because each class limits how often it really checks. Thread contract: the service's
// thread.
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

// The trouble that the drop directory cannot be read.
class DropTrouble {
  public:
    // Notes the result of a scan.
    void scanned(const Status& scanned, const std::filesystem::path& drop, StatusBook& status);

  private:
    bool is_lost_ = false;
};

// The trouble that the state directory was deleted and cannot be made again.
class StateTrouble {
  public:
    // Returns true if the directory was made again.
    bool look(SteadyTime now, StateKeeper& keeper, const std::filesystem::path& state);

  private:
    SteadyTime next_{};
    bool is_lost_ = false;
};

// The trouble that a database cannot be used.
class CatalogTrouble {
  public:
    // Returns true if the status changed.
    bool look(SteadyTime now, Sink& sink, StatusBook& status);
    // Makes the next look() check at once. Call it when a file could not be stored.
    void look_soon() { next_ = {}; }

  private:
    SteadyTime next_{};
};

// The trouble that more files come than the service can ingest. As long as it lasts, the log says
// so once a minute.
class BacklogTrouble {
  public:
    void look(SteadyTime now, const Intake& intake, StatusBook& status);

  private:
    SteadyTime next_{}, next_line_{};
    bool is_behind_ = false;
};

// The trouble that two processes run the same loops. If only another process runs the loops, look()
// copies the state that the other process reports into the status.
class OthersLoops {
  public:
    // Returns true if the status changed. `runs_loops` is true if this process runs loops.
    bool look(SteadyTime now, const std::filesystem::path& state,
              const std::vector<LoopConfig>& loops, bool runs_loops, StatusBook& status);

  private:
    SteadyTime next_{};
    bool are_kept_twice_ = false;
};

}  // namespace stormcellar::daemon
