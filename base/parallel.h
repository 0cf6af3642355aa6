// base/parallel.h -- runs numbered pieces of work on several threads.
//
// Threads   Any thread may call.
#pragma once

#include <functional>

namespace stormcellar {

// Calls work(0) ... work(count - 1), each once, on up to `threads` threads, one of which is the
// caller's. Returns when all are done. If the system has no more threads, fewer do the work. The
// pieces must not depend on each other. If one throws, no further ones are begun, and the first
// exception is thrown to the caller.
void for_each_piece(int count, int threads, const std::function<void(int)>& work);

}  // namespace stormcellar
