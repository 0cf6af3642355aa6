// base/memory.h -- controls large pages and freed memory.
//
// Threads   Any thread may call; the settings apply to the whole process.
#pragma once

#include <cstddef>
#include <vector>

namespace stormcellar {

// Lets malloc keep freed memory for later use, up to 128 MiB at the end of each of its arenas.
// Otherwise glibc returns the arrays of each volume to the system and gets new arrays for the next
// volume page by page, which takes up to a tenth of the time of decoding (docs/decisions.md). Call
// it in main() of a program that decodes one volume after another, not in a library. Does nothing
// with another C library.
void keep_freed_memory();

// Limits malloc to this many arenas, each of which may keep 64 MiB or more of freed memory for
// good. By default, glibc allows eight arenas for each processor, and a program that keeps starting
// new threads uses all of them in time. Does nothing with another C library.
void hold_arenas(int most);

// Gives all freed memory back to the system if more than `most_kept_bytes` of it are resident.
// Returns true if some memory was given back. Call it in a program that runs for long, because
// malloc otherwise keeps the memory of many small objects. Does nothing with another C library.
bool give_back_freed_memory(std::size_t most_kept_bytes);

// Frees the memory of an array, unlike `values = {}`, which only empties it.
template <class Value>
void free_array(std::vector<Value>& values) {
    std::vector<Value>{}.swap(values);
}

// Asks the system to use large pages when this memory is first touched: 2 MiB at once instead of 4
// KiB, which takes a sixth of the time (docs/decisions.md). This is only a hint. It has no effect
// if the system has no large pages, or on parts that do not fill large pages.
void prefer_large_pages(void* memory, std::size_t bytes);

// Returns an array of `size` zeros, in large pages if possible. Use it for arrays that are written
// nearly everywhere.
template <class Value>
std::vector<Value> zeros_in_large_pages(std::size_t size) {
    std::vector<Value> values;
    values.reserve(size);
    prefer_large_pages(values.data(), size * sizeof(Value));
    values.resize(size);
    return values;
}

}  // namespace stormcellar
