#include "daemon/watch/tree_walk.h"

#include <cerrno>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

#include "pipeline/drop/drop_names.h"

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

ErrorCode code_of(int error_number) {
    if (error_number == EACCES || error_number == EPERM) return ErrorCode::permission;
    return error_number == ENOENT || error_number == ENOTDIR ? ErrorCode::not_found : ErrorCode::io;
}

void report_too_deep(const std::filesystem::path& path, const WalkVisitor& visitor) {
    visitor.problem(path, {ErrorCode::unsupported,
                           fmt::format("{}: is more than {} directories deep, so it is not read",
                                       path.native(), max_walk_depth)});
}

// Returns false if reading the directory gave no entries at all, not even ".".
bool walk_entries(DIR* directory, const std::filesystem::path& path, int depth,
                  const WalkVisitor& visitor);

void walk_below(int parent, const char* name, const std::filesystem::path& path, int depth,
                const WalkVisitor& visitor) {
    if (depth > max_walk_depth) {
        report_too_deep(path, visitor);
        return;
    }
    visitor.directory(path);
    const DirectoryHandle directory = open_directory(parent, name);
    if (directory) {
        (void)walk_entries(directory.get(), path, depth, visitor);
    } else if (errno != ENOENT && errno != ENOTDIR && errno != ELOOP) {
        // The directory still exists: it was neither removed (ENOENT) nor replaced by another kind
        // of entry (ENOTDIR, ELOOP). So report the error.
        const int error_number = errno;
        visitor.problem(path, {code_of(error_number),
                               fmt::format("{}: {}", path.native(), reason_of(error_number))});
        const bool is_for_now =
            error_number == EMFILE || error_number == ENFILE || error_number == ENOMEM;
        if (is_for_now && visitor.unseen) visitor.unseen();
    }
}

// Reports only the first reason why names of a directory are not used.
class NameProblem {
  public:
    NameProblem(const std::filesystem::path& path, const WalkVisitor& visitor)
        : path_(path), visitor_(visitor) {}
    void say(ErrorCode code, std::string_view what) {
        if (!std::exchange(said_, true))
            visitor_.problem(path_, {code, fmt::format("{}: {}", path_.native(), what)});
    }

  private:
    const std::filesystem::path& path_;
    const WalkVisitor& visitor_;
    bool said_ = false;
};

void walk_entry(int descriptor, const char* name, const std::filesystem::path& directory, int depth,
                const WalkVisitor& visitor, NameProblem& problem) {
    struct stat facts {};
    if (::fstatat(descriptor, name, &facts, AT_SYMLINK_NOFOLLOW) != 0) {
        const int error_number = errno;
        if (error_number != ENOENT) problem.say(code_of(error_number), reason_of(error_number));
        return;
    }
    std::filesystem::path path = directory / name;
    if (path.native().size() >= most_path_bytes) {
        problem.say(ErrorCode::unsupported,
                    fmt::format("holds paths of more than {} bytes, which are not read",
                                most_path_bytes - 1));
    } else if (S_ISREG(facts.st_mode)) {
        visitor.file(path, stamp_of(facts));
    } else if (S_ISDIR(facts.st_mode)) {
        walk_below(descriptor, name, path, depth + 1, visitor);
    } else if (visitor.other) {
        visitor.other(path, facts.st_mode);
    }
}

bool walk_entries(DIR* directory, const std::filesystem::path& path, int depth,
                  const WalkVisitor& visitor) {
    const int descriptor = ::dirfd(directory);
    NameProblem problem(path, visitor);
    for (int entries = 1;; ++entries) {
        if (entries % entries_a_step == 0 && visitor.step) visitor.step();
        errno = 0;
        const struct dirent* entry = ::readdir(directory);
        if (entry == nullptr) {
            const int error_number = errno;
            if (error_number != 0) problem.say(code_of(error_number), reason_of(error_number));
            return entries > 1;
        }
        if (pipeline::is_temporary_name(entry->d_name)) continue;
        walk_entry(descriptor, entry->d_name, path, depth, visitor, problem);
    }
}

// Returns true if the directory was deleted. A mount may keep a deleted directory, but its link
// count is then 0.
bool is_deleted(DIR* directory) {
    struct stat facts {};
    return ::fstat(::dirfd(directory), &facts) == 0 && facts.st_nlink == 0;
}

}  // namespace

Status walk(const std::filesystem::path& root, const WalkVisitor& visitor, int depth) {
    if (depth > max_walk_depth) {
        report_too_deep(root, visitor);
        return {};
    }
    visitor.directory(root);
    const std::filesystem::path opened = depth == 0 ? root / "." : root;
    const DirectoryHandle directory = open_directory(AT_FDCWD, opened.c_str());
    if (!directory) {
        const int error_number = errno;
        return fail(code_of(error_number), "{}: {}", root.native(), reason_of(error_number));
    }
    if (walk_entries(directory.get(), root, depth, visitor) || !is_deleted(directory.get()))
        return {};
    return fail(
        ErrorCode::io,
        "{}: was deleted, and only a mount of it is left, which a new directory of this name "
        "does not replace; restart the service",
        root.native());
}

}  // namespace stormcellar::daemon
