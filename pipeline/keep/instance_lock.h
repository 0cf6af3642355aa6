// pipeline/keep/instance_lock.h -- one daemon a state directory.
#pragma once

#include <filesystem>

#include "stormcellar/base/result.h"

namespace stormcellar::pipeline {

// Holds state/stormcellard.lock (flock; the kernel lets go of it when the process ends, however
// that happens) with the process id in it.
class InstanceLock {
  public:
    static constexpr const char* file_name = "stormcellard.lock";

    // bad_argument, with the process id, when another daemon holds it; io, permission.
    static Result<InstanceLock> acquire(const std::filesystem::path& state);
    InstanceLock(InstanceLock&& other) noexcept;
    InstanceLock& operator=(InstanceLock&&) = delete;
    InstanceLock(const InstanceLock&) = delete;
    InstanceLock& operator=(const InstanceLock&) = delete;
    ~InstanceLock();

  private:
    explicit InstanceLock(int descriptor) : descriptor_(descriptor) {}
    int descriptor_;
};

}  // namespace stormcellar::pipeline
