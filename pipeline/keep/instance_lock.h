// pipeline/keep/instance_lock.h -- makes sure that only one daemon uses a state directory.
//
// Threads   One thread at a time.
#pragma once

#include <filesystem>
#include <utility>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/result.h"

namespace stormcellar::pipeline {

// Holds a flock on STATE/stormcellard.lock, which contains the process id. The kernel releases the
// lock when the process ends, even if it crashes.
class InstanceLock {
  public:
    static constexpr const char* file_name = "stormcellard.lock";

    // Takes the lock. Errors: busy, with the process id, if another daemon has it; io, permission.
    static Result<InstanceLock> acquire(const std::filesystem::path& state);

  private:
    explicit InstanceLock(Descriptor file) : file_(std::move(file)) {}
    Descriptor file_;  // closing it releases the lock
};

}  // namespace stormcellar::pipeline
