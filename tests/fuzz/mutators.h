// tests/fuzz/mutators.h -- changes to Level II bytes and grid files that reach behind the checks.
//
// Bytes changed at random almost never get past bzip2's checksums or a message's header. These
// change records and messages as such, and pack again what they unpacked.
// Thread contract: functions are pure but for the `Random` and the `MutateBytes` they are given.
#pragma once

#include <cstddef>
#include <functional>
#include <random>
#include <span>

#include "tests/level2/wire.h"

namespace stormcellar::fuzz {

using level2::wire::Bytes;
using Random = std::minstd_rand;
// Changes any bytes in any way; the result is at most `most` bytes long.
using MutateBytes = std::function<Bytes(Bytes bytes, std::size_t most)>;

// Any whole number below `limit`; 0 where there is none.
inline std::size_t below(Random& random, std::size_t limit) {
    return limit == 0 ? 0 : random() % limit;
}

// Results are at most `most` bytes long, which is more than the bytes given.
[[nodiscard]] Bytes mutate_container(const Bytes& file, std::size_t most, Random& random,
                                     const MutateBytes& mutate);
// A file as above, behind eight bytes that decide in which order its parts arrive.
[[nodiscard]] Bytes mutate_live(const Bytes& input, std::size_t most, Random& random,
                                const MutateBytes& mutate);
[[nodiscard]] Bytes mutate_messages(const Bytes& stream, std::size_t most, Random& random,
                                    const MutateBytes& mutate);
// A grid file; its checksums are made right again most of the time.
[[nodiscard]] Bytes mutate_grid_file(const Bytes& file, std::size_t most, Random& random,
                                     const MutateBytes& mutate);

}  // namespace stormcellar::fuzz
