#include "export/grid_fields.h"

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

#include <fmt/ranges.h>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/audit_row.h"
#include "stormcellar/level2/moment.h"

namespace stormcellar::netcdf {
namespace {

using grid::Grid;

template <class Part>
std::string joined(const std::vector<Part>& parts, const char* separator) {
    return fmt::format("{}", fmt::join(parts, separator));
}

// Returns the name of a variable of this moment.
std::string name_of(const Grid& grid, bool is_alone, std::string_view variable) {
    return is_alone ? std::string(variable)
                    : fmt::format("{}_{}", level2::moment_name(grid.moment), variable);
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

// Adds those facts of the provenance that differ between moments.
void add_making(const Grid& grid, CfAttributes& attributes) {
    const grid::Provenance& from = grid.provenance;
    attributes.emplace_back("method", from.method);
    if (!from.effects.empty()) attributes.emplace_back("effects", from.effects);
    if (!from.predicted_error.empty())
        attributes.emplace_back("predicted_error", from.predicted_error);
    attributes.emplace_back("beam_model", from.beam_model);
    attributes.emplace_back("averaging", from.averaging);
}

GridField status_field(const Grid& grid, bool is_alone) {
    GridField field{.grid = &grid,
                    .kind = GridField::Kind::status,
                    .name = name_of(grid, is_alone, "status"),
                    .attributes = status_attributes(grid.moment)};
    std::vector<std::string_view> meanings;
    for (const grid::CellStatus state : grid::states_of(grid.moment)) {
        meanings.push_back(grid::cell_status_name(state));
        field.flags.push_back(static_cast<signed char>(state));
    }
    field.flag_meanings = joined(meanings, " ");
    return field;
}

GridField detail_field(const Grid& grid, bool is_alone, grid::Detail detail) {
    const DetailText text = describe_detail(detail, grid);
    return {.grid = &grid,
            .kind = GridField::Kind::detail,
            .detail = detail,
            .name = name_of(grid, is_alone, text.name),
            .attributes = {
                {"long_name", text.long_name}, {"units", text.units}, {"comment", text.comment}}};
}

// Returns the counts and weights of a mosaic. Every cell has them; they are 0 where no site sees
// the cell.
std::vector<GridField> overlap_fields(const Grid& grid, bool is_alone) {
    std::vector<GridField> fields;
    if (!grid.site_counts.empty()) {
        fields.push_back({.grid = &grid,
                          .kind = GridField::Kind::site_count,
                          .name = name_of(grid, is_alone, "site_count"),
                          .attributes = {{"long_name", "number of sites that see the cell"},
                                         {"standard_name", "number_of_observations"},
                                         {"units", "1"}}});
    }
    if (!grid.site_weights.empty()) {
        fields.push_back(
            {.grid = &grid,
             .kind = GridField::Kind::site_weight,
             .name = name_of(grid, is_alone, "site_weight"),
             .attributes = {
                 {"long_name", "sum of the weights of the sites that see the cell"},
                 {"units", "1"},
                 {"comment",
                  "of each site as the rule of overlap has it: exp(-r^2/L^2) at the arc r from the "
                  "site for distance-weighted, else 1; within 2^-11, at most 63"}}});
    }
    return fields;
}

void add_fields(const Grid& grid, bool is_alone, std::vector<GridField>& fields) {
    std::vector<GridField> beside = {status_field(grid, is_alone)};
    for (const grid::Detail detail : grid::all_details) {
        if (grid.details.set().has(detail)) beside.push_back(detail_field(grid, is_alone, detail));
    }
    for (GridField& field : overlap_fields(grid, is_alone))
        beside.push_back(std::move(field));
    std::vector<std::string> names;
    for (const GridField& field : beside)
        names.push_back(field.name);
    GridField values{.grid = &grid,
                     .name = std::string(level2::moment_name(grid.moment)),
                     .attributes = field_attributes(grid.moment, grid.provenance.method)};
    values.attributes.emplace_back("ancillary_variables", joined(names, " "));
    if (!is_alone) add_making(grid, values.attributes);
    fields.push_back(std::move(values));
    for (GridField& field : beside)
        fields.push_back(std::move(field));
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

void add_sites(const Grid& grid, CfAttributes& attributes) {
    std::vector<double> latitudes_deg;
    std::vector<double> longitudes_deg;
    std::vector<double> altitudes_m;
    for (const grid::SitePosition& site : grid.sites) {
        latitudes_deg.push_back(site.latitude_deg);
        longitudes_deg.push_back(site.longitude_deg);
        altitudes_m.push_back(site.altitude_m);
    }
    if (grid.sites.empty()) return;
    attributes.emplace_back("station_latitude_deg", latitudes_deg);
    attributes.emplace_back("station_longitude_deg", longitudes_deg);
    attributes.emplace_back("station_antenna_altitude_m", altitudes_m);
}

// Returns the audit of a grid as text: a line for each class of ranges, over all sweeps.
std::string audit_text(const Grid& grid) {
    const std::string_view unit = grid::difference_unit(grid.moment);
    std::vector<std::string> lines = {"grid minus gates, scanned as the radar did"};
    for (const grid::AuditRow& row : grid::pooled_by_range(grid.provenance.audit))
        lines.push_back(fmt::format("{}: {}", grid::range_text(row), errors_text(row, unit)));
    return joined(lines, "\n");
}

Status check_arrays(const Grid& grid) {
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
    return {};
}

}  // namespace

Status check_grids(std::span<const Grid> grids) {
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
    for (const Grid& grid : grids) {
        if (auto good = check_arrays(grid); !good) return good;
    }
    return {};
}

std::vector<GridField> fields_of(std::span<const Grid> grids) {
    std::vector<GridField> fields;
    for (const Grid& grid : grids)
        add_fields(grid, grids.size() == 1, fields);
    return fields;
}

CfAttributes provenance_attributes(std::span<const Grid> grids) {
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
    CfAttributes attributes = {
        {"Conventions", "CF-1.8"},
        {"title",
         fmt::format("{} {} gridded, {}", stations, joined(moments, " "), format_utc(grid.time))},
        {"source", "weather radar Level II volumes"},
        {"history", fmt::format("{}: {} of {}", version, joined(methods, ", "),
                                joined(from.source_files, ", "))},
        {"software_version", version},
        {"stations", stations}};
    add_sites(grid, attributes);
    attributes.emplace_back("source_files", joined(from.source_files, "\n"));
    attributes.emplace_back("time_coverage_start", format_utc(first->start_time));
    attributes.emplace_back("time_coverage_end", format_utc(last->end_time));
    if (is_alone) add_making(grid, attributes);
    if (from.vcp != 0) attributes.emplace_back("vcp", from.vcp);
    const bool is_partial =
        std::ranges::any_of(grids, [](const Grid& one) { return one.provenance.partial; });
    attributes.emplace_back("volume", is_partial ? "partial" : "complete");
    const std::vector<std::string> notes = notes_of(grids);
    if (!notes.empty()) attributes.emplace_back("notes", joined(notes, "\n"));
    if (is_alone && !from.audit.empty()) attributes.emplace_back("audit", audit_text(grid));
    return attributes;
}

double seconds_of(const Grid& grid) {
    const auto instant = grid.frame_time.value_or(grid.time).time_since_epoch();
    return std::chrono::duration<double>(instant).count();
}

std::string_view time_name(const Grid& grid) {
    return grid.frame_time ? "frame time" : "start of the volume";
}

}  // namespace stormcellar::netcdf
