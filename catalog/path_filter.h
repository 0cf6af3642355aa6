// catalog/path_filter.h -- remembers a set of paths in a fixed amount of memory. Used only inside
// the catalog room.
//
// A PathFilter is a Bloom filter of 2 MiB. It always finds a path that was added. After a million
// additions, it also finds one in 500 of the paths that were not added; after four million, one in
// 7. Paths are never removed.
//
// Threads   Any thread.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "base/checksum.h"

namespace stormcellar::catalog {

class PathFilter {
  public:
    void add(std::string_view path) {
        for (const std::size_t bit : bits_of(path))
            words_[bit / word_bits].fetch_or(std::uint64_t{1} << bit % word_bits);
    }
    [[nodiscard]] bool may_have(std::string_view path) const {
        for (const std::size_t bit : bits_of(path)) {
            if ((words_[bit / word_bits].load() >> bit % word_bits & 1U) == 0) return false;
        }
        return true;
    }

  private:
    static constexpr std::size_t word_bits = 64, all_bits = std::size_t{1} << 24U;

    // Derives four bits from the two halves of one hash, by Kirsch and Mitzenmacher (2006).
    static std::array<std::size_t, 4> bits_of(std::string_view path) {
        const std::uint64_t hash = xxh3_64(std::as_bytes(std::span{path}));
        const std::uint64_t step = hash >> 32U | 1U;
        std::array<std::size_t, 4> bits{};
        for (std::size_t i = 0; i < bits.size(); ++i)
            bits.at(i) = static_cast<std::size_t>((hash + i * step) % all_bits);
        return bits;
    }

    std::vector<std::atomic<std::uint64_t>> words_ =
        std::vector<std::atomic<std::uint64_t>>(all_bits / word_bits);
};

}  // namespace stormcellar::catalog
