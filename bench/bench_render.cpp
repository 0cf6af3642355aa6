// bench_render: measures the paper's table of frames a second, and the accuracy of each row.
//
// usage: bench_render [--data DIR] [--threads N] [--runs N] [--json]      (bench/request.h)
// The five volumes of sequence-kbgm are gridded over 300 x 300 x 11.5 km in three sizes and drawn
// at 796 x 532 from 20 degrees off the vertical, each frame a new time step from its file. There is
// a row for each size, number of slices, method (render/volume/transfer_function.h; "smooth":
// pre-integrated, and interpolated between rays within 2 of 255 levels) and number of threads:
//   volume    columns x rows x levels
//   slices    parallel to the picture
//   method    riemann, pre-integrated, pre-integrated-2 or smooth
//   threads   for drawing
//   fps       1 / (t1 + t2 + t3)
//   t1_s      opening, validating and mapping the file
//   t2_s      what the rays need of the grid: which steps may show anything, and packed codes
//   t3_s      the rays, and compositing over the color of the page: 8 bits a channel
//   de_mean, de_p99  CIEDE2000 against the reference marcher in double precision with 8,192 steps,
//                    over every fifth pixel both ways of the first time step
//   de_echo_mean, de_echo_p99  the same over the pixels where the reference has echo
//   paper_fps  the paper's renderer, with a graphics card of 2008; 0 for numbers of slices that the
//              paper does not give
// What depends on view and colors alone is made once for all frames, as in a loop. Times are the
// least of the runs, each the mean of five frames. The files come from the page cache.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <unistd.h>

#include "base/memory.h"
#include "bench/measure.h"
#include "bench/render_scene.h"
#include "bench/request.h"
#include "bench/table.h"
#include "stormcellar/cache/grid_file.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using render::Integration;

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

// the paper's numbers, and some between
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
        fmt::print(stderr,
                   "{}: {} time steps, {:.1f} % of the cells with echo, footprint {:.0f} % of the "
                   "picture; files in the page cache\n",
                   volume.name, scene->files().size(), 100 * scene->echo_share(),
                   100 * scene->footprint());
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
