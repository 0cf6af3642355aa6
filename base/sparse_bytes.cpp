#include "stormcellar/base/sparse_bytes.h"

#include <cstdlib>
#include <new>
#include <utility>

#include <sys/mman.h>

namespace stormcellar {
namespace {

constexpr std::size_t mapped_from_bytes = std::size_t{32} << 20;

}  // namespace

SparseBytes::SparseBytes(std::size_t size) : size_(size) {
    if (size == 0) return;
    if (size < mapped_from_bytes) {
        bytes_ = static_cast<std::byte*>(std::calloc(size, 1));
        if (bytes_ == nullptr) throw std::bad_alloc();
        return;
    }
    void* mapped = ::mmap(nullptr, size, PROT_READ | PROT_WRITE,
                          MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (mapped == MAP_FAILED) throw std::bad_alloc();
#ifdef MADV_NOHUGEPAGE
    // A large page would take memory for neighboring bytes that stay empty.
    ::madvise(mapped, size, MADV_NOHUGEPAGE);
#endif
    bytes_ = static_cast<std::byte*>(mapped);
}

SparseBytes::SparseBytes(SparseBytes&& other) noexcept
    : bytes_(std::exchange(other.bytes_, nullptr)), size_(std::exchange(other.size_, 0)) {}

SparseBytes& SparseBytes::operator=(SparseBytes&& other) noexcept {
    SparseBytes taken(std::move(other));
    std::swap(bytes_, taken.bytes_);
    std::swap(size_, taken.size_);
    return *this;
}

SparseBytes::~SparseBytes() {
    if (bytes_ == nullptr) return;
    if (size_ < mapped_from_bytes) {
        std::free(bytes_);
    } else {
        ::munmap(bytes_, size_);
    }
}

}  // namespace stormcellar
