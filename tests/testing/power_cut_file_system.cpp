#include "tests/testing/power_cut_file_system.h"

#include <system_error>

namespace stormcellar::testing {

Status PowerCutFileSystem::count_operation() {
    if (fail_from_ && operations_++ >= *fail_from_) return fail(ErrorCode::io, "injected failure");
    if (!fail_from_) ++operations_;
    return {};
}

Result<int> PowerCutFileSystem::create_exclusive(const fs::path& path) {
    if (Status counted = count_operation(); !counted) return pass_on(counted);
    Result<int> descriptor = real_file_system().create_exclusive(path);
    if (descriptor) {
        open_[*descriptor] = path;
        unsynced_contents_.insert(path);
    }
    return descriptor;
}

Status PowerCutFileSystem::write_at(int descriptor, std::uint64_t offset,
                                    std::span<const std::byte> bytes) {
    if (Status counted = count_operation(); !counted) return counted;
    if (space_) {
        if (bytes.size() > *space_) return fail(ErrorCode::no_space, "write: no space (injected)");
        *space_ -= bytes.size();
    }
    unsynced_contents_.insert(open_.at(descriptor));
    return real_file_system().write_at(descriptor, offset, bytes);
}

Status PowerCutFileSystem::set_size(int descriptor, std::uint64_t size) {
    if (Status counted = count_operation(); !counted) return counted;
    unsynced_contents_.insert(open_.at(descriptor));
    return real_file_system().set_size(descriptor, size);
}

Status PowerCutFileSystem::sync(int descriptor) {
    if (Status counted = count_operation(); !counted) return counted;
    unsynced_contents_.erase(open_.at(descriptor));
    return {};
}

void PowerCutFileSystem::close(int descriptor) {
    open_.erase(descriptor);
    real_file_system().close(descriptor);
}

// Makes a second name for a file, which keeps its blocks, holes included.
Result<fs::path> PowerCutFileSystem::keep(const fs::path& path) {
    const fs::path kept = attic_ / std::to_string(kept_++);
    std::error_code error;
    fs::create_hard_link(path, kept, error);
    if (error) return fail(ErrorCode::io, "{}: {}", path.native(), error.message());
    return kept;
}

Status PowerCutFileSystem::rename(const fs::path& from, const fs::path& to) {
    if (Status counted = count_operation(); !counted) return counted;
    NameChange change{from, to, std::nullopt};
    if (fs::exists(to)) {
        auto replaced = keep(to);
        if (!replaced) return pass_on(replaced);
        change.kept = std::move(*replaced);
    }
    if (Status renamed = real_file_system().rename(from, to); !renamed) return renamed;
    if (unsynced_contents_.erase(from) > 0) unsynced_contents_.insert(to);
    for (auto& [descriptor, path] : open_) {
        if (path == from) path = to;
    }
    unsynced_names_.push_back(std::move(change));
    return {};
}

Status PowerCutFileSystem::sync_directory(const fs::path& directory) {
    if (Status counted = count_operation(); !counted) return counted;
    std::erase_if(unsynced_names_,
                  [&](const NameChange& c) { return c.to.parent_path() == directory; });
    return {};
}

// Removes a file. After a power cut a file whose contents were all synced comes back, unless its
// directory was synced after the removal. Any other file stays removed.
Status PowerCutFileSystem::remove(const fs::path& path) {
    if (Status counted = count_operation(); !counted) return counted;
    if (unsynced_contents_.erase(path) == 0 && fs::exists(path)) {
        auto kept = keep(path);
        if (!kept) return pass_on(kept);
        unsynced_names_.push_back({{}, path, std::move(*kept)});
    }
    return real_file_system().remove(path);
}

void PowerCutFileSystem::power_cut() {
    std::error_code ignored;
    for (auto change = unsynced_names_.rbegin(); change != unsynced_names_.rend(); ++change) {
        if (!change->from.empty()) {
            fs::rename(change->to, change->from, ignored);
            if (unsynced_contents_.erase(change->to) > 0) unsynced_contents_.insert(change->from);
        }
        if (!change->kept) continue;
        fs::create_directories(change->to.parent_path(), ignored);
        fs::rename(*change->kept, change->to, ignored);
    }
    for (const auto& path : unsynced_contents_)
        fs::resize_file(path, 0, ignored);
    unsynced_names_.clear();
    unsynced_contents_.clear();
    fail_from_.reset();
    space_.reset();
}

}  // namespace stormcellar::testing
