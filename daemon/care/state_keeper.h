// daemon/care/state_keeper.h -- the state directory with its catalog directory and its lock: made
// and held at the start, and made again when somebody deletes them under the running service.
//
// What goes into them comes back by itself once they stand: databases with the next files, the
// status with its next publication, the socket within 15 s.
// Thread contract: one thread.
#pragma once

#include <filesystem>
#include <optional>

#include "pipeline/keep/instance_lock.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

class StateKeeper {
  public:
    explicit StateKeeper(std::filesystem::path state) : state_(std::move(state)) {}

    // Makes the directories where they are missing and takes the lock; errors of both
    // (pipeline/keep/instance_lock.h). The first time it removes the temporary files that a killed
    // service left.
    [[nodiscard]] Status hold();
    // None while all is there; else what came of making it again. The lock is another one then: a
    // service that was started on the new directory meanwhile has it (bad_argument).
    [[nodiscard]] std::optional<Status> look();

  private:
    std::filesystem::path state_;
    std::optional<pipeline::InstanceLock> lock_;
};

}  // namespace stormcellar::daemon
