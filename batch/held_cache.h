// batch/held_cache.h -- checks that a task had the same cache from beginning to end.
//
// A cache is often a mount. If the cache is mounted or unmounted while a task runs, some of the
// task's grids end up in the directory under the mount. The object holds the directory open, so
// that an automounter does not unmount it. The object cannot notice that a cache was unmounted and
// mounted again within one task.
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
    // Opens the directory. If that fails, check() fails, too.
    explicit HeldCache(const std::filesystem::path& cache);

    // Returns ok if the path still leads to the same directory as at the start.
    [[nodiscard]] Status check() const;

  private:
    std::filesystem::path cache_;
    Descriptor directory_;
};

}  // namespace stormcellar::batch
