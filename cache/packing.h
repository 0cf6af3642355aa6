// cache/packing.h -- packs bricks of codes with LZ4, and provides memory for unpacking them. Used
// only inside the cache room.
//
// Threads   Functions without state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::cache {

// Packs the codes of one brick. Returns the codes unchanged if packing would not make them shorter.
[[nodiscard]] std::vector<std::byte> pack_brick(std::span<const std::byte> codes);

// Unpacks into `codes`. Errors: corrupt if `packed` does not unpack to the size of `codes`.
[[nodiscard]] Status unpack_brick(std::span<const std::byte> packed, std::span<std::byte> codes);

// Memory that is all zeros at first. The system provides a page only when it is written, so the
// places of absent bricks take no memory.
class SparseMemory {
  public:
    SparseMemory() = default;  // empty
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
