// bench_map: what the base map of a picture costs.
//
// usage: bench_map [--threads N] [--runs N] [--json]      (bench/request.h)
// For each grid, size of the picture and number of threads one row, seen from straight above:
//   grid       its extent, middle and projection
//   picture    width x height in pixels
//   threads    for projecting
//   read_ms    reading the built-in map, once for a process
//   project_ms projecting and clipping its lines, and filling land and water: once for a view
//   draw_ms    drawing the lines, for each picture
//   points     vertices that are drawn
// Times are the least of the runs. It reads no volumes, so that --data matters nothing.
#include <array>
#include <limits>
#include <span>
#include <string>

#include <fmt/format.h>

#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "render/map/map_layer.h"
#include "render/map/picture_space.h"
#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::bench {
namespace {

using grid::Projection;

struct MapCase {
    const char* grid;
    double latitude_deg, longitude_deg;
    int columns, rows;
    double spacing_m;
    Projection projection;
    int width, height;  // of the picture
};
constexpr std::array cases = {
    MapCase{"460 km about KOKX", 40.8656, -72.8639, 460, 460, 1000,
            Projection::azimuthal_equidistant, 796, 532},
    MapCase{"460 km about 38.5 N 76.5 W", 38.5, -76.5, 460, 460, 1000,
            Projection::azimuthal_equidistant, 796, 532},
    MapCase{"1000 km about 42 N 74 W", 42, -74, 1000, 1000, 1000, Projection::azimuthal_equidistant,
            796, 532},
    MapCase{"contiguous US, Lambert", 38, -97, 1250, 750, 4000, Projection::lambert_conformal, 796,
            532},
    MapCase{"contiguous US, equidistant", 38, -97, 1250, 750, 4000,
            Projection::azimuthal_equidistant, 796, 532},
    MapCase{"contiguous US, Lambert", 38, -97, 1250, 750, 4000, Projection::lambert_conformal, 1920,
            1080},
    MapCase{"contiguous US, Lambert", 38, -97, 1250, 750, 4000, Projection::lambert_conformal, 3840,
            2160},
};

grid::GridSpec spec_of_case(const MapCase& one) {
    grid::GridSpec spec = grid::default_spec(one.latitude_deg, one.longitude_deg);
    spec.projection = one.projection;
    spec.nx = one.columns;
    spec.ny = one.rows;
    spec.spacing_m = one.spacing_m;
    if (grid::facts_of(one.projection).takes_parallels) spec.parallels_deg = {33, 45};
    return spec;
}

int measure_map(const MapCase& one, int threads, int runs, Table& table) {
    const grid::GridSpec spec = spec_of_case(one);
    const render::PictureSpace space = render::space_of(one.width, one.height);
    const render::ViewGeometry view(spec, render::Camera{180, 0, 1}, 1, one.width - space.panel,
                                    one.height - space.header - space.footer - space.band);
    double read_s = std::numeric_limits<double>::infinity();
    double project_s = read_s, draw_s = read_s;
    std::size_t points = 0;
    for (int run = 0; run < runs; ++run) {
        auto map = render::BaseMap::built_in();
        keep_least_seconds(read_s, [&] { map = render::BaseMap::built_in(); });
        if (!map) return 1;
        auto layer = render::prepare_map(*map, spec, view, space.scale, threads);
        keep_least_seconds(project_s, [&] {
            layer = render::prepare_map(*map, spec, view, space.scale, threads);
        });
        if (!layer) return 1;
        points = 0;
        for (const render::MapStroke& stroke : layer->strokes)
            points += stroke.points.size();
        const render::Shades& shades = render::shades_of(render::Theme::dark);
        render::Canvas canvas(view.width(), view.height(), shades.page);
        keep_least_seconds(draw_s, [&] { render::draw_map(canvas, *layer, shades, space.scale); });
    }
    table.add({{"grid", one.grid},
               {"picture", fmt::format("{} x {}", one.width, one.height)},
               {"threads", threads},
               {"read_ms", {1e3 * read_s, 1}},
               {"project_ms", {1e3 * project_s, 1}},
               {"draw_ms", {1e3 * draw_s, 1}},
               {"points", static_cast<int>(points)}});
    return 0;
}

int run_maps(int argc, char** argv) {
    const auto [request, usage_status] =
        read_request({"bench_map", "", "what the base map of a picture costs"},
                     std::span(argv, static_cast<std::size_t>(argc)));
    if (!request) return usage_status;
    Table table(request->json);
    for (const MapCase& one : cases) {
        for (const int threads : request->threads) {
            if (const int status = measure_map(one, threads, request->runs, table); status != 0)
                return status;
        }
    }
    table.finish();
    return 0;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run_maps(argc, argv);
}
