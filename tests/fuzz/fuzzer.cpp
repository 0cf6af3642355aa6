// Defines the functions that libFuzzer calls. CMakeLists.txt compiles this file once for each
// property. STORMCELLAR_CHECK is the function of the property in properties.h; STORMCELLAR_MUTATE
// is its mutator, if it has one.
#include <algorithm>
#include <cstdint>

#include "tests/fuzz/mutators.h"
#include "tests/fuzz/properties.h"

namespace fuzz = stormcellar::fuzz;

extern "C" {

std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::STORMCELLAR_CHECK({reinterpret_cast<const std::byte*>(data), size});
    return 0;
}

#ifdef STORMCELLAR_MUTATE
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                    unsigned seed) {
    const auto mutate_bytes = [](fuzz::Bytes bytes, std::size_t limit) {
        const std::size_t used = std::min(bytes.size(), limit);
        bytes.resize(limit);
        auto* const first = reinterpret_cast<std::uint8_t*>(bytes.data());
        bytes.resize(LLVMFuzzerMutate(first, used, limit));
        return bytes;
    };
    const auto* const begin = reinterpret_cast<const std::byte*>(data);
    fuzz::Random random(seed);
    const fuzz::Bytes changed =
        fuzz::STORMCELLAR_MUTATE({begin, begin + size}, most, random, mutate_bytes);
    std::copy(changed.begin(), changed.end(), reinterpret_cast<std::byte*>(data));
    return changed.size();
}
#endif

}  // extern "C"
