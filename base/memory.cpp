#include "base/memory.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>

#include <sys/mman.h>
#include <unistd.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace stormcellar {

void keep_freed_memory() {
#ifdef __GLIBC__
    constexpr int most_kept_bytes = 128 << 20;
    // Larger blocks have mappings of their own, which are returned to the system at once.
    constexpr int mapped_from_bytes = 32 << 20;
    mallopt(M_TRIM_THRESHOLD, most_kept_bytes);
    mallopt(M_MMAP_THRESHOLD, mapped_from_bytes);
#endif
}

void hold_arenas(int most) {
#ifdef __GLIBC__
    mallopt(M_ARENA_MAX, most);
#else
    static_cast<void>(most);
#endif
}

#ifdef __GLIBC__
namespace {

// Returns the resident bytes that belong to no file: memory in use, memory that malloc keeps, and
// stacks.
std::size_t resident_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::size_t all = 0, resident = 0, of_files = 0;
    if (!(statm >> all >> resident >> of_files)) return 0;
    return (resident - of_files) * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace
#endif

bool give_back_freed_memory(std::size_t most_kept_bytes) {
#ifdef __GLIBC__
    // malloc may count memory as free that it has already returned to the system.
    const struct mallinfo2 info = mallinfo2();
    if (resident_bytes() <= info.uordblks + info.hblkhd + most_kept_bytes) return false;
    return malloc_trim(0) != 0;
#else
    static_cast<void>(most_kept_bytes);
    return false;
#endif
}

void prefer_large_pages(void* memory, std::size_t bytes) {
#ifdef MADV_HUGEPAGE
    constexpr std::size_t page = 4096;
    if (bytes < (std::size_t{2} << 20)) return;
    const std::size_t into_page = reinterpret_cast<std::uintptr_t>(memory) % page;
    const std::size_t before = into_page == 0 ? 0 : page - into_page;
    const std::size_t whole_pages = (bytes - before) / page * page;
    ::madvise(static_cast<std::byte*>(memory) + before, whole_pages, MADV_HUGEPAGE);
#else
    static_cast<void>(memory);
    static_cast<void>(bytes);
#endif
}

}  // namespace stormcellar
