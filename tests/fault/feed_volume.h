// tests/fault/feed_volume.h -- volumes for feeds that are made while a test runs: small ones, so
// that many are written quickly, and in the pieces in which they come.
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

// Returns what a radar sees of a scene's first volume: `gates` gates of each radial, and no others.
// Throws if the scene is not valid.
[[nodiscard]] level2::Volume observed_volume(std::string_view scene, std::uint16_t gates);

// A file's bytes in the pieces of synth::piece_ends().
[[nodiscard]] std::vector<std::vector<std::byte>> pieces_of(const std::vector<std::byte>& bytes);

// The names of the chunks of a volume that comes in so many: "20240601-000000-001-S" and so on.
[[nodiscard]] std::vector<std::string> chunk_names(UtcTime start, std::size_t count);

}  // namespace stormcellar::fault
