// stormcellar/render/light.h -- how echo is lit, if a scene asks for it.
//
// Light makes colors lighter or darker and keeps their hue: each pixel has one factor, which is
// applied once. The echo of a picture keeps the mean lightness that it has without light. With the
// light off, echo has exactly the colors of the table.
//   gradient    Surfaces are lighter where they face the sun and darker where they face away. The
//               effect follows the gradient of the values and grows with its steepness. A cell
//               without echo counts as 0 dBZ, and a cell that was not seen takes the value of the
//               nearest seen cell of its column.
//   shadow      Echo between a place and the sun dims sunlight there, and echo around the place
//               dims the light of the sky (ambient occlusion).
//   scattering  Like shadow, but echo is brightest where the camera looks through it toward the
//               sun (single scattering, phase function of Henyey and Greenstein, g = 0.4).
//
// Units     Degrees.
// Threads   Plain data and pure functions.
// Errors    See set_light().
#pragma once

#include <string>

#include "stormcellar/base/result.h"

namespace stormcellar::render {

struct Light {
    bool gradient = false;
    bool shadow = false;
    bool scattering = false;
    double sun_azimuth_deg = 225;   // direction of the sun, clockwise from north
    double sun_elevation_deg = 40;  // range: limits in stormcellar/render/scene.h

    [[nodiscard]] bool any() const { return gradient || shadow || scattering; }
    [[nodiscard]] bool needs_volume() const { return shadow || scattering; }
};

// Sets the light from a list of names, separated by commas: "none", or some of gradient, shadow and
// scattering. Returns bad_argument for any other name and for "none" beside other names; `light` is
// then unchanged.
[[nodiscard]] Status set_light(const std::string& names, Light& light);
// Returns the names as set_light() takes them.
[[nodiscard]] std::string light_names(const Light& light);

}  // namespace stormcellar::render
