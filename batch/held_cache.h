// batch/held_cache.h -- tells whether a task had the same cache from its beginning to its end.
//
// A cache is often a mount. Where it is mounted or unmounted while a task runs, a part of the
// task's grids is in the directory beneath. The directory is held open meanwhile, so that an
// automounter keeps it. A mount that goes and comes back within one task is not noticed.
//
// Threads   One thread at a time.
// Errors    io.
#pragma once

#include <filesystem>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/result.h"

namespace stormcellar::batch {

class HeldCache {
  public:
    // Opens the directory. If it is not there, check() fails.
    explicit HeldCache(const std::filesystem::path& cache);

    // Returns ok if the path still leads to the directory to which it led before.
    [[nodiscard]] Status check() const;

  private:
    std::filesystem::path cache_;
    Descriptor directory_;
};

}  // namespace stormcellar::batch
