#include "cli/grid/grid_report.h"

#include <array>
#include <filesystem>
#include <set>
#include <string>

#include <fmt/ranges.h>

#include "cli/shared/commands.h"
#include "cli/shared/output_file.h"

namespace stormcellar::cli {
namespace {

using StateCounts = std::array<std::size_t, grid::cell_status_count>;

StateCounts count_states(const grid::Grid& grid) {
    StateCounts counts{};
    for (const grid::CellStatus status : grid.status)
        ++counts[static_cast<std::size_t>(status)];
    return counts;
}

// Adds the facts of one moment's grid: its cells, and how it was made.
void describe_cells(const grid::Grid& grid, nlohmann::ordered_json& json) {
    const auto counts = count_states(grid);
    for (const grid::CellStatus state : grid::states_of(grid.moment))
        json["cells"][std::string{grid::cell_status_name(state)}] =
            counts[static_cast<std::size_t>(state)];
    json["fields"] = nlohmann::ordered_json::array();
    for (const grid::Detail detail : grid::all_details) {
        if (grid.details.set().has(detail)) json["fields"].push_back(grid::detail_name(detail));
    }
    if (!grid.site_counts.empty()) json["fields"].push_back("counts");
    if (!grid.site_weights.empty()) json["fields"].push_back("weights");
    json["method"] = grid.provenance.method;
    json["beam_model"] = grid.provenance.beam_model;
    json["averaging"] = grid.provenance.averaging;
    if (!grid.provenance.predicted_error.empty()) {
        json["effects"] = grid.provenance.effects;
        json["predicted_error"] = grid.provenance.predicted_error;
    }
    json["partial"] = grid.provenance.partial;
    json["notes"] = grid.provenance.notes;
}

void describe_moment(const grid::Grid& grid, nlohmann::ordered_json& json) {
    json["moment"] = level2::moment_name(grid.moment);
    json["units"] = level2::moment_units(grid.moment);
}

void describe_spec(const grid::GridSpec& spec, nlohmann::ordered_json& json) {
    json["projection"] = grid::projection_name(spec.projection);
    json["center"] = {spec.center_latitude_deg, spec.center_longitude_deg};
    if (spec.in_degrees()) {
        json["spacing_deg"] = spec.spacing_deg;
    } else {
        json["spacing_m"] = spec.spacing_m;
    }
    if (grid::facts_of(spec.projection).takes_parallels) {
        json["parallels_deg"] = spec.parallels_deg;
    }
    json["nx"] = spec.nx;
    json["ny"] = spec.ny;
    json["levels_m"] = spec.levels_m;
}

void print_cells(std::FILE* to, const grid::Grid& grid, const std::string& name) {
    const auto counts = count_states(grid);
    const auto percent = [&](grid::CellStatus status) {
        return 100.0 * static_cast<double>(counts[static_cast<std::size_t>(status)]) /
               static_cast<double>(grid.status.size());
    };
    fmt::print(to,
               "  {}{:.1f} % with a value, {:.1f} % no echo, {:.1f} % range folded, {:.1f} % not "
               "seen",
               name, percent(grid::CellStatus::value), percent(grid::CellStatus::no_echo),
               percent(grid::CellStatus::range_folded), percent(grid::CellStatus::not_seen));
    if (level2::facts_of(grid.moment).is_derived)
        fmt::print(to, ", {:.1f} % ambiguous", percent(grid::CellStatus::ambiguous));
    fmt::print(to, "\n");
}

}  // namespace

nlohmann::ordered_json describe(const GridOptions& options, const std::vector<grid::Grid>& grids,
                                const GridTimings& timings) {
    const grid::Grid& first = grids.front();
    nlohmann::ordered_json json;
    json["file"] = std::filesystem::path(options.files.front()).filename().string();
    json["files"] = first.provenance.source_files;
    json["output"] = options.output;
    json["station"] = first.sites.front().icao;
    json["stations"] = first.provenance.stations;
    json["time"] = format_utc(first.time);
    json["frame_time"] = format_utc(first.frame_time.value_or(first.time));
    if (grids.size() == 1) describe_moment(first, json);
    describe_spec(first.spec, json);
    if (grids.size() == 1) {
        describe_cells(first, json);
    } else {
        for (const grid::Grid& grid : grids) {
            nlohmann::ordered_json& one = json["moments"].emplace_back();
            describe_moment(grid, one);
            describe_cells(grid, one);
        }
    }
    json["read_s"] = timings.read_s;
    json["decode_s"] = timings.decode_s;
    json["geometry_s"] = timings.geometry_s;
    json["plan_s"] = timings.plan_s;
    json["grid_s"] = timings.grid_s;
    json["merge_s"] = timings.merge_s;
    json["write_s"] = timings.write_s;
    json["total_s"] = timings.total_s;
    return json;
}

void print_facts(const GridOptions& options, const std::vector<grid::Grid>& grids,
                 const GridTimings& timings) {
    std::FILE* const to = is_stdout(options.output) ? stderr : stdout;
    const grid::Grid& first = grids.front();
    const bool in_degrees = first.spec.in_degrees();
    std::vector<std::string_view> moments;
    for (const grid::Grid& grid : grids)
        moments.push_back(level2::moment_name(grid.moment));
    fmt::print(to, "{}: {} {} of {}, {} x {} x {} cells at {:g} {}\n", printable(options.output),
               printable(fmt::format("{}", fmt::join(first.provenance.stations, " "))),
               fmt::join(moments, ", "), format_utc(first.time), first.spec.nx, first.spec.ny,
               first.spec.nz(), in_degrees ? first.spec.spacing_deg : first.spec.spacing_m / 1000,
               in_degrees ? "degrees" : "km");
    std::set<std::string> said;
    for (const grid::Grid& grid : grids)
        print_cells(to, grid,
                    grids.size() == 1 ? "" : fmt::format("{}: ", level2::moment_name(grid.moment)));
    for (const grid::Grid& grid : grids) {
        for (const std::string& note : grid.provenance.notes) {
            if (said.insert(note).second) fmt::print(to, "  note: {}\n", printable(note));
        }
    }
    fmt::print(
        to,
        "  read {:.3f} s, decode {:.3f} s, geometry {:.3f} s, grid {:.3f} s, merge {:.3f} s, "
        "write {:.3f} s\n",
        timings.read_s, timings.decode_s, timings.geometry_s, timings.grid_s, timings.merge_s,
        timings.write_s);
}

}  // namespace stormcellar::cli
