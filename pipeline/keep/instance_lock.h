// pipeline/keep/instance_lock.h -- allows one daemon for each state directory.
//
// Threads   One thread at a time.
#pragma once

#include <filesystem>
#include <utility>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/result.h"

namespace stormcellar::pipeline {

// Holds state/stormcellard.lock with the process id in it (flock: the kernel releases it when the
// process ends, however that happens).
class InstanceLock {
  public:
    static constexpr const char* file_name = "stormcellard.lock";

    // Errors: bad_argument, with the process id, if another daemon holds it; io, permission.
    static Result<InstanceLock> acquire(const std::filesystem::path& state);

  private:
    explicit InstanceLock(Descriptor file) : file_(std::move(file)) {}
    Descriptor file_;  // closing it releases the lock
};

}  // namespace stormcellar::pipeline
