// tests/fault/failing_calls.h -- controls failing_calls.so, a library that is loaded into the
// daemon (LD_PRELOAD) and makes the daemon's system calls fail.
//
// The file that $STORMCELLAR_FAILING_CALLS names holds one Steering. The test and the library map
// this file, so that the test may change the Steering while the daemon runs. Calls on files below a
// directory of `below` are counted if their kind is in `kinds`. Calls whose number is at least
// `from` (the first call is 1) and less than `to` fail.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace stormcellar::fault {

enum Kind : std::uint32_t {
    kind_write = 1,     // write, pwrite, writev, and their variants of 64 bits
    kind_truncate = 2,  // ftruncate, posix_fallocate
    kind_sync = 4,      // fsync, fdatasync
    kind_rename = 8,
    kind_create = 16,  // open with O_CREAT or O_TMPFILE, mkdir
    kind_open = 32,    // any other open
    kind_read = 64,    // read, pread
    kind_remove = 128,
};

// used instead of an errno: the call writes only half, without an error
inline constexpr int short_write = -1;

struct Steering {
    std::atomic<std::uint64_t> calls{0}, failed{0};
    std::atomic<std::uint64_t> from{UINT64_MAX}, to{UINT64_MAX};
    std::atomic<std::uint32_t> kinds{0};
    std::atomic<int> error_number{0};
    std::array<std::array<char, 256>, 3> below{};  // absolute; empty: none
    std::array<char, 256> last_failed{};           // the last call that failed, and its file
};

}  // namespace stormcellar::fault
