#include "daemon/tree_walk.h"

#include <cerrno>
#include <memory>
#include <system_error>

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

#include "pipeline/drop_names.h"

namespace stormcellar::daemon {
namespace {

struct CloseDirectory {
    void operator()(DIR* directory) const { ::closedir(directory); }
};
using DirectoryHandle = std::unique_ptr<DIR, CloseDirectory>;

DirectoryHandle open_directory(int parent, const char* name) {
    const int descriptor =
        ::openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) return nullptr;
    DIR* directory = ::fdopendir(descriptor);
    if (directory == nullptr) ::close(descriptor);
    return DirectoryHandle{directory};
}

std::string reason_of(int error_number) {
    return std::system_category().message(error_number);
}

void walk_entries(DIR* directory, const std::filesystem::path& path, int depth,
                  const WalkVisitor& visitor);

void walk_below(int parent, const char* name, const std::filesystem::path& path, int depth,
                const WalkVisitor& visitor) {
    if (depth > max_walk_depth) {
        visitor.problem(fmt::format("{}: more than {} directories deep, left out", path.native(),
                                    max_walk_depth));
        return;
    }
    visitor.directory(path);
    const DirectoryHandle directory = open_directory(parent, name);
    if (directory) {
        walk_entries(directory.get(), path, depth, visitor);
    } else if (errno != ENOENT && errno != ENOTDIR && errno != ELOOP) {  // gone since: no problem
        visitor.problem(fmt::format("{}: {}", path.native(), reason_of(errno)));
    }
}

void walk_entries(DIR* directory, const std::filesystem::path& path, int depth,
                  const WalkVisitor& visitor) {
    const int descriptor = ::dirfd(directory);
    for (;;) {
        errno = 0;
        const struct dirent* entry = ::readdir(directory);
        if (entry == nullptr) {
            if (errno != 0) {
                visitor.problem(fmt::format("{}: {}", path.native(), reason_of(errno)));
            }
            return;
        }
        if (pipeline::is_temporary_name(entry->d_name)) continue;
        struct stat facts {};
        if (::fstatat(descriptor, entry->d_name, &facts, AT_SYMLINK_NOFOLLOW) != 0) continue;
        if (S_ISREG(facts.st_mode)) {
            visitor.file(path / entry->d_name, stamp_of(facts));
        } else if (S_ISDIR(facts.st_mode)) {
            walk_below(descriptor, entry->d_name, path / entry->d_name, depth + 1, visitor);
        }
    }
}

}  // namespace

Status walk(const std::filesystem::path& root, const WalkVisitor& visitor) {
    visitor.directory(root);
    const DirectoryHandle directory = open_directory(AT_FDCWD, root.c_str());
    if (!directory) {
        const int error_number = errno;
        const ErrorCode code = error_number == ENOENT || error_number == ENOTDIR
                                   ? ErrorCode::not_found
                               : error_number == EACCES ? ErrorCode::permission
                                                        : ErrorCode::io;
        return fail(code, "{}: {}", root.native(), reason_of(error_number));
    }
    walk_entries(directory.get(), root, 0, visitor);
    return {};
}

}  // namespace stormcellar::daemon
