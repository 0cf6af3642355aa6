#include "tests/retrieve/cells_scene.h"

#include <stdexcept>

#include "stormcellar/grid/gridder.h"
#include "synth/observe.h"

namespace stormcellar::retrieve {

synth::Scene cells_scene(const std::vector<SceneStorm>& storms, const std::string& more) {
    std::string text = R"([radar]
station = "KTLX"
latitude_deg = 35.333
longitude_deg = -97.278
altitude_m = 380
[volumes]
count = 20
start = "2024-06-01T22:00:00Z"
)";
    for (const double elevation_deg : {0.5, 1.3, 2.2, 3.1, 4.2, 5.6, 7.4, 9.8}) {
        text += fmt::format(
            "[[cut]]\nelevation_deg = {}\nazimuth_rate_deg_s = 18\nwaveform = \"surveillance\"\n",
            elevation_deg);
    }
    for (const SceneStorm& storm : storms) {
        text += fmt::format(
            "[[storm]]\nposition_km = [{}, {}]\nvelocity_mps = [{}, {}]\nradii_km = [{}, {}]\n"
            "core_km = 3\ntop_km = 13\npeak_dbz = {}\n",
            storm.x_km, storm.y_km, storm.east_mps, storm.north_mps, storm.radius_km,
            storm.radius_km, storm.peak_dbz);
    }
    auto scene = synth::parse_scene(text + more, "cells");
    if (!scene) throw std::runtime_error(scene.error().message);
    return std::move(*scene);
}

grid::BrickGrid gridded_scene(const synth::Scene& scene, int number) {
    grid::GridSpec spec = grid::default_spec(scene.site.latitude_deg, scene.site.longitude_deg);
    spec.nx = spec.ny = 240;
    const grid::SitePosition site{scene.site.station, scene.site.latitude_deg,
                                  scene.site.longitude_deg,
                                  static_cast<double>(scene.site.antenna_altitude_m)};
    const auto geometry = grid::make_column_geometry(site, spec);
    if (!geometry) throw std::runtime_error(geometry.error().message);
    const auto made = grid::make_grid(synth::observe(scene, number), site, **geometry, {});
    if (!made) throw std::runtime_error(made.error().message);
    return grid::BrickGrid::from(*made, grid::default_quantization(level2::Moment::ref));
}

std::vector<CellScan> scene_scans(const synth::Scene& scene, int volumes) {
    std::vector<CellScan> scans;
    std::vector<grid::BrickGrid> grids;
    for (int number = 0; number < volumes; ++number) {
        grids.push_back(gridded_scene(scene, number));
        auto scan = find_cells({grids.back().view(), {}, FreezingLevels{}},
                               scene.schedule.start_of(number), scene.site.station);
        if (!scan) throw std::runtime_error(scan.error().message);
        if (number > 0) {
            const auto before = static_cast<std::size_t>(number - 1);
            const Status guessed =
                guess_motions(*scan, grids[before].view(), grids.back().view(), scene_interval_s);
            if (!guessed) throw std::runtime_error(guessed.error().message);
        }
        scans.push_back(std::move(*scan));
    }
    return scans;
}

grid::GeoPoint storm_place(const synth::Scene& scene, const SceneStorm& storm, int number) {
    const double seconds = number * scene_interval_s;
    return grid::SiteFrame(scene.site.latitude_deg, scene.site.longitude_deg)
        .to_geo(grid::SiteFrame::from_plane(1000 * storm.x_km + storm.east_mps * seconds,
                                            1000 * storm.y_km + storm.north_mps * seconds));
}

double between_m(grid::GeoPoint a, grid::GeoPoint b) {
    return grid::SiteFrame(a.latitude_deg, a.longitude_deg).to_polar(b).arc_m;
}

}  // namespace stormcellar::retrieve
