// daemon/care/state_keeper.h -- makes the state directory with its catalog directory and holds its
// lock, and makes them again if somebody deletes them while the service runs.
//
// The contents come back by themselves once the directories exist: the databases with the next
// files, the status when it is next published, the socket within 15 s.
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

    // Makes the directories that are missing and takes the lock. The first call also removes the
    // temporary files that a killed service left. Errors: those of making directories and of the
    // lock (pipeline/keep/instance_lock.h).
    [[nodiscard]] Status hold();
    // Returns none while everything exists, else the result of making it again. The lock is then a
    // new one; if another service was started on the new directory in the meantime, that service
    // holds it (bad_argument).
    [[nodiscard]] std::optional<Status> look();

  private:
    std::filesystem::path state_;
    std::optional<pipeline::InstanceLock> lock_;
};

}  // namespace stormcellar::daemon
