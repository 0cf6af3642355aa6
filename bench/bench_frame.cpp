// bench_frame: what each rung of the site frame costs and how far off it is.
//
// usage: bench_frame [--runs N] [--json]      (bench/request.h)
// For each projection and rung one row:
//   projection  of a grid of 512 x 512 columns at 1 km (0.01 degrees), 120 km off its site
//   frame       sphere, table or geodesic (stormcellar/grid/frame_ladder.h)
//   seconds     to make the geometry of all columns, least of the runs
//   ratio       the geodesic's seconds over these
//   error_m     largest error of any column, against exact geodesics
//   bound_m     what frame_error_bound_m() promises
// It reads no volumes, so that --data matters nothing, and has one thread.
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::bench {
namespace {

using grid::FrameKind;
using grid::Projection;

const grid::SitePosition site{"KTLX", 35.3333, -97.2778, 389};

grid::GridSpec spec_of(Projection projection) {
    grid::GridSpec spec = grid::default_spec(36.1, -96.2);
    spec.projection = projection;
    spec.nx = spec.ny = 512;
    if (spec.in_degrees()) {
        spec.spacing_m = 0;
        spec.spacing_deg = 0.01;
    }
    if (grid::facts_of(projection).takes_parallels) spec.parallels_deg = {33, 45};
    return spec;
}

double largest_error_m(const grid::ColumnGeometry& geometry) {
    const grid::GridProjection projection(geometry.spec());
    const grid::SiteFrame frame(site.latitude_deg, site.longitude_deg);
    double largest_m = 0;
    for (int iy = 0; iy < geometry.spec().ny; ++iy) {
        for (int ix = 0; ix < geometry.spec().nx; ++ix) {
            const grid::ColumnPlace place = geometry.row(iy)[static_cast<std::size_t>(ix)];
            const auto kept = grid::SiteFrame::to_plane({place.azimuth_deg, place.arc_m});
            const auto exact =
                grid::SiteFrame::to_plane(frame.to_polar(projection.to_geo({1.0 * ix, 1.0 * iy})));
            largest_m = std::max(largest_m, std::hypot(kept.x_m - exact.x_m, kept.y_m - exact.y_m));
        }
    }
    return largest_m;
}

int measure(Projection projection, int runs, Table& table) {
    constexpr std::array kinds = {FrameKind::sphere, FrameKind::table, FrameKind::geodesic};
    const grid::GridSpec spec = spec_of(projection);
    std::array<double, 3> least_s{};
    least_s.fill(std::numeric_limits<double>::infinity());
    std::array<double, 3> error_m{};
    for (int run = 0; run < runs; ++run) {
        for (std::size_t i = 0; i < kinds.size(); ++i) {
            auto made = grid::make_column_geometry(site, spec, kinds[i]);
            keep_least_seconds(least_s[i],
                               [&] { made = grid::make_column_geometry(site, spec, kinds[i]); });
            if (!made) return 1;
            if (run == 0) error_m[i] = largest_error_m(**made);
        }
    }
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        table.add({{"projection", grid::projection_name(projection)},
                   {"frame", grid::frame_kind_name(kinds[i])},
                   {"seconds", {least_s[i], 4}},
                   {"ratio", {least_s[2] / least_s[i], 1}},
                   {"error_m", {error_m[i], 4}},
                   {"bound_m", {grid::frame_error_bound_m(kinds[i], site, spec), 4}}});
    }
    return 0;
}

int run(int argc, char** argv) {
    const auto [request, usage_status] = read_request(
        {"bench_frame", "", "what each rung of the site frame costs and how far off it is"},
        std::span(argv, static_cast<std::size_t>(argc)));
    if (!request) return usage_status;
    Table table(request->json);
    int status = 0;
    for (const grid::ProjectionFacts& facts : grid::projection_facts) {
        status = std::max(status, measure(facts.projection, request->runs, table));
    }
    table.finish();
    return status;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
