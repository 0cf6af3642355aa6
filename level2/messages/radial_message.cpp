#include "level2/messages/radial_message.h"

namespace stormcellar::level2 {
namespace {

constexpr double degrees_per_code = 180.0 / 32768.0;

}  // namespace

bool RadialMessage::add(const MomentBlock& block) {
    if (moment_count == max_moments) return false;
    for (const MomentBlock& other : moments()) {
        if (other.moment == block.moment) return false;
    }
    moment_store[moment_count++] = block;
    return true;
}

float azimuth_from_code(std::uint16_t code) {
    return static_cast<float>(code * degrees_per_code);
}

float elevation_from_code(std::uint16_t code) {
    const double angle = code * degrees_per_code;
    return static_cast<float>(angle > 180 ? angle - 360 : angle);
}

}  // namespace stormcellar::level2
