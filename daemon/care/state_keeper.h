// daemon/care/state_keeper.h -- makes the state directory and its catalog directory, and locks the
// state. If somebody deletes the directories while the service runs, the keeper makes them again.
//
// Once the directories exist, the rest of the service makes their contents again: databases when
// the next files come, the status when it is next published, the socket within 15 s.
//
// Threads   One thread at a time.
#pragma once

#include <filesystem>
#include <optional>

#include "pipeline/keep/instance_lock.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

class StateKeeper {
  public:
    explicit StateKeeper(std::filesystem::path state) : state_(std::move(state)) {}

    // Makes the directories that are missing. Takes the lock unless this object holds it and the
    // lock's file exists. The first call also removes temporary files that a killed service left.
    // Errors: permission or io if a directory cannot be made; those of the lock
    // (pipeline/keep/instance_lock.h).
    [[nodiscard]] Status hold();
    // Returns none while the catalog directory and the lock's file exist. Otherwise returns the
    // result of hold(). The error is bad_argument if another service has in the meantime made a new
    // state directory and locked it.
    [[nodiscard]] std::optional<Status> look();

  private:
    std::filesystem::path state_;
    std::optional<pipeline::InstanceLock> lock_;
};

}  // namespace stormcellar::daemon
