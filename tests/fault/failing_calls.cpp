// LD_PRELOAD loads this library into the daemon (failing_calls.h). It links no code of the product.
#include "tests/fault/failing_calls.h"

#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

namespace {

using namespace stormcellar::fault;

Steering* open_steering() {
    const char* path = std::getenv("STORMCELLAR_FAILING_CALLS");
    if (path == nullptr) return nullptr;
    const long file = ::syscall(SYS_openat, AT_FDCWD, path, O_RDWR | O_CLOEXEC);
    if (file < 0) return nullptr;
    void* mapped = ::mmap(nullptr, sizeof(Steering), PROT_READ | PROT_WRITE, MAP_SHARED,
                          static_cast<int>(file), 0);
    ::syscall(SYS_close, file);
    return mapped == MAP_FAILED ? nullptr : static_cast<Steering*>(mapped);
}

Steering* steering() {
    static Steering* const opened = open_steering();
    return opened;
}

template <class Function>
Function next(const char* name) {
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

bool is_below(std::string_view path) {
    for (const auto& directory : steering()->below) {
        const std::string_view wanted{directory.data()};
        if (!wanted.empty() && path.starts_with(wanted)) return true;
    }
    return false;
}

// Returns the errno with which this call must fail, or 0 if it must not fail.
int fate(Kind kind, const char* call, const char* path) {
    Steering* const steer = steering();
    if (steer == nullptr || (steer->kinds & kind) == 0 || !is_below(path)) return 0;
    const std::uint64_t number = ++steer->calls;
    if (number < steer->from || number >= steer->to) return 0;
    ++steer->failed;
    std::snprintf(steer->last_failed.data(), steer->last_failed.size(), "%s %s", call, path);
    return steer->error_number;
}

// Finds the path of the descriptor. Returns false if that is not possible.
bool find_path(int descriptor, char (&path)[PATH_MAX]) {
    char link[64];
    std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    const ssize_t length = ::readlink(link, path, sizeof path - 1);
    path[length < 0 ? 0 : length] = '\0';
    return length > 0;
}

int fate_of(Kind kind, const char* call, int descriptor) {
    if (steering() == nullptr || (steering()->kinds & kind) == 0) return 0;
    char path[PATH_MAX];
    return find_path(descriptor, path) ? fate(kind, call, path) : 0;
}

// Returns the path that openat() refers to.
const char* path_below(int directory, const char* path, char (&whole)[2 * PATH_MAX]) {
    char parent[PATH_MAX];
    if (steering() == nullptr || path[0] == '/' || !find_path(directory, parent)) return path;
    std::snprintf(whole, sizeof whole, "%s/%s", parent, path);
    return whole;
}

int fail_with(int error_number) {
    errno = error_number;
    return -1;
}

constexpr bool has_mode(int flags) {
    return (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
}

int fate_of_open(const char* path, int flags, const char* call) {
    return fate(has_mode(flags) ? kind_create : kind_open, call, path);
}

template <class Write>
ssize_t write_or_fail(const char* call, int descriptor, std::size_t size, Write write) {
    const int what = fate_of(kind_write, call, descriptor);
    if (what > 0) return fail_with(what);
    return write(what == short_write && size > 1 ? size / 2 : size);
}

}  // namespace

#define STORMCELLAR_MODE(flags)                                     \
    std::va_list more;                                              \
    va_start(more, flags);                                          \
    const mode_t mode = has_mode(flags) ? va_arg(more, mode_t) : 0; \
    va_end(more)

extern "C" {

ssize_t write(int file, const void* bytes, std::size_t size) {
    static const auto real = next<ssize_t (*)(int, const void*, std::size_t)>("write");
    return write_or_fail("write", file, size, [&](std::size_t n) { return real(file, bytes, n); });
}

ssize_t pwrite(int file, const void* bytes, std::size_t size, off_t offset) {
    static const auto real = next<ssize_t (*)(int, const void*, std::size_t, off_t)>("pwrite");
    return write_or_fail("pwrite", file, size,
                         [&](std::size_t n) { return real(file, bytes, n, offset); });
}

ssize_t pwrite64(int file, const void* bytes, std::size_t size, off64_t offset) {
    static const auto real = next<ssize_t (*)(int, const void*, std::size_t, off64_t)>("pwrite64");
    return write_or_fail("pwrite64", file, size,
                         [&](std::size_t n) { return real(file, bytes, n, offset); });
}

ssize_t writev(int file, const iovec* parts, int count) {
    static const auto real = next<ssize_t (*)(int, const iovec*, int)>("writev");
    const int what = fate_of(kind_write, "writev", file);
    if (what > 0) return fail_with(what);
    return real(file, parts, what == short_write && count > 1 ? count / 2 : count);
}

int ftruncate(int file, off_t size) noexcept {
    static const auto real = next<int (*)(int, off_t)>("ftruncate");
    const int what = fate_of(kind_truncate, "ftruncate", file);
    return what > 0 ? fail_with(what) : real(file, size);
}

int ftruncate64(int file, off64_t size) noexcept {
    static const auto real = next<int (*)(int, off64_t)>("ftruncate64");
    const int what = fate_of(kind_truncate, "ftruncate64", file);
    return what > 0 ? fail_with(what) : real(file, size);
}

// This call returns the error number and does not set errno.
int posix_fallocate64(int file, off64_t offset, off64_t size) {
    static const auto real = next<int (*)(int, off64_t, off64_t)>("posix_fallocate64");
    const int what = fate_of(kind_truncate, "posix_fallocate64", file);
    return what > 0 ? what : real(file, offset, size);
}

int posix_fallocate(int file, off_t offset, off_t size) {
    static const auto real = next<int (*)(int, off_t, off_t)>("posix_fallocate");
    const int what = fate_of(kind_truncate, "posix_fallocate", file);
    return what > 0 ? what : real(file, offset, size);
}

int fsync(int file) {
    static const auto real = next<int (*)(int)>("fsync");
    const int what = fate_of(kind_sync, "fsync", file);
    return what > 0 ? fail_with(what) : real(file);
}

int fdatasync(int file) {
    static const auto real = next<int (*)(int)>("fdatasync");
    const int what = fate_of(kind_sync, "fdatasync", file);
    return what > 0 ? fail_with(what) : real(file);
}

int rename(const char* from, const char* to) noexcept {
    static const auto real = next<int (*)(const char*, const char*)>("rename");
    const int what = fate(kind_rename, "rename", to);
    return what > 0 ? fail_with(what) : real(from, to);
}

int unlink(const char* path) noexcept {
    static const auto real = next<int (*)(const char*)>("unlink");
    const int what = fate(kind_remove, "unlink", path);
    return what > 0 ? fail_with(what) : real(path);
}

int mkdir(const char* path, mode_t mode) noexcept {
    static const auto real = next<int (*)(const char*, mode_t)>("mkdir");
    const int what = fate(kind_create, "mkdir", path);
    return what > 0 ? fail_with(what) : real(path, mode);
}

int open(const char* path, int flags, ...) {
    STORMCELLAR_MODE(flags);
    static const auto real = next<int (*)(const char*, int, ...)>("open");
    const int what = fate_of_open(path, flags, "open");
    return what > 0 ? fail_with(what) : real(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
    STORMCELLAR_MODE(flags);
    static const auto real = next<int (*)(const char*, int, ...)>("open64");
    const int what = fate_of_open(path, flags, "open64");
    return what > 0 ? fail_with(what) : real(path, flags, mode);
}

int openat(int directory, const char* path, int flags, ...) {
    STORMCELLAR_MODE(flags);
    static const auto real = next<int (*)(int, const char*, int, ...)>("openat");
    char whole[2 * PATH_MAX];
    const int what = fate_of_open(path_below(directory, path, whole), flags, "openat");
    return what > 0 ? fail_with(what) : real(directory, path, flags, mode);
}

ssize_t read(int file, void* bytes, std::size_t size) {
    static const auto real = next<ssize_t (*)(int, void*, std::size_t)>("read");
    const int what = fate_of(kind_read, "read", file);
    return what > 0 ? fail_with(what) : real(file, bytes, size);
}

ssize_t pread(int file, void* bytes, std::size_t size, off_t offset) {
    static const auto real = next<ssize_t (*)(int, void*, std::size_t, off_t)>("pread");
    const int what = fate_of(kind_read, "pread", file);
    return what > 0 ? fail_with(what) : real(file, bytes, size, offset);
}

ssize_t pread64(int file, void* bytes, std::size_t size, off64_t offset) {
    static const auto real = next<ssize_t (*)(int, void*, std::size_t, off64_t)>("pread64");
    const int what = fate_of(kind_read, "pread64", file);
    return what > 0 ? fail_with(what) : real(file, bytes, size, offset);
}

}  // extern "C"
