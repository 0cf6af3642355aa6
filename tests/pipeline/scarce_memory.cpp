#include "tests/pipeline/scarce_memory.h"

#include <cstdlib>
#include <new>

namespace stormcellar::pipeline {
namespace {

thread_local std::int64_t left = -1;  // below 0: no limit
thread_local bool refused = false;

void* allocate(std::size_t size, std::size_t alignment) {
    const bool counts = size >= 1024;
    if (counts && left == 0) {
        refused = true;
        throw std::bad_alloc{};
    }
    if (counts && left > 0) --left;
    const std::size_t whole = alignment == 0 ? size + (size == 0 ? 1 : 0)
                                             : (size + alignment - 1) / alignment * alignment;
    void* memory = alignment == 0 ? std::malloc(whole) : std::aligned_alloc(alignment, whole);
    if (memory == nullptr) throw std::bad_alloc{};
    return memory;
}

}  // namespace

WithMemoryFor::WithMemoryFor(std::int64_t allocations) {
    refused = false;
    left = allocations;
}
WithMemoryFor::~WithMemoryFor() {
    left = -1;
}
bool WithMemoryFor::was_refused() {
    return refused;
}

}  // namespace stormcellar::pipeline

void* operator new(std::size_t size) {
    return stormcellar::pipeline::allocate(size, 0);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return stormcellar::pipeline::allocate(size, static_cast<std::size_t>(alignment));
}
// AddressSanitizer's own nothrow operator would not call our operator above.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    try {
        return stormcellar::pipeline::allocate(size, 0);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    std::free(memory);
}
