#include "pipeline/keep/instance_lock.h"

#include <array>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "base/printable.h"

namespace stormcellar::pipeline {
namespace {

std::string holder(int descriptor) {
    std::array<char, 32> text{};
    const ssize_t length = ::pread(descriptor, text.data(), text.size(), 0);
    if (length <= 0) return "unknown";
    const std::string_view line(text.data(), static_cast<std::size_t>(length));
    return printable(line.substr(0, line.find('\n')));
}

}  // namespace

Result<InstanceLock> InstanceLock::acquire(const std::filesystem::path& state) {
    const std::filesystem::path path = state / file_name;
    Descriptor file{::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644)};
    if (!file.is_open()) {
        return fail(errno == EACCES ? ErrorCode::permission : ErrorCode::io, "{}: {}",
                    path.native(), std::system_category().message(errno));
    }
    if (::flock(file.number(), LOCK_EX | LOCK_NB) != 0) {
        if (errno == EWOULDBLOCK) {
            return fail(ErrorCode::busy,
                        "{}: another stormcellard (process {}) uses this state directory",
                        path.native(), holder(file.number()));
        }
        return fail(ErrorCode::io, "{}: {}", path.native(), std::system_category().message(errno));
    }
    // Write the process number for people to read. The lock itself needs no content.
    const std::string id = fmt::format("{}\n", ::getpid());
    if (::ftruncate(file.number(), 0) != 0 ||
        ::pwrite(file.number(), id.data(), id.size(), 0) < 0) {
        return fail(ErrorCode::io, "{}: {}", path.native(), std::system_category().message(errno));
    }
    return InstanceLock(std::move(file));
}

}  // namespace stormcellar::pipeline
