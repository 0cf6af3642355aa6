#include "bench/feed_kinds.h"

#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "level2/decode.h"
#include "synth/observe.h"
#include "synth/scene.h"

namespace stormcellar::bench {
namespace {

constexpr std::string_view simulated = "simulated-";

// A line of storms that crosses the radar's view in an hour, in rain. Noise, clutter and jitter, so
// that it compresses as real volumes do.
constexpr std::string_view storm_line = R"(
[radar]
station = "KTLX"

[volumes]
count = 12
start = "2024-06-01T00:00:00Z"
interval_s = 300

[[cut]]
elevation_deg = 0.5
waveform = "surveillance"
azimuth_rate_deg_s = 21

[[cut]]
elevation_deg = 1.5
azimuth_rate_deg_s = 20

[[cut]]
elevation_deg = 5
azimuth_rate_deg_s = 25

[[cut]]
elevation_deg = 14
azimuth_rate_deg_s = 28

[instrument]
seed = 4
noise_db = 1
velocity_noise_mps = 1
velocity_folding = "on"
range_folding = "on"
azimuth_jitter_deg = 0.1
elevation_jitter_deg = 0.05

[instrument.clutter]
peak_dbz = 50
range_km = 30
texture_db = 6

[[layer]]
position_km = [-20, 0]
velocity_mps = [14, 5]
radii_km = [190, 150]
orientation_deg = 40
top_km = 9
peak_dbz = 28
melting_km = 3.2
bright_band_db = 8
bright_band_depth_km = 0.4
ripple_db = 6
ripple_length_km = 12

[[storm]]
position_km = [-75, -40]
velocity_mps = [18, 8]
radii_km = [22, 12]
orientation_deg = 30
core_km = 4.5
top_km = 15
peak_dbz = 60
tilt = [0.5, 0.3]
ripple_db = 5
ripple_length_km = 8

[[storm]]
position_km = [-55, 25]
velocity_mps = [18, 8]
radii_km = [18, 14]
core_km = 4
top_km = 14
peak_dbz = 57
ripple_db = 4
ripple_length_km = 9
)";

FeedKind real(std::vector<std::string> files, int minutes) {
    return {std::move(files), std::chrono::minutes{minutes}};
}

}  // namespace

std::string FeedKind::volume_at(int slot) const {
    if (files.empty()) return fmt::format("{}{}", simulated, slot);
    return files[static_cast<std::size_t>(slot) % files.size()];
}

std::span<const FeedKind> feed_kinds() {
    static const FeedKind migrating_birds =
        real({"mosaic-northeast/KCCX20100911_013442_V03.gz"}, 10);
    static const FeedKind drizzle = real({"mosaic-northeast/KOKX20100911_011047_V03.gz"}, 10);
    static const FeedKind coast = real({"mosaic-northeast/KDIX20100911_011759_V03.gz"}, 10);
    static const FeedKind recombined = real({"mosaic-northeast/KDOX20100911_012056_V04.gz"}, 10);
    static const FeedKind clear_air = real({"volumes/KABR20050101_000745.gz"}, 10);
    static const FeedKind sequence =
        real({"sequence-kbgm/KBGM20050822_024414.gz", "sequence-kbgm/KBGM20050822_025001.gz",
              "sequence-kbgm/KBGM20050822_025549.gz", "sequence-kbgm/KBGM20050822_030243.gz",
              "sequence-kbgm/KBGM20050822_030830.gz"},
             6);
    static const FeedKind storms{{}, std::chrono::minutes{5}};
    static const std::vector<FeedKind> kinds = {migrating_birds, storms,   recombined, drizzle,
                                                sequence,        storms,   coast,      recombined,
                                                storms,          clear_air};
    return kinds;
}

Result<level2::Volume> feed_volume(const std::string& name, const std::filesystem::path& data) {
    if (name.starts_with(simulated)) {
        int number = 0;
        std::from_chars(name.data() + simulated.size(), name.data() + name.size(), number);
        const auto scene = synth::parse_scene(storm_line, "a line of storms");
        if (!scene) return pass_on(scene);
        return synth::observe(*scene, number);
    }
    auto decoded = level2::decode_file(data / name);
    if (!decoded) return pass_on(decoded);
    return std::move(decoded->volume);
}

}  // namespace stormcellar::bench
