#include "batch/held_cache.h"

#include <fcntl.h>
#include <sys/stat.h>

namespace stormcellar::batch {

HeldCache::HeldCache(const std::filesystem::path& cache)
    : cache_(cache), directory_(::open(cache.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {}

Status HeldCache::check() const {
    struct stat held {
    }, now{};
    const bool is_same = directory_.is_open() && ::fstat(directory_.number(), &held) == 0 &&
                         ::stat(cache_.c_str(), &now) == 0 && held.st_dev == now.st_dev &&
                         held.st_ino == now.st_ino;
    if (is_same) return {};
    return fail(ErrorCode::io, "{}: was mounted, unmounted or replaced while the task ran",
                cache_.native());
}

}  // namespace stormcellar::batch
