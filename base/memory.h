// base/memory.h -- how a process gets its large arrays, and what it does with freed memory.
//
// Threads   Any thread may call; the settings apply to the whole process.
#pragma once

#include <cstddef>
#include <vector>

namespace stormcellar {

// Keeps freed memory for later use, up to 128 MiB at the end of each of malloc's arenas. Otherwise
// glibc returns the arrays of each volume to the system and gets those of the next volume page by
// page, which takes up to a tenth of the time of decoding (docs/decisions.md). It is meant for the
// main() of a program that decodes one volume after another; a library leaves this to its program.
// With another C library it does nothing.
void keep_freed_memory();

// Limits malloc to this many arenas, each of which may keep 64 MiB and more at its end for good.
// glibc allows eight for each processor, and a program that keeps starting new threads comes to use
// all of them. With another C library it does nothing.
void hold_arenas(int most);

// Returns all freed memory to the system if more than `most_kept_bytes` of it are resident, in
// pieces of any size. Returns true if it did. It is meant for a program that runs for long, because
// memory that many small objects have used would otherwise stay. With another C library it does
// nothing.
bool give_back_freed_memory(std::size_t most_kept_bytes);

// Frees the memory of an array. `values = {}` empties it and keeps its memory.
template <class Value>
void free_array(std::vector<Value>& values) {
    std::vector<Value>{}.swap(values);
}

// Asks the system for large pages when this memory is first touched: 2 MiB at once instead of 4
// KiB, which takes a sixth of the time (docs/decisions.md). This is a hint. It does nothing if
// the system has no large pages, or for parts that do not fill whole large pages.
void prefer_large_pages(void* memory, std::size_t bytes);

// Returns an array of `size` zeros in large pages, for arrays that are written nearly everywhere.
template <class Value>
std::vector<Value> zeros_in_large_pages(std::size_t size) {
    std::vector<Value> values;
    values.reserve(size);
    prefer_large_pages(values.data(), size * sizeof(Value));
    values.resize(size);
    return values;
}

}  // namespace stormcellar
