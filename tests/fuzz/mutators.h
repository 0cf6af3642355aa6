// tests/fuzz/mutators.h -- mutates Level II bytes and grid files so that they pass the first
// checks.
//
// Randomly changed bytes almost never pass the checksums of bzip2 or the checks of a message
// header. These functions mutate records and messages as units, and pack again what they unpacked.
//
// Threads   The functions change only the given `Random`, and call the given `MutateBytes`.
#pragma once

#include <cstddef>
#include <functional>
#include <random>
#include <span>

#include "tests/level2/wire.h"

namespace stormcellar::fuzz {

using level2::wire::Bytes;
using Random = std::minstd_rand;
// Mutates any bytes; the result is at most `most` bytes long.
using MutateBytes = std::function<Bytes(Bytes bytes, std::size_t most)>;

// Returns a random number below `limit`, or 0 if `limit` is 0.
inline std::size_t below(Random& random, std::size_t limit) {
    return limit == 0 ? 0 : random() % limit;
}

// These functions return a mutation of their input. The mutation has at most `most` bytes, and may
// be longer than the input.
[[nodiscard]] Bytes mutate_container(const Bytes& file, std::size_t most, Random& random,
                                     const MutateBytes& mutate);
// Mutates an input of check_live(): eight bytes that decide the order of arrival, and a file.
[[nodiscard]] Bytes mutate_live(const Bytes& input, std::size_t most, Random& random,
                                const MutateBytes& mutate);
[[nodiscard]] Bytes mutate_messages(const Bytes& stream, std::size_t most, Random& random,
                                    const MutateBytes& mutate);
// Mutates a grid file, and usually corrects its checksums.
[[nodiscard]] Bytes mutate_grid_file(const Bytes& file, std::size_t most, Random& random,
                                     const MutateBytes& mutate);

}  // namespace stormcellar::fuzz
