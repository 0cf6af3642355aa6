#include "base/memory.h"

#include <cstdlib>

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

}  // namespace stormcellar
