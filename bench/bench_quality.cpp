// bench_quality: measures what each method of gridding does to a point, an edge and a wave, and
// whether it conserves reflectivity.
//
// usage: bench_quality [--json] [--beams]
// There is a row for each range and method, tab-separated under a head of keys; --json prints
// {"machine": ..., "rows": [...]} with the same keys. bench/quality_chart.h describes what is
// observed and how. Gates are samples at their centers, so that only the effect of the grid shows;
// with --beams they are means over the beam and the pulse, which takes minutes for each range.
//   range_km            of the feature from the radar
//   method, averaging   as in the provenance of a grid
//   along_km, across_km, height_km  width of a point between half powers
//   true_...            the same for the truth
//   shift_km, shift_height_km  shift of its centroid
//   peak_dbz            of 50
//   rise_km, edge_shift_km  of an edge: the distance from 10 to 90 % of Z, and how far beyond it 50
//                           % is
//   wave4_across, wave8_across, wave8_along  remaining amplitude of waves in dBZ; lengths in km
//   wave8_shift_km      shift of the phase across the beam
//   total_z             of the point, divided by that of the truth, in the cells that are seen
//   echo_volume         the same for the volume of 20 dBZ and more
// It reads no volumes.
#include <cstring>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/quality_chart.h"
#include "stormcellar/base/version.h"

namespace stormcellar::bench {
namespace {

using grid::Averaging;
using grid::CellExtent;
using grid::Interpolation;
using grid::Method;

std::vector<Method> methods() {
    std::vector<Method> all;
    for (const Interpolation interpolation :
         {Interpolation::nearest, Interpolation::linear, Interpolation::eight_point,
          Interpolation::beam_weighted}) {
        for (const Averaging averaging : {Averaging::in_db, Averaging::in_z}) {
            Method method;
            method.interpolation = interpolation;
            method.averaging = averaging;
            all.push_back(method);
        }
    }
    for (const Averaging averaging : {Averaging::in_db, Averaging::in_z}) {
        Method method;
        method.cell = CellExtent::area;
        method.averaging = averaging;
        all.push_back(method);
    }
    return all;
}

// One row: keys with numbers, after the names.
using Row = std::vector<std::pair<const char*, double>>;

struct Features {
    Observed point, edge, wave4_across, wave8_across, wave8_along;
};

Features features_at(double range_m, Gates gates) {
    return {observe_point(range_m, gates), observe_edge(range_m, gates),
            observe_wave(range_m, gates, 4000, true), observe_wave(range_m, gates, 8000, true),
            observe_wave(range_m, gates, 8000, false)};
}

Row row_of(const Features& features, const Method& method) {
    const PointChart point = point_chart(features.point, method);
    const EdgeChart edge = edge_chart(features.edge, method);
    const WaveChart wave8 = wave_chart(features.wave8_across, method);
    return {{"along_km", point.along_km},
            {"across_km", point.across_km},
            {"height_km", point.height_km},
            {"true_along_km", point.true_along_km},
            {"true_across_km", point.true_across_km},
            {"true_height_km", point.true_height_km},
            {"shift_km", point.shift_km},
            {"shift_height_km", point.shift_height_km},
            {"peak_dbz", point.peak_dbz},
            {"rise_km", edge.rise_km},
            {"edge_shift_km", edge.shift_km},
            {"wave4_across", wave_chart(features.wave4_across, method).amplitude_ratio},
            {"wave8_across", wave8.amplitude_ratio},
            {"wave8_along", wave_chart(features.wave8_along, method).amplitude_ratio},
            {"wave8_shift_km", wave8.shift_km},
            {"total_z", point.total_z_ratio},
            {"echo_volume", point.echo_volume_ratio}};
}

void print_text(double range_km, const Method& method, const Row& row, bool first) {
    const char* averaging = method.averaging == Averaging::in_z ? "Z" : "dBZ";
    if (first) {
        fmt::print("range_km\tmethod\taveraging");
        for (const auto& [key, value] : row)
            fmt::print("\t{}", key);
        fmt::print("\n");
    }
    fmt::print("{:.0f}\t{}\t{}", range_km, method.name(), averaging);
    for (const auto& [key, value] : row)
        fmt::print("\t{:.2f}", value);
    fmt::print("\n");
}

void print_json(double range_km, const Method& method, const Row& row, bool first) {
    const char* averaging = method.averaging == Averaging::in_z ? "Z" : "dBZ";
    fmt::print("{}{{\"range_km\": {}, \"method\": \"{}\", \"averaging\": \"{}\"",
               first ? "" : ",\n  ", range_km, method.name(), averaging);
    for (const auto& [key, value] : row)
        fmt::print(", \"{}\": {:.4f}", key, value);
    fmt::print("}}");
}

int run(int argc, char** argv) {
    bool json = false;
    Gates gates = Gates::of_points;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--json") == 0) {
            json = true;
        } else if (std::strcmp(argv[i], "--beams") == 0) {
            gates = Gates::of_beams;
        } else {
            fmt::print(stderr, "usage: bench_quality [--json] [--beams]\n");
            return 2;
        }
    }
    if (json) {
        fmt::print("{{\"machine\": {{\"threads\": {}, \"version\": \"{}\"}},\n \"rows\": [\n  ",
                   std::thread::hardware_concurrency(), software_version);
    }
    bool first = true;
    for (const double range_km : {25.0, 50.0, 100.0, 150.0, 200.0}) {
        const Features features = features_at(range_km * 1000, gates);
        for (const Method& method : methods()) {
            const Row row = row_of(features, method);
            json ? print_json(range_km, method, row, first)
                 : print_text(range_km, method, row, first);
            first = false;
        }
    }
    if (json) fmt::print("\n]}}\n");
    return 0;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
