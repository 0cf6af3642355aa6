// bench_grid: what gridding costs, beside the decompression that nobody can avoid.
//
// usage: bench_grid [--runs N] [FILE ...]      (default: 5 runs of the real volumes in LDM records)
// For each file, grid spec and number of threads one row, tab-separated under a head of keys:
//   file          its name
//   spec          columns x rows x levels @ spacing, about the site
//   threads       for decoding and gridding; libbz2 always has one
//   decode_s      seconds of level2::decode, the moment alone (REF)
//   geometry_s    azimuth and arc to every column
//   first_grid_s  gridding a decoded volume when there is no geometry yet: geometry and grid
//   grid_s        gridding a decoded volume with the geometry kept
//   write_s       the netCDF file
//   whole_s       what `stormcellar grid` does: decode, geometry, grid, write
//   libbz2_s      libbz2 alone over the same LDM records
//   ratio         (whole_s - write_s) / libbz2_s
//   mcells_per_s  10^6 cells a second of grid_s
//   peak_mib      peak resident memory of a process that decodes and grids the file once
// Times are the least of the runs, in each of which all are timed one behind the other. Files
// without LDM records, or without the moment, are left out.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "base/file_system.h"
#include "base/memory.h"
#include "bench/measure.h"
#include "export/grid_netcdf.h"
#include "grid/gridder.h"
#include "level2/decode.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

struct NamedSpec {
    const char* name;
    int side;
    double spacing_m;
    int levels;
    double level_step_m;
};
constexpr std::array<NamedSpec, 3> specs = {{
    {"512x512x32@1km", 512, 1000, 32, 500},
    {"920x920x32@0.5km", 920, 500, 32, 500},
    {"256x256x128@1km", 256, 1000, 128, 125},
}};

grid::GridSpec spec_about(const grid::SitePosition& site, const NamedSpec& named) {
    grid::GridSpec spec;
    spec.center_latitude_deg = site.latitude_deg;
    spec.center_longitude_deg = site.longitude_deg;
    spec.spacing_m = named.spacing_m;
    spec.nx = spec.ny = named.side;
    for (int level = 1; level <= named.levels; ++level)
        spec.levels_m.push_back(level * named.level_step_m);
    return spec;
}

Result<level2::Volume> decode_ref(const Bytes& bytes, int threads) {
    level2::DecodeOptions options;
    options.threads = threads;
    options.selection.moments = {level2::Moment::ref};
    auto decoded = level2::decode(bytes, options);
    if (!decoded) return pass_on(decoded);
    return std::move(decoded->volume);
}

Result<grid::SitePosition> site_of(const level2::Volume& volume) {
    const auto antenna = level2::antenna_position(volume);
    if (!antenna) return fail(ErrorCode::not_found, "no position");
    return grid::SitePosition{volume.station, antenna->latitude_deg, antenna->longitude_deg,
                              antenna->altitude_m};
}

// Least seconds of each phase.
struct Phases {
    double decode_s = HUGE_VAL, geometry_s = HUGE_VAL, first_grid_s = HUGE_VAL, grid_s = HUGE_VAL;
    double write_s = HUGE_VAL, whole_s = HUGE_VAL, libbz2_s = HUGE_VAL;
};

void run_once(const Bytes& bytes, const NamedSpec& named, int threads, const fs::path& netcdf,
              Phases& least) {
    Result<level2::Volume> volume = fail(ErrorCode::empty, "");
    const double decode_s = seconds_of([&] { volume = decode_ref(bytes, threads); });
    const auto site = site_of(volume.value()).value();
    const grid::GridSpec spec = spec_about(site, named);
    const grid::GridderOptions options{level2::Moment::ref, 0, threads};
    Result<std::shared_ptr<const grid::ColumnGeometry>> geometry = fail(ErrorCode::empty, "");
    const double geometry_s =
        seconds_of([&] { geometry = grid::make_column_geometry(site, spec); });
    Result<grid::Grid> grid = fail(ErrorCode::empty, "");
    const auto make = [&] { grid = grid::make_grid(*volume, site, **geometry, options); };
    const double first_s = seconds_of(make);
    const double write_s = seconds_of([&] {
        if (!netcdf::write_grid(real_file_system(), netcdf, *grid)) std::abort();
    });
    grid = fail(ErrorCode::empty, "");  // its memory is there for the next one
    keep_least_seconds(least.grid_s, make);
    least.decode_s = std::min(least.decode_s, decode_s);
    least.geometry_s = std::min(least.geometry_s, geometry_s);
    least.first_grid_s = std::min(least.first_grid_s, geometry_s + first_s);
    least.write_s = std::min(least.write_s, write_s);
    least.whole_s = std::min(least.whole_s, decode_s + geometry_s + first_s + write_s);
}

bool can_be_gridded(const Bytes& bytes) {
    const auto volume = decode_ref(bytes, 1);
    if (!volume) return false;
    const auto site = site_of(*volume);
    if (!site) return false;
    const auto geometry = grid::make_column_geometry(*site, spec_about(*site, specs[0]));
    return geometry && grid::make_grid(*volume, *site, **geometry, {}).has_value();
}

void measure(const fs::path& file, int runs) {
    const auto raw = read_file(file);
    if (!raw) {
        fmt::print(stderr, "{}\n", raw.error().message);
        return;
    }
    Bytes peeled;
    const auto records = ldm_records(*raw, peeled);
    if (records.empty() || !can_be_gridded(*raw)) return;
    const fs::path netcdf = fs::temp_directory_path() / fmt::format("bench_grid.{}.nc", ::getpid());
    for (const NamedSpec& named : specs) {
        for (const int threads : {1, 2}) {
            Phases least;
            for (int run = 0; run < runs; ++run) {
                keep_least_seconds(least.libbz2_s, [&] { decompress_all(records); });
                run_once(*raw, named, threads, netcdf, least);
            }
            const double cells = static_cast<double>(named.side) * named.side * named.levels;
            const auto peak =
                peak_mib({"--grid-once", file.string(), std::to_string(threads), named.name});
            fmt::print(
                "{}\t{}\t{}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.3f}"
                "\t{:.1f}\t{:.1f}\n",
                file.filename().string(), named.name, threads, least.decode_s, least.geometry_s,
                least.first_grid_s, least.grid_s, least.write_s, least.whole_s, least.libbz2_s,
                (least.whole_s - least.write_s) / least.libbz2_s, cells / 1e6 / least.grid_s,
                peak.value_or(-1));
            std::fflush(stdout);
        }
    }
    std::error_code ignored;
    fs::remove(netcdf, ignored);
}

int grid_once(const char* file, const char* threads, std::string_view spec) {
    const auto raw = read_file(file);
    if (!raw) return 1;
    const int count = static_cast<int>(number_in(threads));
    const auto volume = decode_ref(*raw, count);
    if (!volume) return 1;
    const auto site = site_of(*volume);
    if (!site) return 1;
    for (const NamedSpec& named : specs) {
        if (spec != named.name) continue;
        const auto geometry = grid::make_column_geometry(*site, spec_about(*site, named));
        const auto grid =
            grid::make_grid(*volume, *site, **geometry, {level2::Moment::ref, 0, count});
        if (!grid) return 1;
    }
    fmt::print("{}\n", high_water_kib());
    return 0;
}

int run(int argc, char** argv) {
    keep_freed_memory();
    if (argc == 5 && std::string(argv[1]) == "--grid-once") {
        return grid_once(argv[2], argv[3], argv[4]);
    }
    const Choice choice = choice_of(std::span(argv, static_cast<std::size_t>(argc)));
    if (choice.files.empty()) {
        fmt::print(stderr, "bench_grid: no files: name some, or set STORMCELLAR_DATA\n");
        return 3;
    }
    fmt::print(
        "file\tspec\tthreads\tdecode_s\tgeometry_s\tfirst_grid_s\tgrid_s\twrite_s\twhole_s\t"
        "libbz2_s\tratio\tmcells_per_s\tpeak_mib\n");
    for (const fs::path& file : choice.files)
        measure(file, choice.runs);
    return 0;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
