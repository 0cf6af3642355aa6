// tests/fuzz/mutators.h -- mutations of Level II bytes and grid files that get past the checks.
//
// Bytes changed at random almost never get past bzip2's checksums or the header of a message. These
// functions mutate records and messages as units, and pack again what they unpacked.
//
// Threads   Pure, apart from the `Random` and the `MutateBytes` they are given.
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

// Returns a whole number below `limit`; 0 if there is none.
inline std::size_t below(Random& random, std::size_t limit) {
    return limit == 0 ? 0 : random() % limit;
}

// Results are at most `most` bytes long, which may be more than the input.
[[nodiscard]] Bytes mutate_container(const Bytes& file, std::size_t most, Random& random,
                                     const MutateBytes& mutate);
// Mutates a file as above, which follows eight bytes that decide the order of arrival of its parts.
[[nodiscard]] Bytes mutate_live(const Bytes& input, std::size_t most, Random& random,
                                const MutateBytes& mutate);
[[nodiscard]] Bytes mutate_messages(const Bytes& stream, std::size_t most, Random& random,
                                    const MutateBytes& mutate);
// Mutates a grid file; most of the time its checksums are corrected.
[[nodiscard]] Bytes mutate_grid_file(const Bytes& file, std::size_t most, Random& random,
                                     const MutateBytes& mutate);

}  // namespace stormcellar::fuzz
