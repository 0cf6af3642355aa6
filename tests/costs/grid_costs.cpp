// grid_costs: grids a volume in two functions whose executed instructions can be counted.
//
// usage: grid_costs FILE usual|cheapest MOMENT EAST_DEG
//
// One thread makes a grid of 512 x 512 x 32 cells at 1 km, centered EAST_DEG east of the site. It
// uses the default chain (usual), or a chain with every effect off (cheapest). The program prints
// one line, "CHECKSUM STATION MOMENT CHAIN", with a checksum of the bits of the cells.
// scripts/check-costs runs it under callgrind twice: with the usual library, and with a library
// that can make only this chain (stormcellar/grid/chosen.h). It compares the instructions of
// counted_geometry() and counted_grid(). Exit status: 0 done, 1 the work failed, 2 bad usage.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/checksum.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::grid {

using Geometry = std::shared_ptr<const ColumnGeometry>;

// Neither inlined nor cloned, because scripts/check-costs finds the function by its name in the
// output of callgrind.
[[gnu::noinline, gnu::noclone]] Result<Geometry> counted_geometry(const SitePosition& site,
                                                                  const GridSpec& spec,
                                                                  ChosenFrame frame) {
    return make_column_geometry(site, spec, frame);
}
[[gnu::noinline, gnu::noclone]] Result<Grid> counted_grid(const level2::Volume& volume,
                                                          const SitePosition& site,
                                                          const ColumnGeometry& geometry,
                                                          const GridderOptions& options) {
    return make_grid(volume, site, geometry, options);
}

namespace {

struct Chain {
    ChosenFrame frame;
    Method method;
};

// Returns the chain of a name. A library of one chain aborts when it makes any other chain.
std::optional<Chain> chain_named(std::string_view name) {
    if (name == "usual") return Chain{FrameKind::table, {}};
    if (name != "cheapest") return std::nullopt;
    Chain chain{FrameKind::sphere, {}};
    chain.method.beam = BeamKind::flat_earth;
    chain.method.interpolation = Interpolation::nearest;
    chain.method.radial_elevations = false;
    chain.method.on_circle = false;
    return chain;
}

GridSpec spec_about(double latitude_deg, double longitude_deg) {
    GridSpec spec;
    spec.center_latitude_deg = latitude_deg;
    spec.center_longitude_deg = longitude_deg;
    spec.spacing_m = 1000;
    spec.nx = spec.ny = 512;
    for (int level = 1; level <= 32; ++level)
        spec.levels_m.push_back(level * 500);
    return spec;
}

Result<std::string> run(const std::filesystem::path& file, const Chain& chain,
                        level2::Moment moment, double east_deg) {
    level2::DecodeOptions decoding;
    const std::string station = file.filename().string().substr(0, 4);
    if (find_station(station)) decoding.fallback_station = station;
    decoding.threads = 1;
    decoding.selection.moments = {moment};
    const auto decoded = level2::decode_file(file, decoding);
    if (!decoded) return pass_on(decoded);
    const level2::Volume& volume = decoded->volume;
    const auto antenna = level2::antenna_position(volume);
    if (!antenna) return fail(ErrorCode::not_found, "{}: no position", file.string());
    const SitePosition site{volume.station, antenna->latitude_deg, antenna->longitude_deg,
                            antenna->altitude_m};
    GridderOptions options;
    options.moment = moment;
    options.method = chain.method;
    const auto geometry = counted_geometry(
        site, spec_about(site.latitude_deg, site.longitude_deg + east_deg), chain.frame);
    if (!geometry) return pass_on(geometry);
    const auto grid = counted_grid(volume, site, **geometry, options);
    if (!grid) return pass_on(grid);
    const std::uint32_t checksum = crc32(std::as_bytes(std::span(grid->values)),
                                         crc32(std::as_bytes(std::span(grid->status))));
    return fmt::format("{:08x} {}", checksum, site.icao);
}

int main_with(std::span<const std::string_view> words) {
    const auto chain = words.size() == 5 ? chain_named(words[2]) : std::nullopt;
    const auto moment = chain ? level2::moment_from_name(words[3]) : std::nullopt;
    if (!moment) {
        fmt::print(stderr, "usage: grid_costs FILE usual|cheapest MOMENT EAST_DEG\n");
        return 2;
    }
    const auto line =
        run(std::string(words[1]), *chain, *moment, std::strtod(words[4].data(), nullptr));
    if (!line) {
        fmt::print(stderr, "{}\n", line.error().message);
        return 1;
    }
    fmt::print("{} {} {}\n", *line, words[3], words[2]);
    return 0;
}

}  // namespace
}  // namespace stormcellar::grid

int main(int argc, char** argv) {
    const std::vector<std::string_view> words(argv, argv + argc);
    return stormcellar::grid::main_with(words);
}
