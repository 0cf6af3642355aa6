// pipeline/keep/instance_lock.h -- one daemon a state directory.
#pragma once

#include <filesystem>
#include <utility>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/result.h"

namespace stormcellar::pipeline {

// Holds state/stormcellard.lock (flock; the kernel lets go of it when the process ends, however
// that happens) with the process id in it.
class InstanceLock {
  public:
    static constexpr const char* file_name = "stormcellard.lock";

    // busy, with the process id, when another daemon holds it; io, permission.
    static Result<InstanceLock> acquire(const std::filesystem::path& state);

  private:
    explicit InstanceLock(Descriptor file) : file_(std::move(file)) {}
    Descriptor file_;  // the kernel lets go of the lock when it is closed
};

}  // namespace stormcellar::pipeline
