#include <cstdint>
#include <string>

#include "tests/fuzz/mutators.h"
#include "tests/fuzz/seeds.h"

namespace stormcellar::fuzz {

std::vector<Seed> call_seeds() {
    std::vector<Seed> seeds;
    for (unsigned seed = 1; seed <= 8; ++seed) {
        Random random(seed);
        level2::wire::Bytes bytes(400);
        // The upper bits of these numbers are more random than the lower bits.
        for (std::byte& byte : bytes)
            byte = static_cast<std::byte>(random() >> 16U);
        seeds.push_back({"random_" + std::to_string(seed), std::move(bytes)});
    }
    return seeds;
}

}  // namespace stormcellar::fuzz
