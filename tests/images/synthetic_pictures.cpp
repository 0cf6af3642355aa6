#include "tests/images/synthetic_pictures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "tests/render/synthetic_storm.h"

namespace stormcellar::images {
namespace {

using grid::CellStatus;
using grid::Grid;
using grid::GridSpec;
using render::Cell;
using render::Product;
using render::Scene;

// Returns a grid 480 km wide and up to 15 km high.
GridSpec storm_spec() {
    return render::small_spec(160, 20, 3000, 750);
}

// Returns a grid of velocity along the beam where there is echo: a wind from the southwest that
// grows with height, and a vortex about the core. Cells far in the southwest are range folded.
Grid velocity_grid() {
    const GridSpec spec = storm_spec();
    Grid grid = render::make_grid_of(spec, [&](int ix, int iy, int iz) -> Cell {
        const Cell echo = render::storm_cell(spec, ix, iy, iz);
        if (echo.status != CellStatus::value) return echo;
        const double x = spec.x_m(ix) / 1000;
        const double y = spec.y_m(iy) / 1000;
        if (x < -75 && y < 0) return {CellStatus::range_folded, 0};
        const double z = spec.levels_m[static_cast<std::size_t>(iz)] / 1000;
        const double dx = x - 62;
        const double dy = y - 42;
        const double whirl = 30 * std::exp(-(dx * dx + dy * dy) / 400) / 10;
        const double wind = 9 + 1.2 * z;
        const double east = wind * 0.8 - whirl * dy;
        const double north = wind * 0.6 + whirl * dx;
        const double range = std::max(1.0, std::hypot(x, y));
        return render::valued(std::clamp((east * x + north * y) / range, -31.0, 31.0));
    });
    grid.sites = {{"KTLX", spec.center_latitude_deg, spec.center_longitude_deg, 384}};
    return grid;
}

Scene base_scene(Product product) {
    Scene scene;
    scene.product = product;
    scene.width = 400;
    scene.height = 300;
    scene.slices = 128;
    return scene;
}

Scene volume_scene() {
    Scene scene = base_scene(Product::volume);
    scene.camera = {205, 62, 1.5, 40, std::nullopt};
    return scene;
}

Scene scene_of(const std::string& name) {
    if (name == "volume-perspective") return volume_scene();
    if (name == "volume-lit") {
        Scene scene = volume_scene();
        scene.light.gradient = scene.light.shadow = true;
        scene.light.sun_azimuth_deg = 150;
        scene.opacity = 4;
        scene.labels = false;
        return scene;
    }
    if (name == "ground-not-seen") {
        Scene scene = base_scene(Product::volume);
        scene.camera.azimuth_deg = 160;
        scene.camera.tilt_deg = 40;
        scene.opacity = 6;
        scene.labels = false;
        return scene;
    }
    if (name == "cappi-velocity") {
        Scene scene = base_scene(Product::cappi);
        scene.moment = level2::Moment::vel;
        scene.cappi_height_m = 2500;
        return scene;
    }
    if (name == "section") {
        Scene scene = base_scene(Product::section);
        scene.section = render::SectionLine{{34.7, -98.2}, {35.75, -95.4}};
        return scene;
    }
    return base_scene(name == "echo-tops" ? Product::echo_top : Product::composite);
}

Grid grid_of(const std::string& name) {
    if (name == "cappi-velocity") return velocity_grid();
    // The grid is 900 km wide, so much of it is out of the radar's reach.
    if (name == "ground-not-seen")
        return render::storm_grid(render::small_spec(150, 12, 6000, 1000));
    return render::storm_grid(storm_spec());
}

}  // namespace

const std::vector<std::string>& picture_names() {
    static const std::vector<std::string> names = {
        "volume-perspective", "volume-lit", "ground-not-seen", "composite",
        "cappi-velocity",     "section",    "echo-tops"};
    return names;
}

Picture make_picture(const std::string& name) {
    Picture picture{name, scene_of(name), {}, grid_of(name)};
    picture.facts.domain = "KTLX";
    picture.facts.moment = picture.scene.moment;
    picture.facts.time = parse_compact("19990503_235621").value();
    picture.facts.sites = picture.grid.sites;
    return picture;
}

Result<render::Image> draw(const Picture& picture) {
    const auto bricks = render::bricks_of(picture.grid);
    return render::render_frame(bricks.view(), picture.facts, picture.scene, 2);
}

void mirror(Grid& grid) {
    const GridSpec& spec = grid.spec;
    for (int iy = 0; iy < spec.ny; ++iy) {
        for (int iz = 0; iz < spec.nz(); ++iz) {
            for (int ix = 0; ix < spec.nx / 2; ++ix) {
                const std::size_t here = spec.index(ix, iy, iz);
                const std::size_t there = spec.index(spec.nx - 1 - ix, iy, iz);
                std::swap(grid.values[here], grid.values[there]);
                std::swap(grid.status[here], grid.status[there]);
            }
        }
    }
}

void swap_classes(Scene& scene, std::size_t first) {
    render::ColorTable table = render::colors_of(scene);
    auto& one = table.stops.at(first);
    auto& next = table.stops.at(first + 1);
    std::swap(one.from, next.from);
    std::swap(one, next);
    scene.colors = std::move(table);
}

}  // namespace stormcellar::images
