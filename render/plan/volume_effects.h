// render/plan/volume_effects.h -- the ladder of a volume's picture: its steps, rungs and effects.
//
//   slices       32 ... 2048, each effect twice as many as before: slices_64, slices_128, ...
//   integration  the nearer value of each step; value_span: all values between its ends;
//                step_attenuation: in their order, the near hiding the far
//   pixels       interpolated between rays where the picture is straight; every_pixel: a ray each
//   surface      as bright whatever way it faces; gradient_light: darker turned away from the sun
//   light        everywhere the same; shadow_light: sun and sky that come through;
//                scattering_light: that, scattered once towards the camera
// What light the scene has not (stormcellar/render/light.h) it does not ask for, and the exact
// picture is without, too. Camera, exaggeration and the earth's curve are the scene's own: they say
// what is to be seen. Sizes are colours (CIEDE2000). The exact form has every effect on; how far
// 2048 slices still are from infinitely many is in docs/accuracy.md. Thread contract: values and
// pure functions.
#pragma once

#include "render/volume/slicer.h"
#include "stormcellar/accuracy/chain.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

// Names a rung of each step.
struct VolumeChoice {
    int slices = 256;
    Integration integration = Integration::second_order;
    bool every_pixel = true;
    bool gradient = false, shadow = false, scattering = false;  // scattering with shadow

    bool operator==(const VolumeChoice&) const = default;
};

// Between rays that are not cast: two of 255 levels.
inline constexpr double interpolated_tolerance = 2.0 / 255;

// Settings are automatic, or not_asked for the kinds of light that the scene has not. Sizes and
// costs are 0 until predict() (render/plan/volume_plan.h).
[[nodiscard]] accuracy::Chain volume_chain(const Light& light = {});

// Errors: none; the chain is one of volume_chain().
[[nodiscard]] VolumeChoice volume_choice(const accuracy::Chain& chain,
                                         const accuracy::Choice& choice);
// The rungs of a choice; its slices are rounded up to a rung.
[[nodiscard]] accuracy::Choice rungs_of(const accuracy::Chain& chain, const VolumeChoice& choice);
}  // namespace stormcellar::render
