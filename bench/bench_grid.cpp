// bench_grid: compares the time of gridding with the time of decompression alone.
//
// usage: bench_grid [--data DIR] [--threads N] [--runs N] [--json] [FILE ...]
//   (bench/request.h; every real volume in LDM records, unless files are named)
// There is a row for each file, grid spec and number of threads:
//   file          name of the file
//   spec          columns x rows x levels @ spacing; the site is in the middle
//   threads       number of threads that decode and grid; libbz2 always has one
//   decode_s      time of level2::decode for one moment (REF)
//   geometry_s    time to compute azimuth and arc of every column
//   first_grid_s  time to grid a decoded volume whose geometry must be computed, too
//   grid_s        time to grid a decoded volume whose geometry is kept
//   write_s       time to write the netCDF file
//   whole_s       time of the program `stormcellar grid`, from start to end
//   libbz2_s      time of libbz2 alone for the same LDM records
//   ratio         (whole_s - the program's time for writing netCDF) / libbz2_s
//   mcells_per_s  10^6 cells a second during grid_s
//   peak_mib      peak resident memory of a process that decodes and grids the file once
// Times are in seconds, the least of the runs. In each run, all phases are timed one after another.
// Files without LDM records have no libbz2_s and no ratio; files without the moment are left out.
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

#include "base/memory.h"
#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/export/grid_netcdf.h"
#include "stormcellar/grid/gridder.h"

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

// The least seconds of each phase.
struct Phases {
    double decode_s = HUGE_VAL, geometry_s = HUGE_VAL, first_grid_s = HUGE_VAL, grid_s = HUGE_VAL;
    double write_s = HUGE_VAL, whole_s = HUGE_VAL, libbz2_s = HUGE_VAL;
    double unwritten_s = HUGE_VAL;  // whole_s without the write

    [[nodiscard]] double ratio() const {
        return std::isfinite(libbz2_s) ? unwritten_s / libbz2_s : HUGE_VAL;
    }
};

// Returns the number of a `"key": number` in a JSON text.
double seconds_said(std::string_view json, std::string_view key) {
    const std::size_t at = json.find(fmt::format("\"{}\": ", key));
    if (at == std::string_view::npos) return 0;
    return std::strtod(json.data() + at + key.size() + 4, nullptr);
}

void run_once(const fs::path& file, const Bytes& bytes, const NamedSpec& named, int threads,
              const fs::path& netcdf, Phases& least) {
    Result<level2::Volume> volume = fail(ErrorCode::empty, "");
    const double decode_s =
        seconds_of([&] { volume = decode_ref(bytes, file.filename().native(), threads); });
    const auto site = site_of(volume.value()).value();
    const grid::GridSpec spec = spec_about(site, named);
    const grid::GridderOptions options{level2::Moment::ref, 0, threads, {}, {}};
    Result<std::shared_ptr<const grid::ColumnGeometry>> geometry = fail(ErrorCode::empty, "");
    const double geometry_s =
        seconds_of([&] { geometry = grid::make_column_geometry(site, spec); });
    Result<grid::Grid> grid = fail(ErrorCode::empty, "");
    const std::string levels = fmt::format("{0}:{1}:{0}", named.level_step_m / 1000,
                                           named.levels * named.level_step_m / 1000);
    const double side_km = named.side * named.spacing_m / 1000;
    const auto whole = run_program(
        built_program("cli/stormcellar"),
        {"grid", file.string(), "-o", netcdf.string(), "--json", "--threads",
         std::to_string(threads), "--extent-km", fmt::format("{0},{0}", side_km), "--spacing-km",
         fmt::format("{}", named.spacing_m / 1000), "--levels-km", levels});
    if (whole) {
        least.whole_s = std::min(least.whole_s, whole->seconds);
        least.unwritten_s =
            std::min(least.unwritten_s, whole->seconds - seconds_said(whole->said, "write_s"));
    }
    const auto make = [&] { grid = grid::make_grid(*volume, site, **geometry, options); };
    const double first_s = seconds_of(make);
    const double write_s = seconds_of([&] {
        if (!netcdf::write_grid(real_file_system(), netcdf, *grid)) std::abort();
    });
    grid = fail(ErrorCode::empty, "");  // frees its memory for the next grid
    keep_least_seconds(least.grid_s, make);
    least.decode_s = std::min(least.decode_s, decode_s);
    least.geometry_s = std::min(least.geometry_s, geometry_s);
    least.first_grid_s = std::min(least.first_grid_s, geometry_s + first_s);
    least.write_s = std::min(least.write_s, write_s);
}

bool can_be_gridded(const fs::path& file, const Bytes& bytes) {
    const auto volume = decode_ref(bytes, file.filename().native(), 1);
    if (!volume) return false;
    const auto site = site_of(*volume);
    if (!site) return false;
    const auto geometry = grid::make_column_geometry(*site, spec_about(*site, specs[0]));
    return geometry && grid::make_grid(*volume, *site, **geometry, {}).has_value();
}

Row row_of(const fs::path& file, const NamedSpec& named, int threads, const Phases& least) {
    const double cells = static_cast<double>(named.side) * named.side * named.levels;
    const auto peak = peak_mib({"--grid-once", file.string(), std::to_string(threads), named.name});
    return {{"file", file.filename().string()},
            {"spec", named.name},
            {"threads", threads},
            {"decode_s", {least.decode_s, 4}},
            {"geometry_s", {least.geometry_s, 4}},
            {"first_grid_s", {least.first_grid_s, 4}},
            {"grid_s", {least.grid_s, 4}},
            {"write_s", {least.write_s, 4}},
            {"whole_s", {least.whole_s, 4}},
            {"libbz2_s", {least.libbz2_s, 4}},
            {"ratio", {least.ratio(), 3}},
            {"mcells_per_s", {cells / 1e6 / least.grid_s, 1}},
            {"peak_mib", {peak, 1}}};
}

void measure(const fs::path& file, const Request& request, Table& table) {
    const auto found = read_records(file);
    if (!found || !can_be_gridded(file, found->raw)) return;
    const fs::path netcdf = fs::temp_directory_path() / fmt::format("bench_grid.{}.nc", ::getpid());
    for (const NamedSpec& named : specs) {
        for (const int threads : request.threads) {
            Phases least;
            for (int run = 0; run < request.runs; ++run) {
                if (!found->records.empty())
                    keep_least_seconds(least.libbz2_s, [&] { decompress_all(found->records); });
                run_once(file, found->raw, named, threads, netcdf, least);
            }
            table.add(row_of(file, named, threads, least));
        }
    }
    std::error_code ignored;
    fs::remove(netcdf, ignored);
}

int grid_once(const char* file, const char* threads, std::string_view spec) {
    const int count = static_cast<int>(number_in(threads));
    const auto named = std::find_if(specs.begin(), specs.end(),
                                    [&](const NamedSpec& one) { return spec == one.name; });
    const auto volume = decode_ref(fs::path{file}, count);
    if (!volume || named == specs.end()) return 1;
    const auto site = site_of(*volume);
    if (!site) return 1;
    const auto geometry = grid::make_column_geometry(*site, spec_about(*site, *named));
    if (!grid::make_grid(*volume, *site, **geometry, {level2::Moment::ref, 0, count, {}, {}}))
        return 1;
    fmt::print("{}\n", high_water_kib());
    return 0;
}

int run(int argc, char** argv) {
    keep_freed_memory();
    if (argc == 5 && std::string(argv[1]) == "--grid-once") {
        return grid_once(argv[2], argv[3], argv[4]);
    }
    return run_over_files(
        {"bench_grid", "[FILE ...]", "what gridding costs beside libbz2 over the same LDM records"},
        std::span(argv, static_cast<std::size_t>(argc)), measure);
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
