#include "stormcellar/export/grid_netcdf.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include <netcdf.h>

#include "export/grid_coordinates.h"
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

// A grid in the file. It is the only one, or the file has grids of other moments, too.
struct Field {
    const Grid& grid;
    bool is_alone = true;

    // Returns the name of a variable of this moment. If the file has several moments, the name
    // begins with the moment.
    [[nodiscard]] std::string name_of(std::string_view variable) const {
        return is_alone ? std::string(variable)
                        : fmt::format("{}_{}", level2::moment_name(grid.moment), variable);
    }
};

std::string joined(const std::vector<std::string>& parts, const char* separator) {
    return fmt::format("{}", fmt::join(parts, separator));
}

// Returns the cells in the order of the file: x fastest, then y, then z. Copies row by row, so that
// reads and writes both stay within the processor's cache.
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

void write_axes(NetcdfBuilder& file, const Grid& grid, const Dimensions& size) {
    const int time = file.variable("time", NC_DOUBLE, {size.time});
    write_attributes(file, time,
                     time_attributes(grid.frame_time ? "frame time" : "start of the volume"));
    const int z = file.variable("z", NC_DOUBLE, {size.z});
    write_attributes(file, z, height_attributes());
    // A file has only one time. Without this, netCDF's chunk for an unlimited dimension would take
    // 4 kB.
    file.chunks(time, {1});
    const auto instant = grid.frame_time.value_or(grid.time).time_since_epoch();
    file.write_first(time, std::chrono::duration<double>(instant).count());
    file.write(z, std::span(grid.spec.levels_m));
    write_map_axes(file, grid.spec, {size.y, size.x});
}

int define_field(NetcdfBuilder& file, const std::string& name, int type, const Dimensions& size,
                 const grid::GridSpec& spec, int deflate_level) {
    const int variable = file.variable(name.c_str(), type, {size.time, size.z, size.y, size.x});
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

// Writes those facts of the provenance that differ between moments.
void write_making(NetcdfBuilder& file, int variable, const Grid& grid) {
    const grid::Provenance& from = grid.provenance;
    file.text(variable, "method", from.method);
    if (!from.effects.empty()) file.text(variable, "effects", from.effects);
    if (!from.predicted_error.empty()) {
        file.text(variable, "predicted_error", from.predicted_error);
    }
    file.text(variable, "beam_model", from.beam_model);
    file.text(variable, "averaging", from.averaging);
}

// Returns the notes of all grids. A note that several grids have appears once.
std::vector<std::string> notes_of(std::span<const Grid> grids) {
    std::vector<std::string> notes;
    for (const Grid& grid : grids) {
        for (const std::string& note : grid.provenance.notes) {
            const bool is_said =
                &grid != &grids.front() && std::ranges::find(notes, note) != notes.end();
            if (!is_said) notes.push_back(note);
        }
    }
    return notes;
}

void write_field(NetcdfBuilder& file, const Field& one, const Dimensions& size, int deflate_level) {
    const Grid& grid = one.grid;
    const std::string name{level2::moment_name(grid.moment)};
    const int field = define_field(file, name, NC_FLOAT, size, grid.spec, deflate_level);
    constexpr float fill = NC_FILL_FLOAT;
    file.fill_value(field, fill);
    write_attributes(file, field, field_attributes(grid.moment, grid.provenance.method));
    std::vector<std::string> beside = {one.name_of("status")};
    for (const grid::Detail detail : grid::all_details) {
        if (grid.details.set().has(detail))
            beside.push_back(one.name_of(describe_detail(detail, grid).name));
    }
    if (!grid.site_counts.empty()) beside.push_back(one.name_of("site_count"));
    if (!grid.site_weights.empty()) beside.push_back(one.name_of("site_weight"));
    file.text(field, "ancillary_variables", joined(beside, " "));
    if (!one.is_alone) write_making(file, field, grid);
    const auto values = in_file_order<float>(grid.spec, [&](std::size_t cell) {
        return grid.status[cell] == CellStatus::value ? grid.values[cell] : fill;
    });
    file.write(field, std::span(values));
}

void write_status(NetcdfBuilder& file, const Field& one, const Dimensions& size,
                  int deflate_level) {
    const Grid& grid = one.grid;
    const int status =
        define_field(file, one.name_of("status"), NC_BYTE, size, grid.spec, deflate_level);
    write_attributes(file, status, status_attributes(grid.moment));
    std::vector<std::string_view> meanings;
    std::vector<signed char> flags;
    for (const CellStatus state : grid::states_of(grid.moment)) {
        meanings.push_back(grid::cell_status_name(state));
        flags.push_back(static_cast<signed char>(state));
    }
    file.bytes(status, "flag_values", flags);
    file.text(status, "flag_meanings", fmt::format("{}", fmt::join(meanings, " ")));
    const auto cells = in_file_order<signed char>(
        grid.spec, [&](std::size_t cell) { return static_cast<signed char>(grid.status[cell]); });
    file.write(status, std::span(cells));
}

void write_details(NetcdfBuilder& file, const Field& one, const Dimensions& size,
                   int deflate_level) {
    const Grid& grid = one.grid;
    for (const grid::Detail detail : grid::all_details) {
        if (!grid.details.set().has(detail)) continue;
        const DetailText text = describe_detail(detail, grid);
        const int variable =
            define_field(file, one.name_of(text.name), NC_FLOAT, size, grid.spec, deflate_level);
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

// Writes the counts and weights of a mosaic. Every cell has them; they are 0 where no site sees the
// cell.
void write_overlap(NetcdfBuilder& file, const Field& one, const Dimensions& size,
                   int deflate_level) {
    const Grid& grid = one.grid;
    if (!grid.site_counts.empty()) {
        const int count =
            define_field(file, one.name_of("site_count"), NC_SHORT, size, grid.spec, deflate_level);
        file.text(count, "long_name", "number of sites that see the cell");
        file.text(count, "standard_name", "number_of_observations");
        file.text(count, "units", "1");
        const auto cells = in_file_order<int>(
            grid.spec, [&](std::size_t cell) { return static_cast<int>(grid.site_counts[cell]); });
        file.write(count, std::span(cells));
    }
    if (!grid.site_weights.empty()) {
        const int weight = define_field(file, one.name_of("site_weight"), NC_FLOAT, size, grid.spec,
                                        deflate_level);
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

// Returns the audit of a grid as text: a line for each class of ranges, over all sweeps.
std::string audit_text(const Grid& grid) {
    const std::string_view unit = grid::difference_unit(grid.moment);
    std::vector<std::string> lines = {"grid minus gates, scanned as the radar did"};
    for (const grid::AuditRow& row : grid::pooled_by_range(grid.provenance.audit))
        lines.push_back(fmt::format("{}: {}", grid::range_text(row), errors_text(row, unit)));
    return joined(lines, "\n");
}

// Writes the facts that all grids of the file share. If the file has a single grid, also writes the
// facts that differ between moments.
void write_provenance(NetcdfBuilder& file, std::span<const Grid> grids) {
    constexpr int global = NetcdfBuilder::file;
    const Grid& grid = grids.front();
    const bool is_alone = grids.size() == 1;
    const grid::Provenance& from = grid.provenance;
    const std::string stations = joined(from.stations, " ");
    const std::string version = "stormcellar " + from.software_version;
    std::vector<std::string> moments;
    std::vector<std::string> methods;
    for (const Grid& one : grids) {
        moments.emplace_back(level2::moment_name(one.moment));
        const std::string& method = one.provenance.method;
        if (std::ranges::find(methods, method) == methods.end()) methods.push_back(method);
    }
    const auto first = std::ranges::min_element(grids, {}, &Grid::start_time);
    const auto last = std::ranges::max_element(grids, {}, &Grid::end_time);
    file.text(global, "Conventions", "CF-1.8");
    file.text(
        global, "title",
        fmt::format("{} {} gridded, {}", stations, joined(moments, " "), format_utc(grid.time)));
    file.text(global, "source", "weather radar Level II volumes");
    file.text(global, "history",
              fmt::format("{}: {} of {}", version, joined(methods, ", "),
                          joined(from.source_files, ", ")));
    file.text(global, "software_version", version);
    file.text(global, "stations", stations);
    write_sites(file, grid);
    file.text(global, "source_files", joined(from.source_files, "\n"));
    file.text(global, "time_coverage_start", format_utc(first->start_time));
    file.text(global, "time_coverage_end", format_utc(last->end_time));
    if (is_alone) write_making(file, global, grid);
    if (from.vcp != 0) file.number(global, "vcp", from.vcp);
    const bool is_partial =
        std::ranges::any_of(grids, [](const Grid& one) { return one.provenance.partial; });
    file.text(global, "volume", is_partial ? "partial" : "complete");
    const std::vector<std::string> notes = notes_of(grids);
    if (!notes.empty()) file.text(global, "notes", joined(notes, "\n"));
    if (is_alone && !from.audit.empty()) file.text(global, "audit", audit_text(grid));
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

// Checks that one file can hold the grids, which it can if they have the same coordinates.
Status check_together(std::span<const Grid> grids) {
    if (grids.empty()) return fail(ErrorCode::bad_argument, "there is no grid to write");
    const Grid& first = grids.front();
    for (std::size_t at = 1; at < grids.size(); ++at) {
        const Grid& grid = grids[at];
        const std::string_view name = level2::moment_name(grid.moment);
        if (std::ranges::find(grids.first(at), grid.moment, &Grid::moment) !=
            grids.first(at).end()) {
            return fail(ErrorCode::bad_argument, "there are two grids of {}", name);
        }
        if (grid.spec != first.spec || grid.time != first.time ||
            grid.frame_time != first.frame_time) {
            return fail(ErrorCode::bad_argument,
                        "the grid of {} has other cells or another time than that of {}", name,
                        level2::moment_name(first.moment));
        }
    }
    return {};
}

Result<std::vector<std::byte>> build(std::span<const Grid> grids, const GridWriteOptions& options) {
    const MutexLock lock(library_mutex());
    NetcdfBuilder file;
    const grid::GridSpec& spec = grids.front().spec;
    const MapNames names = map_names(spec);
    // The dimension `time` is unlimited, so that programs can join files along it (ncrcat). The
    // axes are written first, because write_axes() gives this dimension its one element.
    constexpr std::size_t unlimited = 0;
    const Dimensions size{file.dimension("time", unlimited),
                          file.dimension("z", spec.levels_m.size()),
                          file.dimension(names.y, static_cast<std::size_t>(spec.ny)),
                          file.dimension(names.x, static_cast<std::size_t>(spec.nx))};
    write_provenance(file, grids);
    write_axes(file, grids.front(), size);
    write_mapping(file, spec);
    write_positions(file, spec, {size.y, size.x}, options.deflate_level);
    for (const Grid& grid : grids) {
        const Field field{grid, grids.size() == 1};
        write_field(file, field, size, options.deflate_level);
        write_status(file, field, size, options.deflate_level);
        write_details(file, field, size, options.deflate_level);
        write_overlap(file, field, size, options.deflate_level);
    }
    return file.finish();
}

}  // namespace

Result<std::vector<std::byte>> grid_file_bytes(std::span<const Grid> grids,
                                               const GridWriteOptions& options) {
    if (auto good = check_together(grids); !good) return pass_on(good);
    for (const Grid& grid : grids) {
        if (auto good = check(grid, options); !good) return pass_on(good);
    }
    return build(grids, options);
}

Status write_grids(FileSystem& file_system, const std::filesystem::path& path,
                   std::span<const Grid> grids, const GridWriteOptions& options) {
    const auto bytes = grid_file_bytes(grids, options);
    if (!bytes && bytes.error().code == ErrorCode::bad_argument) return pass_on(bytes);
    if (!bytes) return fail(bytes.error().code, "{}: {}", path.string(), bytes.error().message);
    return write_file_atomically(file_system, path, *bytes);
}

Status write_grid(FileSystem& file_system, const std::filesystem::path& path, const Grid& grid,
                  const GridWriteOptions& options) {
    return write_grids(file_system, path, {&grid, 1}, options);
}

}  // namespace stormcellar::netcdf
