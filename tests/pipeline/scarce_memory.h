// A system that gives no memory: for a program with scarce_memory.cpp, which has an operator new of
// its own.
#pragma once

#include <cstdint>

namespace stormcellar::pipeline {

// While it stands this thread gets so many allocations of 1 KiB or more, and std::bad_alloc instead
// of all that follow. Smaller ones are given: large ones are what a system refuses first, and the
// C++ library itself ends the process where it gets none (directory_iterator's constructor is
// noexcept).
class WithMemoryFor {
  public:
    explicit WithMemoryFor(std::int64_t allocations);
    WithMemoryFor(const WithMemoryFor&) = delete;
    WithMemoryFor& operator=(const WithMemoryFor&) = delete;
    ~WithMemoryFor();
    // Whether the last one refused any.
    [[nodiscard]] static bool was_refused();
};

}  // namespace stormcellar::pipeline
