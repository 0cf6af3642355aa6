#include "tests/batch/failing_reads.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace stormcellar::testing {
namespace {

std::string failing;
std::atomic<bool> any_fails{false};

bool fails(int descriptor) {
    if (!any_fails) return false;
    std::array<char, 4096> path{};
    const ssize_t length =
        ::readlink(fmt::format("/proc/self/fd/{}", descriptor).c_str(), path.data(), path.size());
    if (length < 0) return false;
    return std::string_view{path.data(), static_cast<std::size_t>(length)}.ends_with(failing);
}

}  // namespace

FailingReads::FailingReads(std::string ending) {
    failing = std::move(ending);
    any_fails = true;
}

FailingReads::~FailingReads() {
    any_fails = false;
}

}  // namespace stormcellar::testing

extern "C" ssize_t read(int descriptor, void* into, size_t count) {
    if (stormcellar::testing::fails(descriptor)) {
        errno = EIO;
        return -1;
    }
    return ::syscall(SYS_read, descriptor, into, count);
}

extern "C" ssize_t pread(int descriptor, void* into, size_t count, off_t offset) {
    if (stormcellar::testing::fails(descriptor)) {
        errno = EIO;
        return -1;
    }
    return ::syscall(SYS_pread64, descriptor, into, count, offset);
}
