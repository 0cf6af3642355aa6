#include "cache/file_io.h"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/system_error.h"

namespace stormcellar::cache {
namespace {

tl::unexpected<Error> system_failure(int error_number) {
    return fail(error_code_of(error_number), "{}", std::system_category().message(error_number));
}

}  // namespace

Status read_at(const Descriptor& file, std::uint64_t offset, std::span<std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t n =
            ::pread(file.number(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return system_failure(errno);
        if (n == 0) return fail(ErrorCode::truncated, "ends at {} bytes", offset);
        bytes = bytes.subspan(static_cast<std::size_t>(n));
        offset += static_cast<std::uint64_t>(n);
    }
    return {};
}

Result<struct stat> facts_of(const Descriptor& file) {
    struct stat facts {};
    if (::fstat(file.number(), &facts) != 0) return system_failure(errno);
    if (S_ISDIR(facts.st_mode)) return fail(ErrorCode::not_a_file, "is a directory");
    if (!S_ISREG(facts.st_mode)) return fail(ErrorCode::not_a_file, "is not a regular file");
    return facts;
}

Status check_size(std::uint64_t found, std::uint64_t expected) {
    if (found < expected) {
        return fail(ErrorCode::truncated, "the file was cut: {} bytes of {}", found, expected);
    }
    if (found > expected) {
        return fail(ErrorCode::corrupt, "{} bytes where {} are expected", found, expected);
    }
    return {};
}

Result<Descriptor> open_for_reading(const std::filesystem::path& path) {
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.number() < 0) return system_failure(errno);
    return file;
}

Map::~Map() {
    // Release the registration first: after unmapping, the addresses may belong to another map.
    registration_.release();
    if (start_ != nullptr) ::munmap(const_cast<std::byte*>(start_), size_);
}

Result<Map> Map::of(const Descriptor& file, std::uint64_t size) {
    void* start = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file.number(), 0);
    if (start == MAP_FAILED) return system_failure(errno);
    return Map(static_cast<const std::byte*>(start), size);
}

tl::unexpected<Error> with_path(const std::filesystem::path& path, const Error& error) {
    return fail(error.code, "{}: {}", path.native(), error.message);
}

}  // namespace stormcellar::cache
