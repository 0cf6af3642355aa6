#include "base/beneath.h"

#include <cerrno>
#include <memory>
#include <utility>

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

#include "base/system_error.h"
#include "stormcellar/base/descriptor.h"

namespace stormcellar {
namespace {

namespace fs = std::filesystem;

// Returns the error of a failed call. A link in place of a directory or a file counts as not found.
tl::unexpected<Error> failure(const fs::path& path, int error_number) {
    auto failed = system_failure(path.native(), error_number);
    if (error_number == ELOOP || error_number == ENAMETOOLONG)
        failed.value().code = ErrorCode::not_found;
    return failed;
}

// The open directory of a path, and the last part of the path.
struct Place {
    Descriptor directory{AT_FDCWD};
    fs::path name;
};

// Returns the parts of the path that are below the root, or none if the path is not below it.
Result<std::vector<fs::path>> parts_below(const fs::path& root, const fs::path& path) {
    auto part = path.begin();
    for (const fs::path& of_root : root) {
        if (of_root.empty()) continue;  // the empty part of "root/"
        if (part == path.end() || *part != of_root) {
            return fail(ErrorCode::not_found, "{}: lies outside of {}", path.native(),
                        root.native());
        }
        ++part;
    }
    std::vector<fs::path> parts;
    for (; part != path.end(); ++part) {
        if (part->empty() || *part == ".") continue;
        if (*part == "..") {
            return fail(ErrorCode::not_found, "{}: lies outside of {}", path.native(),
                        root.native());
        }
        parts.push_back(*part);
    }
    return parts;
}

Result<Place> find_place(const fs::path& root, const fs::path& path) {
    if (root.empty()) return Place{Descriptor{AT_FDCWD}, path};
    auto parts = parts_below(root, path);
    if (!parts) return pass_on(parts);
    Place place{Descriptor{::open(root.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC)}, "."};
    if (place.directory.number() < 0) return failure(path, errno);
    if (parts->empty()) return place;
    place.name = std::move(parts->back());
    parts->pop_back();
    for (const fs::path& part : *parts) {
        Descriptor below{::openat(place.directory.number(), part.c_str(),
                                  O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)};
        if (below.number() < 0) return failure(path, errno);
        place.directory = std::move(below);
    }
    return place;
}

tl::unexpected<Error> no_file(const fs::path& path, mode_t mode) {
    return fail(ErrorCode::not_a_file, "{}: is {}", path.native(), kind_of_file(mode));
}

struct CloseDirectory {
    void operator()(DIR* directory) const { ::closedir(directory); }
};

}  // namespace

std::string_view kind_of_file(mode_t mode) {
    switch (mode & S_IFMT) {
        case S_IFREG:
            return "a regular file";
        case S_IFDIR:
            return "a directory";
        case S_IFLNK:
            return "a symbolic link";
        case S_IFIFO:
            return "a FIFO";
        case S_IFSOCK:
            return "a socket";
        case S_IFCHR:
        case S_IFBLK:
            return "a device";
        default:
            return "not a regular file";
    }
}

Result<struct stat> look_beneath(const fs::path& root, const fs::path& path) {
    const auto place = find_place(root, path);
    if (!place) return pass_on(place);
    struct stat facts {};
    if (::fstatat(place->directory.number(), place->name.c_str(), &facts, AT_SYMLINK_NOFOLLOW) != 0)
        return failure(path, errno);
    return facts;
}

Result<int> open_beneath(const fs::path& root, const fs::path& path) {
    const auto place = find_place(root, path);
    if (!place) return pass_on(place);
    // Opening a device may already have an effect, so check the kind of file first. If the file is
    // replaced after this check, the flags and the second check notice it.
    const int directory = place->directory.number();
    struct stat facts {};
    if (::fstatat(directory, place->name.c_str(), &facts, AT_SYMLINK_NOFOLLOW) != 0)
        return failure(path, errno);
    if (!S_ISREG(facts.st_mode)) return no_file(path, facts.st_mode);
    Descriptor file{::openat(directory, place->name.c_str(),
                             O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)};
    if (file.number() < 0) {
        const int error_number = errno;
        if (error_number == ELOOP) return no_file(path, S_IFLNK);
        return failure(path, error_number);
    }
    if (::fstat(file.number(), &facts) != 0) return failure(path, errno);
    if (!S_ISREG(facts.st_mode)) return no_file(path, facts.st_mode);
    return file.release();
}

Result<std::vector<std::byte>> read_beneath(const fs::path& root, const fs::path& path,
                                            std::uint64_t limit) {
    const auto file = open_beneath(root, path);
    if (!file) return pass_on(file);
    return read_open_file(Descriptor{*file}.number(), path, limit);
}

Result<std::vector<std::string>> names_beneath(const fs::path& root, const fs::path& directory) {
    const auto place = find_place(root, directory);
    if (!place) return pass_on(place);
    Descriptor opened{
        ::openat(place->directory.number(), place->name.c_str(),
                 O_RDONLY | O_DIRECTORY | O_CLOEXEC | (root.empty() ? 0 : O_NOFOLLOW))};
    if (opened.number() < 0) return failure(directory, errno);
    const std::unique_ptr<DIR, CloseDirectory> entries{::fdopendir(opened.number())};
    if (!entries) return failure(directory, errno);
    (void)opened.release();
    std::vector<std::string> names;
    for (;;) {
        errno = 0;
        const struct dirent* entry = ::readdir(entries.get());
        if (entry == nullptr) break;
        const std::string_view name = entry->d_name;
        if (name != "." && name != "..") names.emplace_back(name);
    }
    if (errno != 0) return failure(directory, errno);
    return names;
}

}  // namespace stormcellar
