// base/parallel.h -- runs numbered pieces of work on several threads.
#pragma once

#include <functional>

namespace stormcellar {

// Calls work(0) ... work(count - 1), each once, on up to `threads` threads, the caller's among
// them; returns when all are done. When the system gives no more threads, fewer do the work. The
// pieces must not depend on each other. Where one throws, no further ones are begun, and what the
// first threw is thrown to the caller.
void for_each_piece(int count, int threads, const std::function<void(int)>& work);

}  // namespace stormcellar
