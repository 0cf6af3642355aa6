// stormcellar/base/sparse_bytes.h -- a large array of bytes that takes memory only where it is
// written.
//
// Units     Sizes are in bytes.
// Threads   As for an ordinary array: different threads may write different bytes.
// Errors    The constructor throws std::bad_alloc if the system refuses the memory.
#pragma once

#include <cstddef>
#include <span>

namespace stormcellar {

// An array that is all zeros at first. An array of 32 MiB or more is a mapping of its own, in which
// pages that were never written neither take nor reserve memory. A smaller array comes from malloc,
// which is faster for small sizes. Moving leaves the source empty.
class SparseBytes {
  public:
    SparseBytes() = default;
    explicit SparseBytes(std::size_t size);
    SparseBytes(SparseBytes&& other) noexcept;
    SparseBytes& operator=(SparseBytes&& other) noexcept;
    SparseBytes(const SparseBytes&) = delete;
    SparseBytes& operator=(const SparseBytes&) = delete;
    ~SparseBytes();

    [[nodiscard]] std::byte* data() { return bytes_; }
    [[nodiscard]] std::span<const std::byte> bytes() const { return {bytes_, size_}; }
    [[nodiscard]] std::size_t size() const { return size_; }

  private:
    std::byte* bytes_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace stormcellar
