#include "cache/packing.h"

#include <algorithm>

#include <lz4.h>
#include <sys/mman.h>

namespace stormcellar::cache {

std::vector<std::byte> pack_brick(std::span<const std::byte> codes) {
    std::vector<std::byte> packed(codes.size());
    const int size = LZ4_compress_default(
        reinterpret_cast<const char*>(codes.data()), reinterpret_cast<char*>(packed.data()),
        static_cast<int>(codes.size()), static_cast<int>(packed.size()) - 1);
    if (size <= 0) return {codes.begin(), codes.end()};  // the packed form would not be shorter
    packed.resize(static_cast<std::size_t>(size));
    return packed;
}

Status unpack_brick(std::span<const std::byte> packed, std::span<std::byte> codes) {
    if (packed.size() == codes.size()) {
        std::copy(packed.begin(), packed.end(), codes.begin());
        return {};
    }
    const int size = LZ4_decompress_safe(
        reinterpret_cast<const char*>(packed.data()), reinterpret_cast<char*>(codes.data()),
        static_cast<int>(packed.size()), static_cast<int>(codes.size()));
    if (size != static_cast<int>(codes.size())) {
        return fail(ErrorCode::corrupt, "the packed codes do not give a whole brick");
    }
    return {};
}

Result<SparseMemory> SparseMemory::of(std::uint64_t size) {
    void* const start = ::mmap(nullptr, size, PROT_READ | PROT_WRITE,
                               MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (start == MAP_FAILED) {
        return fail(ErrorCode::io, "cannot reserve {} bytes of addresses", size);
    }
    return SparseMemory(static_cast<std::byte*>(start), size);
}

SparseMemory::~SparseMemory() {
    if (start_ != nullptr) ::munmap(start_, size_);
}

}  // namespace stormcellar::cache
