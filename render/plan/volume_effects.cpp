#include "render/plan/volume_effects.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace stormcellar::render {
namespace {

using accuracy::make_effect;

constexpr int fewest_slices = 32;
constexpr int most_slices = 2048;
// The unit of efforts is arbitrary but fixed. A slice has this effort in every scene.
constexpr double effort_of_a_slice = 1e-3;
constexpr double effort_of_a_table = 1e-3;
constexpr double effort_of_every_pixel = 2e-2;

constexpr double effort_of_gradient = 0.2;
constexpr double effort_of_light_volume = 0.1;

enum StepNumber : std::size_t {
    slices_step,
    integration_step,
    pixels_step,
    surface_step,
    light_step
};

accuracy::Step slices() {
    accuracy::Step step{"slices", fmt::format("{} slices", fewest_slices), {}};
    for (int count = 2 * fewest_slices; count <= most_slices; count *= 2) {
        step.effects.push_back(make_effect(
            fmt::format("slices_{}", count), fmt::format("{} slices", count),
            fmt::format("Details that lie between {} slices are seen with {}.", count / 2, count),
            effort_of_a_slice * count / 2));
    }
    return step;
}

accuracy::Effect light(std::string name, std::string what, std::string rung, double effort,
                       bool is_asked) {
    accuracy::Effect made = make_effect(std::move(name), std::move(rung), std::move(what), effort);
    if (!is_asked) made.setting = accuracy::Setting::not_asked;
    return made;
}

}  // namespace

accuracy::Chain volume_chain(const Light& asked) {
    accuracy::Chain chain;
    chain.steps.push_back(slices());
    chain.steps.push_back(
        {"integration",
         "the nearer value of each step",
         {make_effect("value_span", "all values of each step",
                      "A step crosses all values between its two ends.", effort_of_a_table),
          make_effect("step_attenuation", "all values of each step in their order",
                      "The near part of a step hides its far part.", effort_of_a_table)}});
    chain.steps.push_back(
        {"pixels",
         "interpolated where the picture is straight",
         {make_effect("every_pixel", "a ray for each pixel", "The picture bends between two rays.",
                      effort_of_every_pixel)}});
    chain.steps.push_back(
        {"surface",
         "as bright whatever way it faces",
         {light(
             "gradient_light", "Steep surfaces are lighter toward the sun and darker away from it.",
             "lighter toward the sun, darker away from it", effort_of_gradient, asked.gradient)}});
    chain.steps.push_back(
        {"light",
         "everywhere the same",
         {light("shadow_light", "Echo throws shadows, and hides the sky from itself.",
                "sun and sky that come through", effort_of_light_volume, asked.needs_volume()),
          light("scattering_light", "Echo sends more of the light on than back.",
                "sun and sky, scattered once", effort_of_light_volume, asked.scattering)}});
    return chain;
}

VolumeChoice volume_choice(const accuracy::Chain& chain, const accuracy::Choice& choice) {
    static_cast<void>(chain);
    constexpr std::array integrations = {Integration::riemann, Integration::first_order,
                                         Integration::second_order};
    VolumeChoice made;
    made.slices = fewest_slices << choice.rungs[slices_step];
    made.integration = integrations[choice.rungs[integration_step]];
    made.every_pixel = choice.rungs[pixels_step] == 1;
    made.gradient = choice.rungs[surface_step] == 1;
    made.shadow = choice.rungs[light_step] >= 1;
    made.scattering = choice.rungs[light_step] == 2;
    return made;
}

accuracy::Choice rungs_of(const accuracy::Chain& chain, const VolumeChoice& choice) {
    accuracy::Choice made;
    made.rungs.resize(chain.steps.size());
    std::size_t& rung = made.rungs[slices_step];
    while (fewest_slices << rung < choice.slices && rung < chain.steps[slices_step].effects.size())
        ++rung;
    made.rungs[integration_step] = static_cast<std::size_t>(choice.integration);
    made.rungs[pixels_step] = choice.every_pixel ? 1 : 0;
    made.rungs[surface_step] = choice.gradient ? 1 : 0;
    made.rungs[light_step] = choice.scattering ? 2 : choice.shadow ? 1 : 0;
    return made;
}

}  // namespace stormcellar::render
