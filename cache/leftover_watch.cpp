#include "cache/leftover_watch.h"

namespace stormcellar::cache {

Result<int> LeftoverWatch::create_exclusive(const std::filesystem::path& path) {
    Result<int> descriptor = inner_.create_exclusive(path);
    if (descriptor) made_ = path;
    return descriptor;
}

Status LeftoverWatch::rename(const std::filesystem::path& from, const std::filesystem::path& to) {
    Status renamed = inner_.rename(from, to);
    if (renamed && made_ == from) made_.reset();
    return renamed;
}

Status LeftoverWatch::remove(const std::filesystem::path& path) {
    Status removed = inner_.remove(path);
    if (removed && made_ == path) made_.reset();
    return removed;
}

}  // namespace stormcellar::cache
