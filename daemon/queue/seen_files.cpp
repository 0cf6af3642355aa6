#include "daemon/queue/seen_files.h"

#include <array>
#include <span>

#include "base/checksum.h"

namespace stormcellar::daemon {
namespace {

std::uint64_t hash_of(const std::filesystem::path& path) {
    return xxh3_64(std::as_bytes(std::span{path.native()}));
}

std::uint64_t hash_of(const FileStamp& stamp) {
    const std::array<std::uint64_t, 4> words = {stamp.inode, stamp.size_bytes,
                                                static_cast<std::uint64_t>(stamp.modified_ns),
                                                static_cast<std::uint64_t>(stamp.changed_ns)};
    return xxh3_64(std::as_bytes(std::span{words}));
}

}  // namespace

bool SeenFiles::contains(const std::filesystem::path& path, const FileStamp& stamp) const {
    const auto found = files_.find(hash_of(path));
    return found != files_.end() && found->second.stamp_hash == hash_of(stamp);
}

void SeenFiles::add(const std::filesystem::path& path, const FileStamp& stamp) {
    files_[hash_of(path)] = {hash_of(stamp), scan_};
}

void SeenFiles::forget(const std::filesystem::path& path) {
    files_.erase(hash_of(path));
}

void SeenFiles::found_again(const std::filesystem::path& path) {
    if (const auto found = files_.find(hash_of(path)); found != files_.end()) {
        found->second.scan = scan_;
    }
}

void SeenFiles::end_scan() {
    std::erase_if(files_, [this](const auto& entry) { return entry.second.scan != scan_; });
}

}  // namespace stormcellar::daemon
