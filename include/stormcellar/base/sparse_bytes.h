// stormcellar/base/sparse_bytes.h -- a large array of bytes of which only what is written takes
// memory.
//
// Threads: as an array; different threads may write different bytes.
#pragma once

#include <cstddef>
#include <span>

namespace stormcellar {

// All zeros to begin with. From 32 MiB on it is a mapping of its own whose untouched pages take no
// memory, and none is set apart for them; below that it comes from malloc, which serves the small
// ones faster. Moves leave the source empty. Throws std::bad_alloc where the system refuses.
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
