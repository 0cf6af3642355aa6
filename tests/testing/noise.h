// tests/testing/noise.h -- random bytes that are the same on every machine.
#pragma once

#include <cstddef>
#include <random>
#include <vector>

namespace stormcellar::testing {

// Returns random bytes below `kinds`. The smaller `kinds` is, the better the bytes compress; with
// 256 they do not compress.
template <class Random>
[[nodiscard]] std::vector<std::byte> noise(std::size_t size, unsigned kinds, Random& random) {
    std::vector<std::byte> bytes(size);
    for (std::byte& byte : bytes)
        byte = static_cast<std::byte>(random() % kinds);
    return bytes;
}
[[nodiscard]] inline std::vector<std::byte> noise(std::size_t size, unsigned kinds, unsigned seed) {
    std::mt19937 random(seed);
    return noise(size, kinds, random);
}

}  // namespace stormcellar::testing
