// pipeline/keep/instance_lock.h -- one daemon a state directory.
#pragma once

#include <filesystem>
#include <utility>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/result.h"

namespace stormcellar::pipeline {

// Holds state/stormcellard.lock, with the process id in it. The kernel releases the lock (flock)
// when the process ends, however that happens. Thread contract: one thread.
class InstanceLock {
  public:
    static constexpr const char* file_name = "stormcellard.lock";

    // Errors: busy, with the process id, if another daemon holds the lock; io, permission.
    static Result<InstanceLock> acquire(const std::filesystem::path& state);

  private:
    explicit InstanceLock(Descriptor file) : file_(std::move(file)) {}
    Descriptor file_;  // closing it releases the lock
};

}  // namespace stormcellar::pipeline
