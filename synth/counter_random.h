// synth/counter_random.h -- makes random numbers that depend only on their place in the data.
//
// A stateless, counter-based generator returns four words of 32 bits for each (seed, purpose,
// volume, cut, radial, gate). The words are the same in any order and on any number of threads.
//
// Source    Salmon, Moraes, Dror and Shaw (2011), Parallel random numbers: as easy as 1, 2, 3:
//           Philox4x32-10. A test compares it with their published answers.
// Threads   Pure functions.
#pragma once

#include <array>
#include <cstdint>

namespace stormcellar::synth {

using RandomWords = std::array<std::uint32_t, 4>;

[[nodiscard]] RandomWords philox(RandomWords counter, std::array<std::uint32_t, 2> key);

// The purpose of a number. Numbers for different purposes are independent.
enum class Draw : std::uint32_t {
    gate = 1,
    clutter = 2,
    jitter = 3,
    missing = 4,
    replay_fault = 5,
    gate_loss = 6
};

// The place that a number belongs to.
struct DrawPlace {
    std::uint32_t volume = 0;
    std::uint32_t cut = 0;
    std::uint32_t radial = 0;
    std::uint32_t gate = 0;
};
[[nodiscard]] RandomWords draw(std::uint32_t seed, Draw purpose, const DrawPlace& place);

// Returns a number in (0, 1). Each of its 2^32 values is equally likely.
[[nodiscard]] double uniform_of(std::uint32_t word);

// Two independent numbers with mean 0 and deviation 1 (Box and Muller 1958), in [-6.8, 6.8].
struct NormalPair {
    double first = 0;
    double second = 0;
};
[[nodiscard]] NormalPair normals_of(std::uint32_t first, std::uint32_t second);

}  // namespace stormcellar::synth
