// tests/fault/feed_volume.h -- simulated volumes for feeds. They are small, so that many are
// written quickly, and come in pieces as from a radar.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::fault {

struct FeedStorm {
    double east_km, north_km, major_km, minor_km, orientation_deg, core_km, top_km, peak_dbz;
};
// A scene of one radar and one volume. The lowest cut has 720 radials if `is_fine`.
struct FeedScene {
    std::string station;
    double latitude_deg, longitude_deg, altitude_m;
    std::vector<double> elevations_deg;
    bool is_fine;
    std::vector<FeedStorm> storms;
};
[[nodiscard]] std::string text_of(const FeedScene& scene);

// Returns the first volume that the scene's radar observes, with only `gates` gates in each radial.
// Throws if the scene is invalid.
[[nodiscard]] level2::Volume observed_volume(std::string_view scene, std::uint16_t gates);

// Returns the bytes of a file, divided at synth::piece_ends().
[[nodiscard]] std::vector<std::vector<std::byte>> pieces_of(const std::vector<std::byte>& bytes);

// Returns the names of the `count` chunks of a volume: "20240601-000000-001-S" and so on.
[[nodiscard]] std::vector<std::string> chunk_names(UtcTime start, std::size_t count);

}  // namespace stormcellar::fault
