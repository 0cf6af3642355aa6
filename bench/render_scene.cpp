#include "bench/render_scene.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/parallel.h"
#include "bench/volume_site.h"
#include "render/color/color_difference.h"
#include "render/image/shades.h"
#include "render/volume/reference_marcher.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 5> sequence = {"KBGM20050822_024414.gz", "KBGM20050822_025001.gz",
                                                 "KBGM20050822_025549.gz", "KBGM20050822_030243.gz",
                                                 "KBGM20050822_030830.gz"};
constexpr double extent_m = 300e3;
constexpr double lowest_m = 500, highest_m = 12000;
constexpr double exaggeration = 5;
constexpr double view_from_vertical_deg = 20;

grid::GridSpec spec_about(const grid::SitePosition& site, const PaperVolume& volume) {
    grid::GridSpec spec;
    spec.center_latitude_deg = site.latitude_deg;
    spec.center_longitude_deg = site.longitude_deg;
    spec.nx = spec.ny = volume.side;
    spec.spacing_m = extent_m / volume.side;
    for (int i = 0; i < volume.levels; ++i)
        spec.levels_m.push_back(lowest_m + (highest_m - lowest_m) * i / (volume.levels - 1));
    return spec;
}

double share_of_values(const grid::BrickView& view) {
    double values = 0;
    for (const grid::BrickEntry& brick : view.bricks)
        values += brick.value_count;
    return values / static_cast<double>(view.spec->cell_count());
}

}  // namespace

Result<RenderScene> RenderScene::make(const PaperVolume& volume, const fs::path& data,
                                      const fs::path& directory) {
    RenderScene scene;
    std::shared_ptr<const grid::ColumnGeometry> columns;
    for (const char* name : sequence) {
        level2::DecodeOptions decoding;
        decoding.fallback_station = "KBGM";
        decoding.selection.moments = {level2::Moment::ref};
        const auto bytes = read_file(data / "sequence-kbgm" / name);
        if (!bytes) return pass_on(bytes);
        const auto decoded = level2::decode(*bytes, decoding);
        if (!decoded) return pass_on(decoded);
        const auto found = site_of(decoded->volume);
        if (!found) return pass_on(found);
        const grid::SitePosition& site = *found;
        if (!columns) {
            scene.spec_ = spec_about(site, volume);
            const auto made = grid::make_column_geometry(site, scene.spec_);
            if (!made) return pass_on(made);
            columns = *made;
        }
        const auto grid = grid::make_grid(decoded->volume, site, *columns, {});
        if (!grid) return pass_on(grid);
        const auto bricks =
            grid::BrickGrid::from(*grid, grid::default_quantization(level2::Moment::ref));
        scene.echo_share_ += share_of_values(bricks.view()) / sequence.size();
        const fs::path file = directory / fmt::format("{}-{}.scg", volume.name, name);
        const auto written =
            cache::write_grid_file(real_file_system(), file, cache::describe(*grid), bricks.view());
        if (!written) return pass_on(written);
        scene.files_.push_back(file);
    }
    return scene;
}

render::ViewGeometry RenderScene::view() const {
    render::Camera camera;
    camera.tilt_deg = view_from_vertical_deg;
    camera.zoom = 1.2;
    return {spec_, camera, exaggeration, picture_width, picture_height};
}

// Returns the number of pixels under the upper or the lower side of the box; its walls are between
// the two.
double RenderScene::footprint() const {
    const auto geometry = view();
    std::size_t inside = 0;
    for (int y = 0; y < picture_height; ++y) {
        for (int x = 0; x < picture_width; ++x) {
            bool hit = false;
            for (const double height : {geometry.bottom_m(), geometry.top_m()}) {
                const render::Pixel pixel{x + 0.5, y + 0.5};
                const render::Vec3 start = geometry.point(pixel, 0);
                const double depth = (height * exaggeration - start[2]) / geometry.along(pixel)[2];
                const render::Vec3 point = geometry.point(pixel, depth);
                hit = hit || (std::abs(point[0]) <= geometry.half_x_m() &&
                              std::abs(point[1]) <= geometry.half_y_m());
            }
            inside += hit ? 1 : 0;
        }
    }
    return static_cast<double>(inside) / (picture_width * picture_height);
}

render::Image finished(const render::Layer& layer, int threads) {
    render::Image picture(layer.width, layer.height, render::shades::dark.page);
    render::composite_over(layer, picture, 0, 0, threads);
    return picture;
}

ReferencePixels::ReferencePixels(const grid::BrickView& view, const render::ViewGeometry& geometry,
                                 int threads) {
    const render::ReferenceMarcher marcher(view, render::nws_reflectivity(), geometry, 1);
    constexpr int across = (picture_width + stride - 1) / stride;
    constexpr int down = (picture_height + stride - 1) / stride;
    rays.resize(static_cast<std::size_t>(across) * down);
    for_each_piece(down, threads, [&](int row) {
        for (int column = 0; column < across; ++column) {
            rays[static_cast<std::size_t>(row) * across + static_cast<std::size_t>(column)] =
                marcher.ray({column * stride + 0.5, row * stride + 0.5}, steps);
        }
    });
}

PictureError compare(const ReferencePixels& reference, const render::Image& picture) {
    constexpr int across = (picture_width + ReferencePixels::stride - 1) / ReferencePixels::stride;
    std::vector<double> all, echo;
    for (std::size_t i = 0; i < reference.rays.size(); ++i) {
        const auto& ray = reference.rays[i];
        render::Rgba8 exact{0, 0, 0, 255};
        for (std::size_t c = 0; c < 3; ++c) {
            const double level = 255 * ray[c] + (1 - ray[3]) * render::shades::dark.page[c];
            exact[c] = static_cast<std::uint8_t>(std::lround(std::clamp(level, 0.0, 255.0)));
        }
        const int x = static_cast<int>(i % across) * ReferencePixels::stride;
        const int y = static_cast<int>(i / across) * ReferencePixels::stride;
        const double difference = render::color_difference(exact, picture.at(x, y));
        all.push_back(difference);
        if (ray[3] > 1.0 / 255) echo.push_back(difference);
    }
    const auto mean = [](const std::vector<double>& values) {
        double sum = 0;
        for (const double value : values)
            sum += value;
        return values.empty() ? 0 : sum / static_cast<double>(values.size());
    };
    const auto p99 = [](std::vector<double>& values) {
        if (values.empty()) return 0.0;
        std::sort(values.begin(), values.end());
        return values[(values.size() * 99 + 99) / 100 - 1];
    };
    PictureError error;
    error.mean = mean(all);
    error.p99 = p99(all);
    error.echo_mean = mean(echo);
    error.echo_p99 = p99(echo);
    return error;
}

}  // namespace stormcellar::bench
