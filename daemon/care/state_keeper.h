// daemon/care/state_keeper.h -- the state directory with its catalog directory and its lock: makes
// and holds them at the start, and makes them again if somebody deletes them under the running
// service.
//
// Their contents come back by themselves: databases with the next files, the status when it is next
// published, the socket within 15 s. Thread contract: one thread.
#pragma once

#include <filesystem>
#include <optional>

#include "pipeline/keep/instance_lock.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

class StateKeeper {
  public:
    explicit StateKeeper(std::filesystem::path state) : state_(std::move(state)) {}

    // Makes missing directories and takes the lock; errors of both (pipeline/keep/instance_lock.h).
    // The first call removes the temporary files that a killed service left.
    [[nodiscard]] Status hold();
    // Returns none while everything is there; otherwise the result of making it again. That takes a
    // new lock, which fails (busy) if another service was started on the new directory meanwhile.
    [[nodiscard]] std::optional<Status> look();

  private:
    std::filesystem::path state_;
    std::optional<pipeline::InstanceLock> lock_;
};

}  // namespace stormcellar::daemon
