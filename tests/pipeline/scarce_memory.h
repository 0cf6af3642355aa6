// tests/pipeline/scarce_memory.h -- simulates a system without memory. Link the program with
// scarce_memory.cpp, which replaces operator new.
#pragma once

#include <cstdint>

namespace stormcellar::pipeline {

// While the object exists, this thread gets `allocations` allocations of 1 KiB or more. All later
// allocations of this size throw std::bad_alloc. Smaller allocations always succeed, because a
// system refuses large ones first, and because the C++ library ends the process if a small one
// fails in a noexcept function (directory_iterator's constructor).
class WithMemoryFor {
  public:
    explicit WithMemoryFor(std::int64_t allocations);
    WithMemoryFor(const WithMemoryFor&) = delete;
    WithMemoryFor& operator=(const WithMemoryFor&) = delete;
    ~WithMemoryFor();
    // Returns true if the last object refused an allocation.
    [[nodiscard]] static bool was_refused();
};

}  // namespace stormcellar::pipeline
