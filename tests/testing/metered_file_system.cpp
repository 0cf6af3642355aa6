#include "tests/testing/metered_file_system.h"

#include <algorithm>
#include <system_error>

#include <sys/stat.h>

namespace stormcellar::testing {

namespace fs = std::filesystem;

std::uint64_t allocated_bytes(const fs::path& directory) {
    std::uint64_t sum = 0;
    std::error_code error;
    for (fs::recursive_directory_iterator entry(directory, error), end; entry != end && !error;
         entry.increment(error)) {
        struct stat facts {};
        if (::lstat(entry->path().c_str(), &facts) == 0 && S_ISREG(facts.st_mode)) {
            sum += static_cast<std::uint64_t>(facts.st_blocks) * 512;
        }
    }
    return sum;
}

Status MeteredFileSystem::weigh(Status outcome) {
    most_ = std::max(most_, allocated_bytes(directory_));
    return outcome;
}

Result<int> MeteredFileSystem::create_exclusive(const fs::path& path) {
    const std::scoped_lock lock(mutex_);
    auto descriptor = real_file_system().create_exclusive(path);
    most_ = std::max(most_, allocated_bytes(directory_));
    return descriptor;
}

Status MeteredFileSystem::write_at(int descriptor, std::uint64_t offset,
                                   std::span<const std::byte> bytes) {
    const std::scoped_lock lock(mutex_);
    if (allocated_bytes(directory_) + bytes.size() > capacity_) {
        return fail(ErrorCode::no_space, "write: No space left on device");
    }
    return weigh(real_file_system().write_at(descriptor, offset, bytes));
}

Status MeteredFileSystem::set_size(int descriptor, std::uint64_t size) {
    const std::scoped_lock lock(mutex_);
    return weigh(real_file_system().set_size(descriptor, size));
}

// Syncs nothing, because this file system does not simulate crashes.
Status MeteredFileSystem::sync(int /*descriptor*/) {
    const std::scoped_lock lock(mutex_);
    return weigh({});
}

Status MeteredFileSystem::rename(const fs::path& from, const fs::path& to) {
    const std::scoped_lock lock(mutex_);
    return weigh(real_file_system().rename(from, to));
}

Status MeteredFileSystem::sync_directory(const fs::path& directory) {
    if (!fs::exists(directory)) {
        return fail(ErrorCode::not_found, "{}: no such directory", directory.native());
    }
    return {};
}

Status MeteredFileSystem::remove(const fs::path& path) {
    const std::scoped_lock lock(mutex_);
    ++removals_;
    return weigh(real_file_system().remove(path));
}

void MeteredFileSystem::set_capacity(std::uint64_t bytes) {
    const std::scoped_lock lock(mutex_);
    capacity_ = bytes;
}

std::uint64_t MeteredFileSystem::most() const {
    const std::scoped_lock lock(mutex_);
    return most_;
}

std::uint64_t MeteredFileSystem::removals() const {
    const std::scoped_lock lock(mutex_);
    return removals_;
}

void MeteredFileSystem::forget() {
    const std::scoped_lock lock(mutex_);
    most_ = 0;
    removals_ = 0;
}

}  // namespace stormcellar::testing
