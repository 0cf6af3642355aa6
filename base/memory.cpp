#include "base/memory.h"

#include <cstdint>
#include <cstdlib>

#include <sys/mman.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace stormcellar {

void keep_freed_memory() {
#ifdef __GLIBC__
    constexpr int most_kept_bytes = 128 << 20;
    // Larger blocks are mapped by themselves, and go back at once.
    constexpr int mapped_from_bytes = 32 << 20;
    mallopt(M_TRIM_THRESHOLD, most_kept_bytes);
    mallopt(M_MMAP_THRESHOLD, mapped_from_bytes);
#endif
}

void prefer_large_pages(void* memory, std::size_t bytes) {
#ifdef MADV_HUGEPAGE
    constexpr std::uintptr_t page = 4096;
    if (bytes < (std::size_t{2} << 20)) return;
    const auto start = reinterpret_cast<std::uintptr_t>(memory);
    const std::uintptr_t first = (start + page - 1) / page * page;
    const std::uintptr_t end = (start + bytes) / page * page;
    if (first < end) ::madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
#else
    static_cast<void>(memory);
    static_cast<void>(bytes);
#endif
}

}  // namespace stormcellar
