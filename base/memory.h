// base/memory.h -- what a process does with memory that it has freed.
#pragma once

namespace stormcellar {

// Keeps freed memory for what comes next, up to 128 MiB at the end of each of malloc's arenas.
// Otherwise glibc gives the arrays of each volume back to the system, and those of the next one
// come page by page, which takes up to a tenth of the time of decoding (docs/performance.md). For
// the main() of a program that decodes one volume after another; a library leaves this to its
// program. Nothing happens where the C library is another one.
void keep_freed_memory();

}  // namespace stormcellar
