// bench_render: measures frames a second as in the paper of 2008, and the accuracy of each row.
//
// usage: bench_render [--data DIR] [--threads N] [--runs N] [--json]      (bench/request.h)
// The five volumes of sequence-kbgm are gridded over 300 x 300 x 11.5 km in three sizes and drawn
// at 796 x 532 from 20 degrees off the vertical. Each frame opens the next volume's file. There is
// a row for each size, number of slices, method and number of threads:
//   volume    columns x rows x levels
//   slices    number of slices, which are parallel to the picture
//   method    riemann, pre-integrated or pre-integrated-2 (render/volume/transfer_function.h), or
//             smooth: pre-integrated, and interpolated between rays within 2 of 255 levels
//   threads   number of threads that draw
//   fps       frames a second: 1 / (t1 + t2 + t3)
//   t1_s      time to open, validate and map the file
//   t2_s      time to prepare the grid for rays: the bricks that may show echo, and packed codes
//   t3_s      time to cast the rays, and to composite over the color of the page, 8 bits a channel
//   de_mean, de_p99  mean and 99th percentile of CIEDE2000 against a reference in double precision
//             with 8,192 steps, over every fifth column and row of the first volume's picture
//   de_echo_mean, de_echo_p99  the same over the pixels with echo in the reference
//   paper_fps  the paper's result on a graphics card of 2008; 0 for numbers of slices that the
//             paper lacks
// Data that depend only on view and colors are made once for all frames, as in a loop. A run times
// five frames and takes their mean; the row has the least of the runs. Files are read from the page
// cache.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "render/color/color_difference.h"
#include "render/image/shades.h"
#include "render/volume/reference_marcher.h"
#include "render/volume/slicer.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using render::Integration;

constexpr int picture_width = 796, picture_height = 532;

// The size of one of the paper's grids, and the paper's frames a second by number of slices.
struct PaperVolume {
    const char* name;
    int side, levels;
    std::array<double, 5> fps;
};
constexpr std::array<int, 5> paper_slices = {64, 128, 256, 512, 1024};
constexpr std::array<PaperVolume, 3> paper_volumes = {{
    {"128x128x64", 128, 64, {20, 15, 8, 5, 3}},
    {"256x256x128", 256, 128, {18, 12, 8, 5, 3}},
    {"512x512x256", 512, 256, {4, 4, 3.5, 2.5, 1.5}},
}};

// Five volumes of KBGM (2005-08-22, a line of storms), gridded over the same box with any number of
// cells. Each grid is in its own file.
class RenderScene {
  public:
    static Result<RenderScene> make(const PaperVolume& volume, const std::filesystem::path& data,
                                    const std::filesystem::path& directory);

    [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }
    // 20 degrees from the vertical
    [[nodiscard]] render::ViewGeometry view() const;

  private:
    grid::GridSpec spec_;
    std::vector<std::filesystem::path> files_;
};

// Every `stride`-th pixel of the reference picture in both directions. Some pixels have a ray, and
// others are interpolated between rays. The stride is odd, so that both kinds of pixels count in
// proportion.
struct ReferencePixels {
    static constexpr int stride = 5;
    static constexpr int steps = 8192;
    std::vector<std::array<double, 4>> rays;

    ReferencePixels(const grid::BrickView& view, const render::ViewGeometry& geometry, int threads);
};

struct PictureError {
    double mean = 0, p99 = 0;            // CIEDE2000 over all pixels compared
    double echo_mean = 0, echo_p99 = 0;  // over the pixels with echo in the reference
};

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

Result<RenderScene> RenderScene::make(const PaperVolume& volume, const fs::path& data,
                                      const fs::path& directory) {
    RenderScene scene;
    std::shared_ptr<const grid::ColumnGeometry> columns;
    for (const char* name : sequence) {
        const auto decoded = decode_ref(data / "sequence-kbgm" / name, 1);
        if (!decoded) return pass_on(decoded);
        const auto found = site_of(*decoded);
        if (!found) return pass_on(found);
        const grid::SitePosition& site = *found;
        if (!columns) {
            scene.spec_ = spec_about(site, volume);
            const auto made = grid::make_column_geometry(site, scene.spec_);
            if (!made) return pass_on(made);
            columns = *made;
        }
        const auto grid = grid::make_grid(*decoded, site, *columns, {});
        if (!grid) return pass_on(grid);
        const auto bricks =
            grid::BrickGrid::from(*grid, grid::default_quantization(level2::Moment::ref));
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

// Composites a layer over the color of the page.
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
        const double sum = std::accumulate(values.begin(), values.end(), 0.0);
        return values.empty() ? 0 : sum / static_cast<double>(values.size());
    };
    const auto p99 = [](const std::vector<double>& values) {
        return values.empty() ? 0 : quantile(values, 0.99);
    };
    PictureError error;
    error.mean = mean(all);
    error.p99 = p99(all);
    error.echo_mean = mean(echo);
    error.echo_p99 = p99(echo);
    return error;
}

struct Method {
    const char* name;
    Integration integration;
    double tolerance;
};
constexpr std::array<Method, 4> methods = {{
    {"riemann", Integration::riemann, 0},
    {"pre-integrated", Integration::first_order, 0},
    {"pre-integrated-2", Integration::second_order, 0},
    {"smooth", Integration::first_order, 2.0 / 255},
}};

// the paper's numbers of slices, and some between them
constexpr std::array<int, 7> measured_slices = {64, 128, 160, 192, 256, 512, 1024};

struct Phases {
    double read_s = 0, prepare_s = 0, render_s = 0;
    [[nodiscard]] double total_s() const { return read_s + prepare_s + render_s; }
};

struct Case {
    const RenderScene* scene = nullptr;
    render::VolumeOptions options;
    int threads = 1;
};

// Draws pictures of time steps, as a loop does.
class Drawing {
  public:
    Drawing(const Case& drawn, const grid::Quantization& quantization)
        : geometry_(drawn.scene->view()),
          slicer_(render::nws_reflectivity(), quantization, geometry_, drawn.options),
          threads_(drawn.threads) {}

    // Draws a file and puts the finished picture into `picture`.
    void draw(const fs::path& path, Phases& phases, render::Image& picture) {
        std::optional<cache::GridFile> file;
        phases.read_s += seconds_of([&] { file.emplace(std::move(*cache::GridFile::open(path))); });
        phases.prepare_s += seconds_of([&] { slicer_.prepare(file->view(), threads_, room_); });
        phases.render_s += seconds_of([&] {
            slicer_.cast(file->view(), threads_, room_);
            picture = finished(room_.layer, threads_);
        });
    }

  private:
    render::ViewGeometry geometry_;
    render::VolumeSlicer slicer_;
    int threads_;
    render::SlicerRoom room_;
};

Phases time_frames(const Case& drawn, int runs) {
    Phases least{std::numeric_limits<double>::infinity(), 0, 0};
    const auto& files = drawn.scene->files();
    Drawing drawing(drawn, cache::GridFile::open(files.front())->view().quantization);
    render::Image picture;
    for (int run = 0; run < runs; ++run) {
        Phases sum;
        for (const fs::path& file : files)
            drawing.draw(file, sum, picture);
        const auto frames = static_cast<double>(files.size());
        const Phases mean{sum.read_s / frames, sum.prepare_s / frames, sum.render_s / frames};
        if (mean.total_s() < least.total_s()) least = mean;
    }
    return least;
}

double paper_fps(const PaperVolume& volume, int slices) {
    const auto* found = std::find(paper_slices.begin(), paper_slices.end(), slices);
    if (found == paper_slices.end()) return 0;
    return volume.fps[static_cast<std::size_t>(found - paper_slices.begin())];
}

void measure_volume(const PaperVolume& volume, const RenderScene& scene, const Request& request,
                    Table& table) {
    const auto first = cache::GridFile::open(scene.files().front());
    const auto geometry = scene.view();
    const ReferencePixels reference(first->view(), geometry, 2);
    for (const int slices : measured_slices) {
        for (const Method& method : methods) {
            Case drawn{&scene, {slices, method.integration, 1, method.tolerance}, 1};
            Phases ignored;
            render::Image picture;
            Drawing(drawn, first->view().quantization)
                .draw(scene.files().front(), ignored, picture);
            const PictureError error = compare(reference, picture);
            for (const int threads : request.threads) {
                drawn.threads = threads;
                const Phases phases = time_frames(drawn, request.runs);
                table.add({{"volume", volume.name},
                           {"slices", slices},
                           {"method", method.name},
                           {"threads", threads},
                           {"fps", {1 / phases.total_s(), 1}},
                           {"t1_s", {phases.read_s, 5}},
                           {"t2_s", {phases.prepare_s, 5}},
                           {"t3_s", {phases.render_s, 5}},
                           {"de_mean", {error.mean, 3}},
                           {"de_p99", {error.p99, 2}},
                           {"de_echo_mean", {error.echo_mean, 3}},
                           {"de_echo_p99", {error.echo_p99, 2}},
                           {"paper_fps", {paper_fps(volume, slices), 1}}});
            }
        }
    }
}

int run(int argc, char** argv) {
    keep_freed_memory();
    const auto [request, usage_status] =
        read_request({"bench_render", "", "frames a second and what they cost in accuracy"},
                     std::span(argv, static_cast<std::size_t>(argc)));
    if (!request) return usage_status;
    const fs::path directory =
        fs::temp_directory_path() / fmt::format("bench-render-{}", ::getpid());
    fs::create_directories(directory);
    Table table(request->json);
    int status = 0;
    for (const PaperVolume& volume : paper_volumes) {
        const auto scene = RenderScene::make(volume, request->data_directory(), directory);
        if (!scene) {
            fmt::print(stderr, "bench_render: {}\n", scene.error().message);
            status = 3;
            break;
        }
        measure_volume(volume, *scene, *request, table);
    }
    table.finish();
    std::error_code ignored;
    fs::remove_all(directory, ignored);
    return status;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
