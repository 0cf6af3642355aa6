#include "pipeline/ingest/open_archives.h"

#include <algorithm>
#include <utility>

#include <sys/stat.h>

namespace stormcellar::pipeline {

std::optional<OpenArchive> OpenArchives::take(const std::filesystem::path& path,
                                              const FileStamp& stamp) {
    const MutexLock lock(mutex_);
    const auto found = std::ranges::find(
        open_, path, [](const Waiting& one) -> const auto& { return one.archive.path; });
    if (found == open_.end()) return std::nullopt;
    std::optional<OpenArchive> archive;
    if (found->archive.stamp == stamp) archive.emplace(std::move(found->archive));
    open_.erase(found);
    return archive;
}

void OpenArchives::keep(OpenArchive archive) {
    const MutexLock lock(mutex_);
    std::erase_if(open_, [](const Waiting& one) {
        struct stat facts {};
        const bool is_deleted =
            ::fstat(one.archive.file.number(), &facts) != 0 || facts.st_nlink == 0;
        return is_deleted || steady_now() - one.since > longest_wait;
    });
    if (open_.size() < most_open) open_.push_back({std::move(archive), steady_now()});
}

}  // namespace stormcellar::pipeline
