#include "cache/pins.h"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cache/directories.h"
#include "cache/file_io.h"

namespace stormcellar::cache {
namespace {

namespace fs = std::filesystem;

fs::path pin_path(const fs::path& grid) {
    return grid.native() + std::string(pin_extension);
}

bool stands(const fs::path& path) {
    struct stat facts {};
    return ::lstat(path.c_str(), &facts) == 0 && S_ISREG(facts.st_mode);
}

bool is_at(const Descriptor& directory, const fs::path& path) {
    struct stat open {
    }, named{};
    return ::fstat(directory.number(), &open) == 0 && ::stat(path.c_str(), &named) == 0 &&
           open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

// Locks the directory of a day. Locks the directory itself, so that no lock file is needed. Tries
// again if the directory was removed and made anew in the meantime.
Result<Descriptor> lock_day(const fs::path& day) {
    for (;;) {
        Descriptor directory(::open(day.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
        if (directory.number() < 0) {
            return directory_failure(day, {errno, std::system_category()});
        }
        if (::flock(directory.number(), LOCK_EX) == 0) {
            if (is_at(directory, day)) return directory;
        } else if (errno != EINTR) {
            return directory_failure(day, {errno, std::system_category()});
        }
    }
}

}  // namespace

bool is_pinned(const fs::path& grid) {
    return stands(pin_path(grid));
}

Status pin_grid(FileSystem& file_system, const fs::path& grid) {
    const auto lock = lock_day(grid.parent_path());
    if (!lock || !stands(grid)) {
        if (!lock && lock.error().code != ErrorCode::not_found) return pass_on(lock);
        return fail(ErrorCode::not_found, "{}: there is no such grid", grid.native());
    }
    if (!is_pinned(grid)) {
        const auto descriptor = file_system.create_exclusive(pin_path(grid));
        if (!descriptor) return pass_on(descriptor);
        Status synced = file_system.sync(*descriptor);
        file_system.close(*descriptor);
        if (!synced) return synced;
    }
    return file_system.sync_directory(grid.parent_path());
}

Result<bool> unpin_grid(FileSystem& file_system, const fs::path& grid) {
    if (!is_pinned(grid)) return false;
    if (const Status removed = file_system.remove(pin_path(grid)); !removed) {
        if (removed.error().code == ErrorCode::not_found) return false;
        return pass_on(removed);
    }
    return true;
}

Result<Evicted> evict_grid(FileSystem& file_system, const fs::path& grid) {
    const auto lock = lock_day(grid.parent_path());
    if (!lock) {
        if (lock.error().code == ErrorCode::not_found) return Evicted::missing;
        return pass_on(lock);
    }
    if (is_pinned(grid)) return Evicted::pinned;
    if (const Status removed = file_system.remove(grid); !removed) {
        if (removed.error().code == ErrorCode::not_found) return Evicted::missing;
        return pass_on(removed);
    }
    return Evicted::gone;
}

void remove_empty_directories(const fs::path& day) {
    const fs::path moment = day.parent_path();
    for (const fs::path& directory : {day, moment, moment.parent_path()}) {
        if (::rmdir(directory.c_str()) != 0) return;
    }
}

}  // namespace stormcellar::cache
