#include "stormcellar/export/grid_netcdf.h"

#include <algorithm>
#include <array>
#include <chrono>

#include <netcdf.h>

#include "export/grid_coordinates.h"
#include "export/moment_text.h"
#include "export/netcdf_builder.h"
#include "stormcellar/grid/method.h"

namespace stormcellar::netcdf {
namespace {

using grid::CellStatus;
using grid::Grid;

constexpr std::size_t largest_chunk_side = 512;

struct Dimensions {
    int time, z, y, x;
};

std::string joined(const std::vector<std::string>& parts, const char* separator) {
    return fmt::format("{}", fmt::join(parts, separator));
}

// Writes cells in the order of the file: x fastest, then y, then z. It goes row by row, so that
// both reads and writes stay within the processor's cache.
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
    file.text(time, "long_name", grid.frame_time ? "frame time" : "start of the volume");
    const int z = file.variable("z", NC_DOUBLE, {size.z});
    define_coordinate(file, z, "altitude", "m", "Z");
    file.text(z, "positive", "up");
    file.text(z, "long_name", "height above mean sea level");
    const std::array<double, 1> seconds = {
        std::chrono::duration<double>(grid.frame_time.value_or(grid.time).time_since_epoch())
            .count()};
    file.write(time, seconds);
    file.write(z, std::span(grid.spec.levels_m));
    write_map_axes(file, grid.spec, {size.y, size.x});
}

int define_field(NetcdfBuilder& file, const char* name, int type, const Dimensions& size,
                 const grid::GridSpec& spec, int deflate_level) {
    const int variable = file.variable(name, type, {size.time, size.z, size.y, size.x});
    file.chunks(variable, {1, 1, std::min<std::size_t>(spec.ny, largest_chunk_side),
                           std::min<std::size_t>(spec.nx, largest_chunk_side)});
    file.deflate(variable, deflate_level);
    refer_to_map(file, variable, spec);
    return variable;
}

struct DetailText {
    const char* name;
    const char* long_name;
    const char* units;
    std::string comment;
};

DetailText describe_detail(grid::Detail detail, const Grid& grid) {
    switch (detail) {
        case grid::Detail::age:
            return {"age", "time of observation from the time of the grid", "s",
                    fmt::format("seconds after {}, negative before it: mean of the nearest radials "
                                "of the sweeps that the cell is made of, by weight",
                                format_utc(grid.frame_time.value_or(grid.time)))};
        case grid::Detail::height_offset:
            return {"beam_height_offset", "height of the cell above the centre of the nearest beam",
                    "m", "of the sweeps that the cell is made of"};
        case grid::Detail::distance:
            return {"gate_distance", "distance from the cell to the centre of the nearest gate",
                    "m", "of the nearest gates of the sweeps that the cell is made of"};
        case grid::Detail::weight:
            break;
    }
    return {"sample_weight", "share of the cell's weight that was seen", "1",
            "the rest lies in gaps or beyond the gates; below one half a cell is not seen"};
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
    file.text(field, "cell_methods",
              grid::cell_extent_of(grid.provenance.method) == grid::CellExtent::area
                  ? "area: mean"
                  : "area: point");
    std::string beside = "status";
    for (const grid::Detail detail : grid::all_details) {
        if (grid.details.set().has(detail))
            beside += fmt::format(" {}", describe_detail(detail, grid).name);
    }
    if (!grid.site_counts.empty()) beside += " site_count";
    if (!grid.site_weights.empty()) beside += " site_weight";
    file.text(field, "ancillary_variables", beside);
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

void write_details(NetcdfBuilder& file, const Grid& grid, const Dimensions& size,
                   int deflate_level) {
    for (const grid::Detail detail : grid::all_details) {
        if (!grid.details.set().has(detail)) continue;
        const DetailText text = describe_detail(detail, grid);
        const int variable =
            define_field(file, text.name, NC_FLOAT, size, grid.spec, deflate_level);
        constexpr float fill = NC_FILL_FLOAT;
        file.fill_value(variable, fill);
        file.text(variable, "long_name", text.long_name);
        file.text(variable, "units", text.units);
        file.text(variable, "comment", text.comment);
        const auto cells = in_file_order<float>(grid.spec, [&](std::size_t cell) {
            return grid.details.at(detail, cell).value_or(fill);
        });
        file.write(variable, std::span(cells));
    }
}

// Writes the counts and weights of a mosaic. Both are known everywhere, and are 0 where no site
// sees a cell.
void write_overlap(NetcdfBuilder& file, const Grid& grid, const Dimensions& size,
                   int deflate_level) {
    if (!grid.site_counts.empty()) {
        const int count =
            define_field(file, "site_count", NC_SHORT, size, grid.spec, deflate_level);
        file.text(count, "long_name", "number of sites that see the cell");
        file.text(count, "standard_name", "number_of_observations");
        file.text(count, "units", "1");
        const auto cells = in_file_order<int>(
            grid.spec, [&](std::size_t cell) { return static_cast<int>(grid.site_counts[cell]); });
        file.write(count, std::span(cells));
    }
    if (!grid.site_weights.empty()) {
        const int weight =
            define_field(file, "site_weight", NC_FLOAT, size, grid.spec, deflate_level);
        file.text(weight, "long_name", "sum of the weights of the sites that see the cell");
        file.text(weight, "units", "1");
        file.text(weight, "comment",
                  "of each site as the rule of overlap has it: exp(-r^2/L^2) at the arc r from the "
                  "site for distance-weighted, else 1; within 2^-11, at most 63");
        const auto cells = in_file_order<float>(
            grid.spec, [&](std::size_t cell) { return grid.site_weights[cell]; });
        file.write(weight, std::span(cells));
    }
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

// Returns a line for each class of ranges, over all sweeps.
std::string audit_text(const Grid& grid) {
    const std::string_view unit = grid::difference_unit(grid.moment);
    std::vector<std::string> lines = {"grid minus gates, scanned as the radar did"};
    for (const grid::AuditRow& row : grid::pooled_by_range(grid.provenance.audit))
        lines.push_back(fmt::format("{}: {}", grid::range_text(row), errors_text(row, unit)));
    return joined(lines, "\n");
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
    if (!from.effects.empty()) file.text(global, "effects", from.effects);
    if (!from.predicted_error.empty()) {
        file.text(global, "predicted_error", from.predicted_error);
    }
    file.text(global, "beam_model", from.beam_model);
    file.text(global, "averaging", from.averaging);
    if (from.vcp != 0) file.number(global, "vcp", from.vcp);
    file.text(global, "volume", from.partial ? "partial" : "complete");
    if (!from.notes.empty()) file.text(global, "notes", joined(from.notes, "\n"));
    if (!from.audit.empty()) file.text(global, "audit", audit_text(grid));
}

Status check(const Grid& grid, const GridWriteOptions& options) {
    if (auto valid = grid::validate(grid.spec); !valid) return pass_on(valid);
    const std::size_t cells = grid.spec.cell_count();
    if (grid.values.size() != cells || grid.status.size() != cells) {
        return fail(ErrorCode::bad_argument, "the grid has {} values and {} states for {} cells",
                    grid.values.size(), grid.status.size(), cells);
    }
    if (grid.details.set().any() && grid.details.size() != cells) {
        return fail(ErrorCode::bad_argument, "the grid has details of {} cells for {} cells",
                    grid.details.size(), cells);
    }
    for (const std::size_t have : {grid.site_counts.size(), grid.site_weights.size()}) {
        if (have == 0 || have == cells) continue;
        return fail(ErrorCode::bad_argument,
                    "the grid has counts or weights of {} cells for {} cells", have, cells);
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
    write_positions(file, grid.spec, {size.y, size.x}, options.deflate_level);
    write_field(file, grid, size, options.deflate_level);
    write_status(file, grid, size, options.deflate_level);
    write_details(file, grid, size, options.deflate_level);
    write_overlap(file, grid, size, options.deflate_level);
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
