#include <string>

#include "tests/bunzip/stream_maker.h"
#include "tests/fuzz/seeds.h"

namespace stormcellar::fuzz {
namespace {

using bunzip::Bytes;

// Returns the byte `kind` and then the bytes. The kind says whether the bytes are a stream,
// contents, contents and damage, or a plan.
Bytes behind(char kind, const Bytes& bytes) {
    Bytes seed{static_cast<std::byte>(kind)};
    seed.insert(seed.end(), bytes.begin(), bytes.end());
    return seed;
}

Bytes noise(std::size_t size, unsigned seed) {
    Bytes bytes;
    for (std::size_t i = 0; i < size; ++i) {
        seed = seed * 1'103'515'245 + 12'345;
        bytes.push_back(static_cast<std::byte>(seed >> 16));
    }
    return bytes;
}

}  // namespace

std::vector<Seed> bunzip_seeds() {
    const Bytes text = bunzip::bytes_of("a bandana and a banana, and again a bandana and a banana");
    std::vector<Seed> seeds = {
        {"empty", behind(0, bunzip::compressed({}, 9))},
        {"text", behind(0, bunzip::compressed(text, 9))},
        {"zeros", behind(0, bunzip::compressed(Bytes(100'000), 1))},
        {"noise", behind(0, bunzip::compressed(noise(3000, 1), 5))},
        {"many_zeros", behind(0, bunzip::compressed(Bytes(7'000'000), 1))},
        {"contents", behind(1, noise(600, 2))},
        {"long_contents", behind(1, noise(3000, 3))},
        {"damage", behind(2, noise(600, 4))},
    };
    for (unsigned i = 0; i < 12; ++i)
        seeds.push_back({"plan_" + std::to_string(i), behind(3, noise(200 + 300 * i, 5 + i))});
    return seeds;
}

}  // namespace stormcellar::fuzz
