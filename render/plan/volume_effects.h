// render/plan/volume_effects.h -- defines the steps of drawing a volume, the ways to do each
// (rungs), and the effects that lead from rung to rung.
//
// Each step has a lowest rung, and each of its effects turns on the next rung. The list gives the
// lowest rung of each step, and then each effect with its rung:
//   slices       32 ... 2048; each effect doubles the number: slices_64, slices_128, ...
//   integration  the nearer value of each step; value_span: all values between the ends of the
//                step; step_attenuation: all values in their order, so that near values hide far
//                values
//   pixels       interpolated between rays where the picture is nearly straight; every_pixel: a ray
//                for each pixel
//   surface      equally bright in every direction; gradient_light: lighter toward the sun and
//                darker away from it
//   light        equally strong everywhere; shadow_light: the light of sun and sky that gets
//                through; scattering_light: the light that gets through and is scattered once
//                toward the camera
// Kinds of light that the scene does not have (stormcellar/render/light.h) are not_asked, so the
// exact picture does not have them either. Camera, exaggeration and the curve of the earth are part
// of the scene, because they define what is shown. Sizes are color differences (CIEDE2000). In the
// exact form, every effect is on; docs/accuracy.md says how far 2048 slices are from infinitely
// many.
//
// Threads   Plain values and pure functions.
#pragma once

#include "render/volume/slicer.h"
#include "stormcellar/accuracy/chain.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

// One rung for each step.
struct VolumeChoice {
    int slices = 256;
    Integration integration = Integration::second_order;
    bool every_pixel = true;
    bool gradient = false, shadow = false, scattering = false;  // scattering includes shadow

    bool operator==(const VolumeChoice&) const = default;
};

// The tolerance between two rays for interpolating the pixels between them: two of 255 levels.
inline constexpr double interpolated_tolerance = 2.0 / 255;

// Returns the chain. Settings are automatic, but not_asked for kinds of light that the scene does
// not have. Sizes and costs are 0 until predict() sets them (render/plan/volume_plan.h).
[[nodiscard]] accuracy::Chain volume_chain(const Light& light = {});

// Returns the rungs of a choice as members. The chain must come from volume_chain().
[[nodiscard]] VolumeChoice volume_choice(const accuracy::Chain& chain,
                                         const accuracy::Choice& choice);
// Returns the choice that has these rungs. The number of slices is rounded up to a rung.
[[nodiscard]] accuracy::Choice rungs_of(const accuracy::Chain& chain, const VolumeChoice& choice);
}  // namespace stormcellar::render
