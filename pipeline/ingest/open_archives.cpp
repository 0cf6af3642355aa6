#include "pipeline/ingest/open_archives.h"

#include <algorithm>
#include <utility>

namespace stormcellar::pipeline {

std::optional<OpenArchive> OpenArchives::take(const std::filesystem::path& path,
                                              const FileStamp& stamp) {
    const std::scoped_lock lock(mutex_);
    const auto found = std::ranges::find(open_, path, &OpenArchive::path);
    if (found == open_.end()) return std::nullopt;
    std::optional<OpenArchive> archive;
    if (found->stamp == stamp) archive.emplace(std::move(*found));
    open_.erase(found);
    return archive;
}

void OpenArchives::keep(OpenArchive archive) {
    const std::scoped_lock lock(mutex_);
    if (open_.size() >= most_open) open_.erase(open_.begin());
    open_.push_back(std::move(archive));
}

}  // namespace stormcellar::pipeline
