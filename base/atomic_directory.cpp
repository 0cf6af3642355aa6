#include "base/atomic_directory.h"

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <system_error>
#include <utility>

#include <unistd.h>

#include "base/system_error.h"

namespace stormcellar {
namespace {

namespace fs = std::filesystem;

fs::path temporary_directory_beside(const fs::path& final_path) {
    static std::atomic<std::uint64_t> counter{0};
    return final_path.parent_path() /
           fmt::format("{}directory-{}", own_temporary_prefix(), counter.fetch_add(1));
}

fs::path directory_around(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path{"."};
}

Status make_directory(const fs::path& path) {
    std::error_code error;
    if (fs::create_directory(path, error)) return {};
    if (!error) return fail(ErrorCode::io, "{} is in the way", path.native());
    const bool missing = error == std::errc::no_such_file_or_directory;
    const bool denied =
        error == std::errc::permission_denied || error == std::errc::read_only_file_system;
    const auto code = missing  ? ErrorCode::not_found
                      : denied ? ErrorCode::permission
                               : ErrorCode::io;
    return fail(code, "{}", error.message());
}

// Returns true if there is a directory that may be replaced, and false if the name is free.
Result<bool> has_replaceable(const fs::path& path, AtomicDirectory::MayReplace may_replace) {
    std::error_code error;
    const fs::file_status status = fs::symlink_status(path, error);
    if (status.type() == fs::file_type::not_found) return false;
    if (status.type() != fs::file_type::directory)
        return fail(ErrorCode::not_a_file, "exists and is not a directory");
    if (Status may = may_replace(path); !may) return pass_on(may);
    return true;
}

}  // namespace

Status AtomicDirectory::check(const fs::path& final_path, MayReplace may_replace) {
    const auto target = has_replaceable(final_path, may_replace);
    if (!target) return pass_on(target);
    const fs::path around = directory_around(final_path);
    std::error_code error;
    if (!fs::is_directory(around, error))
        return fail(ErrorCode::not_found, "there is no directory {}", around.native());
    if (::access(around.c_str(), W_OK) != 0) return system_failure(around.native(), errno);
    return {};
}

Result<AtomicDirectory> AtomicDirectory::create(FileSystem& file_system, fs::path final_path,
                                                MayReplace may_replace) {
    if (auto target = has_replaceable(final_path, may_replace); !target) return pass_on(target);
    fs::path temporary_path = temporary_directory_beside(final_path);
    if (Status made = make_directory(temporary_path); !made) return pass_on(made);
    return AtomicDirectory(file_system, std::move(final_path), std::move(temporary_path),
                           may_replace);
}

AtomicDirectory::AtomicDirectory(FileSystem& file_system, fs::path final_path,
                                 fs::path temporary_path, MayReplace may_replace)
    : file_system_(&file_system),
      final_path_(std::move(final_path)),
      temporary_path_(std::move(temporary_path)),
      may_replace_(may_replace),
      directories_{temporary_path_} {}

AtomicDirectory::AtomicDirectory(AtomicDirectory&& other) noexcept
    : file_system_(other.file_system_),
      final_path_(std::move(other.final_path_)),
      temporary_path_(std::exchange(other.temporary_path_, {})),
      may_replace_(other.may_replace_),
      directories_(std::move(other.directories_)) {}

AtomicDirectory::~AtomicDirectory() {
    std::error_code ignored;
    if (!temporary_path_.empty()) fs::remove_all(temporary_path_, ignored);
}

Status AtomicDirectory::write(const fs::path& name, std::span<const std::byte> bytes) {
    fs::path directory = temporary_path_;
    for (const fs::path& part : name.parent_path()) {
        directory /= part;
        if (directories_.contains(directory)) continue;
        if (Status made = make_directory(directory); !made) return made;
        directories_.insert(directory);
    }
    const auto descriptor = file_system_->create_exclusive(temporary_path_ / name);
    if (!descriptor) return pass_on(descriptor);
    Status done = file_system_->write_at(*descriptor, 0, bytes);
    if (done) done = file_system_->sync(*descriptor);
    file_system_->close(*descriptor);
    if (!done) return fail(done.error().code, "{}: {}", name.native(), done.error().message);
    return {};
}

Status AtomicDirectory::commit() {
    for (const fs::path& directory : directories_) {
        if (Status synced = file_system_->sync_directory(directory); !synced) return synced;
    }
    const auto replaces = has_replaceable(final_path_, may_replace_);
    if (!replaces) return pass_on(replaces);
    const fs::path old = temporary_directory_beside(final_path_);
    if (*replaces) {
        if (Status moved = file_system_->rename(final_path_, old); !moved) return moved;
    }
    if (Status moved = file_system_->rename(temporary_path_, final_path_); !moved) {
        if (*replaces) (void)file_system_->rename(old, final_path_);
        return moved;
    }
    temporary_path_.clear();
    Status synced = file_system_->sync_directory(directory_around(final_path_));
    // Remove the old directory only now, so that a power cut leaves either the old or the new
    // directory.
    std::error_code ignored;
    if (*replaces) fs::remove_all(old, ignored);
    return synced;
}

}  // namespace stormcellar
