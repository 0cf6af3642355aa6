// bench/render_scene.h -- the paper's scene from a real sequence: grids in files, view, reference.
//
// Threads   Build it on one thread; const functions may be called from any thread.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "render/volume/slicer.h"
#include "stormcellar/base/result.h"

namespace stormcellar::bench {

inline constexpr int picture_width = 796, picture_height = 532;

// The size of one of the paper's grids, and the paper's frames a second by number of slices.
struct PaperVolume {
    const char* name;
    int side, levels;
    std::array<double, 5> fps;
};
inline constexpr std::array<int, 5> paper_slices = {64, 128, 256, 512, 1024};
inline constexpr std::array<PaperVolume, 3> paper_volumes = {{
    {"128x128x64", 128, 64, {20, 15, 8, 5, 3}},
    {"256x256x128", 256, 128, {18, 12, 8, 5, 3}},
    {"512x512x256", 512, 256, {4, 4, 3.5, 2.5, 1.5}},
}};

// Five volumes of KBGM (2005-08-22, a line of storms), gridded over the same box for any number of
// cells, each in a file of its own.
class RenderScene {
  public:
    static Result<RenderScene> make(const PaperVolume& volume, const std::filesystem::path& data,
                                    const std::filesystem::path& directory);

    [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }
    [[nodiscard]] const grid::GridSpec& spec() const { return spec_; }
    // 20 degrees from the vertical
    [[nodiscard]] render::ViewGeometry view() const;
    // shares of all cells and of all pixels
    [[nodiscard]] double echo_share() const { return echo_share_; }
    [[nodiscard]] double footprint() const;

  private:
    grid::GridSpec spec_;
    std::vector<std::filesystem::path> files_;
    double echo_share_ = 0;
};

// Composites over the color of the page, as every frame of the benchmark.
[[nodiscard]] render::Image finished(const render::Layer& layer, int threads);

// Every `stride`-th pixel of the reference picture. The stride is odd, so that pixels on and
// between the coarser grids of rays count alike.
struct ReferencePixels {
    static constexpr int stride = 5;
    static constexpr int steps = 8192;
    std::vector<std::array<double, 4>> rays;

    ReferencePixels(const grid::BrickView& view, const render::ViewGeometry& geometry, int threads);
};

struct PictureError {
    double mean = 0, p99 = 0;            // CIEDE2000 over all pixels compared
    double echo_mean = 0, echo_p99 = 0;  // over those where the reference has echo
};
[[nodiscard]] PictureError compare(const ReferencePixels& reference, const render::Image& picture);

}  // namespace stormcellar::bench
