#include "export/grid_netcdf.h"

#include <algorithm>
#include <array>
#include <chrono>

#include <netcdf.h>

#include "export/moment_text.h"
#include "export/netcdf_builder.h"
#include "grid/beam_geometry.h"
#include "grid/column_geometry.h"
#include "grid/site_frame.h"

namespace stormcellar::netcdf {
namespace {

using grid::CellStatus;
using grid::Grid;

constexpr std::size_t largest_chunk_side = 512;
constexpr const char* mapping_name = "azimuthal_equidistant";

struct Dimensions {
    int time, z, y, x;
};

std::string joined(const std::vector<std::string>& parts, const char* separator) {
    return fmt::format("{}", fmt::join(parts, separator));
}

// Cells in the file's order: x fastest, then y, then z. Row by row, so that reads and writes both
// stay within the processor's cache.
template <class Cell, class From>
std::vector<Cell> in_file_order(const grid::GridSpec& spec, From from) {
    std::vector<Cell> cells(spec.cell_count());
    const std::size_t level_size = spec.column_count();
    const auto width = static_cast<std::size_t>(spec.nx);
    for (int iy = 0; iy < spec.ny; ++iy) {
        for (int iz = 0; iz < spec.nz(); ++iz) {
            Cell* to = cells.data() + static_cast<std::size_t>(iz) * level_size +
                       static_cast<std::size_t>(iy) * width;
            std::size_t at = spec.index(0, iy, iz);
            for (std::size_t ix = 0; ix < width; ++ix, at += spec.levels_m.size())
                to[ix] = from(at);
        }
    }
    return cells;
}

void define_coordinate(NetcdfBuilder& file, int variable, const char* standard_name,
                       const char* units, const char* axis) {
    file.text(variable, "standard_name", standard_name);
    file.text(variable, "units", units);
    file.text(variable, "axis", axis);
}

void write_axes(NetcdfBuilder& file, const Grid& grid, const Dimensions& size) {
    const int time = file.variable("time", NC_DOUBLE, {size.time});
    define_coordinate(file, time, "time", "seconds since 1970-01-01T00:00:00Z", "T");
    file.text(time, "calendar", "standard");
    file.text(time, "long_name", "start of the volume");
    const int z = file.variable("z", NC_DOUBLE, {size.z});
    define_coordinate(file, z, "altitude", "m", "Z");
    file.text(z, "positive", "up");
    file.text(z, "long_name", "height above mean sea level");
    const int y = file.variable("y", NC_DOUBLE, {size.y});
    define_coordinate(file, y, "projection_y_coordinate", "m", "Y");
    file.text(y, "long_name", "distance north of the centre");
    const int x = file.variable("x", NC_DOUBLE, {size.x});
    define_coordinate(file, x, "projection_x_coordinate", "m", "X");
    file.text(x, "long_name", "distance east of the centre");

    const std::array<double, 1> seconds = {
        std::chrono::duration<double>(grid.time.time_since_epoch()).count()};
    file.write(time, seconds);
    file.write(z, std::span(grid.spec.levels_m));
    std::vector<double> places_m;
    places_m.reserve(static_cast<std::size_t>(std::max(grid.spec.nx, grid.spec.ny)));
    for (int iy = 0; iy < grid.spec.ny; ++iy)
        places_m.push_back(grid.spec.y_m(iy));
    file.write(y, std::span<const double>(places_m));
    places_m.clear();
    for (int ix = 0; ix < grid.spec.nx; ++ix)
        places_m.push_back(grid.spec.x_m(ix));
    file.write(x, std::span<const double>(places_m));
}

void write_positions(NetcdfBuilder& file, const grid::GridSpec& spec, const Dimensions& size,
                     int deflate_level) {
    std::vector<double> latitudes_deg;
    std::vector<double> longitudes_deg;
    for (int iy = 0; iy < spec.ny; ++iy) {
        for (int ix = 0; ix < spec.nx; ++ix) {
            const grid::GeoPoint point = grid::column_position(spec, ix, iy);
            latitudes_deg.push_back(point.latitude_deg);
            longitudes_deg.push_back(point.longitude_deg);
        }
    }
    const auto write = [&](const char* name, const char* standard_name, const char* units,
                           const std::vector<double>& values) {
        const int variable = file.variable(name, NC_DOUBLE, {size.y, size.x});
        file.deflate(variable, deflate_level);
        file.text(variable, "standard_name", standard_name);
        file.text(variable, "units", units);
        file.write(variable, std::span(values));
    };
    write("lat", "latitude", "degrees_north", latitudes_deg);
    write("lon", "longitude", "degrees_east", longitudes_deg);
}

void write_mapping(NetcdfBuilder& file, const grid::GridSpec& spec) {
    const int mapping = file.variable(mapping_name, NC_INT, {});
    file.text(mapping, "grid_mapping_name", mapping_name);
    file.number(mapping, "latitude_of_projection_origin", spec.center_latitude_deg);
    file.number(mapping, "longitude_of_projection_origin", spec.center_longitude_deg);
    file.number(mapping, "false_easting", 0.0);
    file.number(mapping, "false_northing", 0.0);
    file.number(mapping, "semi_major_axis", grid::wgs84_semi_major_m);
    file.number(mapping, "inverse_flattening", 1 / grid::wgs84_flattening);
    file.number(mapping, "longitude_of_prime_meridian", 0.0);
    file.text(
        mapping, "comment",
        "x and y are geodesic on WGS84 from the centre; heights above mean sea level are used "
        "as heights above the ellipsoid (about 1 m at 230 km)");
}

int define_field(NetcdfBuilder& file, const char* name, int type, const Dimensions& size,
                 const grid::GridSpec& spec, int deflate_level) {
    const int variable = file.variable(name, type, {size.time, size.z, size.y, size.x});
    file.chunks(variable, {1, 1, std::min<std::size_t>(spec.ny, largest_chunk_side),
                           std::min<std::size_t>(spec.nx, largest_chunk_side)});
    file.deflate(variable, deflate_level);
    file.text(variable, "coordinates", "lat lon");
    file.text(variable, "grid_mapping", mapping_name);
    return variable;
}

void write_field(NetcdfBuilder& file, const Grid& grid, const Dimensions& size, int deflate_level) {
    const std::string name{level2::moment_name(grid.moment)};
    const int field = define_field(file, name.c_str(), NC_FLOAT, size, grid.spec, deflate_level);
    constexpr float fill = NC_FILL_FLOAT;
    file.fill_value(field, fill);
    const MomentText names = text_of(grid.moment);
    file.text(field, "long_name", names.long_name);
    if (names.cf_name != nullptr) file.text(field, "standard_name", names.cf_name);
    file.text(field, "units", level2::moment_units(grid.moment));
    file.text(field, "cell_methods", "area: point");
    file.text(field, "ancillary_variables", "status");
    const auto values = in_file_order<float>(grid.spec, [&](std::size_t cell) {
        return grid.status[cell] == CellStatus::value ? grid.values[cell] : fill;
    });
    file.write(field, std::span(values));
}

void write_status(NetcdfBuilder& file, const Grid& grid, const Dimensions& size,
                  int deflate_level) {
    const int status = define_field(file, "status", NC_BYTE, size, grid.spec, deflate_level);
    file.text(status, "long_name", "what a cell holds");
    file.text(status, "standard_name", "status_flag");
    std::array<signed char, 4> flags{};
    std::string meanings;
    for (std::size_t i = 0; i < flags.size(); ++i) {
        flags[i] = static_cast<signed char>(i);
        if (i > 0) meanings += ' ';
        meanings += grid::cell_status_name(static_cast<CellStatus>(i));
    }
    file.bytes(status, "flag_values", flags);
    file.text(status, "flag_meanings", meanings);
    file.text(
        status, "comment",
        "not_seen: blind region, beyond range, missing radials or sweeps; no_echo: seen, below "
        "the radar's threshold; range_folded: echo from beyond the unambiguous range");
    const auto cells = in_file_order<signed char>(
        grid.spec, [&](std::size_t cell) { return static_cast<signed char>(grid.status[cell]); });
    file.write(status, std::span(cells));
}

void write_sites(NetcdfBuilder& file, const Grid& grid) {
    std::vector<double> latitudes_deg;
    std::vector<double> longitudes_deg;
    std::vector<double> altitudes_m;
    for (const grid::SitePosition& site : grid.sites) {
        latitudes_deg.push_back(site.latitude_deg);
        longitudes_deg.push_back(site.longitude_deg);
        altitudes_m.push_back(site.altitude_m);
    }
    if (grid.sites.empty()) return;
    file.numbers(NetcdfBuilder::file, "station_latitude_deg", latitudes_deg);
    file.numbers(NetcdfBuilder::file, "station_longitude_deg", longitudes_deg);
    file.numbers(NetcdfBuilder::file, "station_antenna_altitude_m", altitudes_m);
}

void write_provenance(NetcdfBuilder& file, const Grid& grid) {
    constexpr int global = NetcdfBuilder::file;
    const grid::Provenance& from = grid.provenance;
    const std::string stations = joined(from.stations, " ");
    const std::string version = "stormcellar " + from.software_version;
    file.text(global, "Conventions", "CF-1.8");
    file.text(global, "title",
              fmt::format("{} {} gridded, {}", stations, level2::moment_name(grid.moment),
                          format_utc(grid.time)));
    file.text(global, "source", "weather radar Level II volumes");
    file.text(global, "history",
              fmt::format("{}: {} of {}", version, from.method, joined(from.source_files, ", ")));
    file.text(global, "software_version", version);
    file.text(global, "stations", stations);
    write_sites(file, grid);
    file.text(global, "source_files", joined(from.source_files, "\n"));
    file.text(global, "time_coverage_start", format_utc(grid.start_time));
    file.text(global, "time_coverage_end", format_utc(grid.end_time));
    file.text(global, "method", from.method);
    file.text(global, "beam_model", from.beam_model);
    file.text(global, "averaging", from.averaging);
    if (from.vcp != 0) file.number(global, "vcp", from.vcp);
    file.text(global, "volume", from.partial ? "partial" : "complete");
    if (!from.notes.empty()) file.text(global, "notes", joined(from.notes, "\n"));
}

Status check(const Grid& grid, const GridWriteOptions& options) {
    if (auto valid = grid::validate(grid.spec); !valid) return pass_on(valid);
    const std::size_t cells = grid.spec.cell_count();
    if (grid.values.size() != cells || grid.status.size() != cells) {
        return fail(ErrorCode::bad_argument, "the grid has {} values and {} states for {} cells",
                    grid.values.size(), grid.status.size(), cells);
    }
    if (options.deflate_level < 0 || options.deflate_level > 9) {
        return fail(ErrorCode::bad_argument, "the deflate level must be 0 to 9, not {}",
                    options.deflate_level);
    }
    return {};
}

Result<std::vector<std::byte>> build(const Grid& grid, const GridWriteOptions& options) {
    const std::lock_guard lock(library_mutex());
    NetcdfBuilder file;
    const Dimensions size{file.dimension("time", 1), file.dimension("z", grid.spec.levels_m.size()),
                          file.dimension("y", static_cast<std::size_t>(grid.spec.ny)),
                          file.dimension("x", static_cast<std::size_t>(grid.spec.nx))};
    write_provenance(file, grid);
    write_axes(file, grid, size);
    write_mapping(file, grid.spec);
    write_positions(file, grid.spec, size, options.deflate_level);
    write_field(file, grid, size, options.deflate_level);
    write_status(file, grid, size, options.deflate_level);
    return file.finish();
}

}  // namespace

Status write_grid(FileSystem& file_system, const std::filesystem::path& path, const Grid& grid,
                  const GridWriteOptions& options) {
    if (auto good = check(grid, options); !good) return pass_on(good);
    const auto bytes = build(grid, options);
    if (!bytes) return fail(bytes.error().code, "{}: {}", path.string(), bytes.error().message);
    return write_file_atomically(file_system, path, *bytes);
}

}  // namespace stormcellar::netcdf
