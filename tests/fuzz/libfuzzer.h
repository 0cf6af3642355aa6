// tests/fuzz/libfuzzer.h -- the functions that libFuzzer calls, and those that it offers to
// mutators.
#pragma once

#include <algorithm>
#include <cstdint>

#include "tests/fuzz/mutators.h"

extern "C" {
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                    unsigned seed);
std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
}

namespace stormcellar::fuzz {

inline Bytes mutate_bytes(Bytes bytes, std::size_t most) {
    const std::size_t size = std::min(bytes.size(), most);
    bytes.resize(most);
    bytes.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), size, most));
    return bytes;
}

// Implements LLVMFuzzerCustomMutator with one of the mutators.
template <class Mutator>
std::size_t mutate_in_place(Mutator mutator, std::uint8_t* data, std::size_t size, std::size_t most,
                            unsigned seed) {
    const auto* begin = reinterpret_cast<const std::byte*>(data);
    Random random(seed);
    const Bytes changed = mutator({begin, begin + size}, most, random, mutate_bytes);
    std::copy(changed.begin(), changed.end(), reinterpret_cast<std::byte*>(data));
    return changed.size();
}

}  // namespace stormcellar::fuzz
