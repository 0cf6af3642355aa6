// base/parallel.h -- runs numbered pieces of work on several threads.
//
// Threads   Any thread may call.
#pragma once

#include <functional>

namespace stormcellar {

// Calls work(0) ... work(count - 1), each once, on up to `threads` threads, one of which is the
// caller's. Returns when all calls have returned. If the system has no more threads, fewer threads
// do the work. The calls must not depend on each other. If a call throws, no further calls begin,
// and the first exception is thrown to the caller.
void for_each_piece(int count, int threads, const std::function<void(int)>& work);

}  // namespace stormcellar
