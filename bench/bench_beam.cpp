// bench_beam: measures what the rungs of the beam cost, and where they put a gate.
//
// usage: bench_beam [--runs N] [--json] [SOUNDING]      (bench/request.h)
//   SOUNDING   a file in the format of grid/beam/sounding.h; else the models' own profiles
// There are two kinds of rows, for a site at 35 N with the antenna at sea level. For each model:
//   model           the rung
//   paths_ms        42 paths: 14 elevations, each with both edges of the beam; least of the runs
//   over_ns         one point of a path over an arc
// For each traced model, elevation and range, the value of the 4/3 earth minus that of the model:
//   elevation_deg, range_km
//   gate_height_m   height of the gate
//   gate_arc_m      arc of the gate
//   height_m        height of the beam over the arc at which the 4/3 earth puts the gate
//   range_m         range there
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "grid/beam/sounding.h"
#include "stormcellar/grid/beam_model.h"

namespace stormcellar::bench {
namespace {

constexpr double latitude_deg = 35;
constexpr std::array<double, 14> elevations_deg = {0.5, 0.9, 1.3, 1.8,  2.4,  3.1,  4.0,
                                                   5.1, 6.4, 8.0, 10.0, 12.5, 15.6, 19.5};
constexpr double half_beam_deg = 0.475;
constexpr int arc_count = 1000;
constexpr double arc_step_m = 500;

void add_cost(const grid::BeamModel& model, int runs, Table& table) {
    double least_paths_s = std::numeric_limits<double>::infinity();
    double least_over_s = least_paths_s;
    double sum_m = 0;
    std::vector<grid::BeamPath> paths;
    for (int run = 0; run < runs; ++run) {
        paths.clear();
        keep_least_seconds(least_paths_s, [&] {
            for (const double elevation_deg : elevations_deg) {
                for (const double off_deg : {-half_beam_deg, 0.0, half_beam_deg})
                    paths.push_back(model.path(elevation_deg + off_deg));
            }
        });
        keep_least_seconds(least_over_s, [&] {
            for (const grid::BeamPath& path : paths) {
                for (int i = 0; i < arc_count; ++i) {
                    const double height_m = path.over(arc_step_m * i).height_m;
                    if (!std::isnan(height_m)) sum_m += height_m;
                }
            }
        });
    }
    if (!(sum_m > 0)) fmt::print(stderr, "no beam passes over any arc\n");
    const auto points = static_cast<double>(paths.size() * arc_count);
    table.add({{"model", model.name()},
               {"paths_ms", {1e3 * least_paths_s, 2}},
               {"over_ns", {1e9 * least_over_s / points, 0}}});
}

void add_differences(const grid::BeamModel& traced, Table& table) {
    const auto closed = grid::BeamModel::four_thirds(latitude_deg, 0);
    for (const double elevation_deg : {0.5, 1.5, 3.0, 5.0, 10.0, 19.5}) {
        const grid::BeamPath closed_path = closed.path(elevation_deg);
        const grid::BeamPath traced_path = traced.path(elevation_deg);
        for (const double range_km : {50.0, 100.0, 150.0, 230.0, 300.0, 460.0}) {
            const grid::EarthPoint a = closed_path.at(1e3 * range_km);
            const grid::EarthPoint b = traced_path.at(1e3 * range_km);
            const auto over = traced_path.over(a.arc_m);
            table.add({{"model", traced.name()},
                       {"elevation_deg", {elevation_deg, 1}},
                       {"range_km", {range_km, 0}},
                       {"gate_height_m", {a.height_m - b.height_m, 1}},
                       {"gate_arc_m", {a.arc_m - b.arc_m, 1}},
                       {"height_m", {a.height_m - over.height_m, 1}},
                       {"range_m", {1e3 * range_km - over.range_m, 1}}});
        }
    }
}

// Uses the file, or the models' own profiles. Returns none if the file cannot be read.
std::vector<grid::BeamModel> traced_models(const Request& request) {
    using grid::BeamModel;
    using grid::RefractivityProfile;
    if (!request.files.empty()) {
        const auto profile = grid::read_sounding(request.files.front());
        if (profile) return {BeamModel::traced(latitude_deg, 0, *profile)};
        fmt::print(stderr, "{}\n", profile.error().message);
        return {};
    }
    const auto reference = RefractivityProfile::exponential().value();
    return {BeamModel::traced(latitude_deg, 0, RefractivityProfile::standard(latitude_deg)),
            BeamModel::traced(latitude_deg, 0, reference),
            BeamModel::traced(latitude_deg, 0, reference, grid::RangeKind::geometric)};
}

int run(int argc, char** argv) {
    const auto [request, status] = read_request(
        {"bench_beam", "[SOUNDING]", "what the rungs of the beam cost, and where they put a gate"},
        std::span(argv, static_cast<std::size_t>(argc)));
    if (!request) return status;
    const std::vector<grid::BeamModel> traced = traced_models(*request);
    if (traced.empty()) return 1;
    Table table(request->json);
    add_cost(grid::BeamModel::flat_earth(0), request->runs, table);
    add_cost(grid::BeamModel::four_thirds(latitude_deg, 0), request->runs, table);
    for (const grid::BeamModel& model : traced)
        add_cost(model, request->runs, table);
    for (const grid::BeamModel& model : traced)
        add_differences(model, table);
    table.finish();
    return 0;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
