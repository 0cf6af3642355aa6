#include "tests/fault/feed_volume.h"

#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "synth/observe.h"
#include "synth/replay_pieces.h"

namespace stormcellar::fault {
namespace {

// Keeps only `gates` gates of each moment. The volume must have at least this many gates of 8 bits
// in each radial.
void cut_gates(level2::Volume& volume, std::uint16_t gates) {
    for (level2::Sweep& sweep : volume.sweeps) {
        for (level2::SweepMoment& moment : sweep.moments) {
            std::vector<std::uint8_t> codes;
            for (std::size_t radial = 0; radial < moment.gate_counts.size(); ++radial) {
                for (int gate = 0; gate < gates; ++gate)
                    codes.push_back(static_cast<std::uint8_t>(moment.code(radial, gate)));
                moment.gate_counts[radial] = gates;
            }
            moment.codes8 = std::move(codes);
            moment.gate_stride = gates;
        }
    }
}

}  // namespace

std::string text_of(const FeedScene& scene) {
    std::string text = fmt::format(
        "[radar]\nstation = \"{}\"\nlatitude_deg = {}\nlongitude_deg = {}\naltitude_m = {}\n"
        "[volumes]\ncount = 1\nstart = \"2024-06-01T00:00:00Z\"\n",
        scene.station, scene.latitude_deg, scene.longitude_deg, scene.altitude_m);
    for (const double elevation_deg : scene.elevations_deg) {
        text += fmt::format(
            "[[cut]]\nelevation_deg = {}\nazimuth_rate_deg_s = 36\nwaveform = \"surveillance\"\n",
            elevation_deg);
        if (scene.is_fine && elevation_deg == scene.elevations_deg.front())
            text += "azimuth_spacing_deg = 0.5\n";
    }
    for (const FeedStorm& storm : scene.storms) {
        text += fmt::format(
            "[[storm]]\nposition_km = [{}, {}]\nvelocity_mps = [10, 5]\nradii_km = [{}, {}]\n"
            "orientation_deg = {}\ncore_km = {}\ntop_km = {}\npeak_dbz = {}\n",
            storm.east_km, storm.north_km, storm.major_km, storm.minor_km, storm.orientation_deg,
            storm.core_km, storm.top_km, storm.peak_dbz);
    }
    return text;
}

level2::Volume observed_volume(std::string_view scene, std::uint16_t gates) {
    const auto parsed = synth::parse_scene(scene, "feed");
    if (!parsed) throw std::runtime_error(parsed.error().message);
    level2::Volume volume = synth::observe(*parsed, 0);
    cut_gates(volume, gates);
    return volume;
}

std::vector<std::vector<std::byte>> pieces_of(const std::vector<std::byte>& bytes) {
    std::vector<std::vector<std::byte>> pieces;
    std::size_t begin = 0;
    for (const std::size_t end : synth::piece_ends(bytes)) {
        pieces.emplace_back(bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                            bytes.begin() + static_cast<std::ptrdiff_t>(end));
        begin = end;
    }
    return pieces;
}

std::vector<std::string> chunk_names(UtcTime start, std::size_t count) {
    const std::string time = format_compact(start);
    std::vector<std::string> names;
    for (std::size_t i = 0; i < count; ++i) {
        const char kind = i == 0 ? 'S' : i + 1 == count ? 'E' : 'I';
        names.push_back(
            fmt::format("{}-{}-{:03}-{}", time.substr(0, 8), time.substr(9), i + 1, kind));
    }
    return names;
}

}  // namespace stormcellar::fault
