#include "synth/counter_random.h"

#include <cmath>
#include <numbers>

namespace stormcellar::synth {

RandomWords philox(RandomWords counter, std::array<std::uint32_t, 2> key) {
    constexpr std::uint64_t multiplier_0 = 0xD2511F53;
    constexpr std::uint64_t multiplier_1 = 0xCD9E8D57;
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t a = multiplier_0 * counter[0];
        const std::uint64_t b = multiplier_1 * counter[2];
        counter = {static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key[0],
                   static_cast<std::uint32_t>(b),
                   static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key[1],
                   static_cast<std::uint32_t>(a)};
        key[0] += 0x9E3779B9U;
        key[1] += 0xBB67AE85U;
    }
    return counter;
}

RandomWords draw(std::uint32_t seed, Draw purpose, const DrawPlace& place) {
    return philox({place.gate, place.radial, place.cut, place.volume},
                  {seed, static_cast<std::uint32_t>(purpose)});
}

double uniform_of(std::uint32_t word) {
    return (static_cast<double>(word) + 0.5) / 4294967296.0;
}

NormalPair normals_of(std::uint32_t first, std::uint32_t second) {
    const double radius = std::sqrt(-2 * std::log(uniform_of(first)));
    const double angle = 2 * std::numbers::pi * uniform_of(second);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace stormcellar::synth
