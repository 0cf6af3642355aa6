#include "bench/feed_kinds.h"

#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "stormcellar/level2/decode.h"
#include "synth/observe.h"
#include "synth/synth_scene.h"

namespace stormcellar::bench {
namespace {

constexpr std::string_view simulated = "simulated-";

constexpr const char* storm_line = STORMCELLAR_SOURCE_DIRECTORY "/scenes/storm-line.toml";

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
        const auto scene = synth::read_scene(storm_line);
        if (!scene) return pass_on(scene);
        return synth::observe(*scene, number);
    }
    auto decoded = level2::decode_file(data / name);
    if (!decoded) return pass_on(decoded);
    return std::move(decoded->volume);
}

}  // namespace stormcellar::bench
