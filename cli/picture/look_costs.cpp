#include "cli/picture/look_costs.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "render/color/color_difference.h"
#include "render/plan/volume_plan.h"
#include "stormcellar/accuracy/quantity.h"
#include "stormcellar/render/render.h"

namespace stormcellar::cli {
namespace {

constexpr int rounds = 3;

struct TimedPicture {
    render::Image picture;
    double least_s = std::numeric_limits<double>::infinity();
};

void draw(const grid::BrickView& view, const render::ColorTable& table, const render::Scene& scene,
          int threads, TimedPicture& made) {
    render::VolumeScene drawn(view, table, scene, scene.width, scene.height, threads);
    const render::VolumeChoice choice{
        scene.slices,         scene.integration,  !(scene.pixel_tolerance > 0),
        scene.light.gradient, scene.light.shadow, scene.light.scattering};
    const auto& one = drawn.draw(choice);
    made.picture = one.picture;
    made.least_s = std::min(made.least_s, one.seconds);
}

std::string text_of_colors(const grid::BrickView& view, const render::Scene& scene, int threads) {
    render::Scene plain = scene;
    plain.colors.reset();
    const render::ColorTable& own = render::colors_of(scene);
    const render::ColorTable& classes = render::colors_of(plain);
    if (own == classes) return "Colors: the classes of the moment, as --colors nws has them.\n";
    TimedPicture with, without;
    for (int round = 0; round < rounds; ++round) {
        draw(view, own, scene, threads, with);
        draw(view, classes, plain, threads, without);
    }
    const auto apart = render::image_difference(with.picture, without.picture);
    return fmt::format(
        "Colors: {}, dE {} from the classes of --colors nws; drawn in {}, with those in {}.\n",
        own.name, apart ? accuracy::format_number(apart->percentile_99) : "unknown",
        accuracy::format_seconds(with.least_s), accuracy::format_seconds(without.least_s));
}

}  // namespace

std::string look_costs(const grid::BrickView& view, const render::Scene& scene, double fit_s,
                       int threads) {
    const std::string colors = text_of_colors(view, scene, threads);
    if (!(fit_s > 0)) return colors + "View:   as asked for; nothing was fitted.\n";
    return colors + fmt::format(
                        "View:   fitted to the echo in {}; it says what is in the picture "
                        "and has no error.\n",
                        accuracy::format_seconds(fit_s));
}

}  // namespace stormcellar::cli
