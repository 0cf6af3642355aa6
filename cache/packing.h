// cache/packing.h -- bricks of codes packed with LZ4, and the memory that they are unpacked into.
//
// Inside the cache room only. Thread contract: functions without state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::cache {

// The codes of one brick, packed; as they are where that is no shorter, and so never longer.
[[nodiscard]] std::vector<std::byte> pack_brick(std::span<const std::byte> codes);

// Fills all of `codes`. corrupt when `packed` does not give exactly that.
[[nodiscard]] Status unpack_brick(std::span<const std::byte> packed, std::span<std::byte> codes);

// Zeros in memory that is had from the system only where it is written, as the places of absent
// bricks are not.
class SparseMemory {
  public:
    SparseMemory() = default;  // nothing
    static Result<SparseMemory> of(std::uint64_t size);
    SparseMemory(SparseMemory&& other) noexcept
        : start_(std::exchange(other.start_, nullptr)), size_(std::exchange(other.size_, 0)) {}
    SparseMemory& operator=(SparseMemory&&) = delete;
    SparseMemory(const SparseMemory&) = delete;
    SparseMemory& operator=(const SparseMemory&) = delete;
    ~SparseMemory();
    [[nodiscard]] std::span<std::byte> bytes() const { return {start_, size_}; }

  private:
    SparseMemory(std::byte* start, std::size_t size) : start_(start), size_(size) {}
    std::byte* start_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace stormcellar::cache
