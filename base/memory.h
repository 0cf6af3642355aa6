// base/memory.h -- how a process gets its large arrays, and what it does with memory it has freed.
#pragma once

#include <cstddef>
#include <vector>

namespace stormcellar {

// Keeps freed memory for what comes next, up to 128 MiB at the end of each of malloc's arenas.
// Otherwise glibc gives the arrays of each volume back to the system, and those of the next one
// come page by page, which takes up to a tenth of the time of decoding (docs/performance.md). For
// the main() of a program that decodes one volume after another; a library leaves this to its
// program. Nothing happens where the C library is another one.
void keep_freed_memory();

// Gives all freed memory back where more than so many bytes of it are resident, in whatever pieces;
// says whether it did. For a program that runs for long: memory that many small things have used
// stays otherwise. Nothing happens where the C library is another one.
bool give_back_freed_memory(std::size_t most_kept_bytes);

// Asks the system for large pages where memory is touched from now on: 2 MiB at once instead of 4
// KiB, which takes a sixth of the time (docs/performance.md). A hint: nothing happens where the
// system has none, or to what lies beside whole large pages.
void prefer_large_pages(void* memory, std::size_t bytes);

// An array of `size` zeros in large pages, for what is written nearly all over.
template <class Value>
std::vector<Value> zeros_in_large_pages(std::size_t size) {
    std::vector<Value> values;
    values.reserve(size);
    prefer_large_pages(values.data(), size * sizeof(Value));
    values.resize(size);
    return values;
}

}  // namespace stormcellar
