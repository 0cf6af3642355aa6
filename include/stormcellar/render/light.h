// stormcellar/render/light.h -- how echo is lit, where a scene asks for it.
//
// Light makes colours darker and never changes their hue: a sample's colour is multiplied by one
// factor of 0 to 1. Off, echo has exactly the table's colours.
//   gradient    surfaces turned away from the sun are darker. By the gradient of the values, so
//   much
//               as it is steep; cells without a value count as none
//   shadow      what lies between a place and the sun takes light from it, and what lies about it
//               takes light from the sky (ambient occlusion)
//   scattering  as shadow, but brightest where one looks towards the sun through echo: single
//               scattering, Henyey and Greenstein's phase function with g = 0.4
#pragma once

#include <string>

#include "stormcellar/base/result.h"

namespace stormcellar::render {

struct Light {
    bool gradient = false;
    bool shadow = false;
    bool scattering = false;
    double sun_azimuth_deg = 225;   // where it stands, clockwise from north
    double sun_elevation_deg = 40;  // render/scene.h says what it may be

    [[nodiscard]] bool any() const { return gradient || shadow || scattering; }
    [[nodiscard]] bool needs_volume() const { return shadow || scattering; }
};

// "none", or of gradient, shadow and scattering those that it names, with commas; bad_argument.
[[nodiscard]] Status set_light(const std::string& names, Light& light);
// As set_light() takes them.
[[nodiscard]] std::string light_names(const Light& light);

}  // namespace stormcellar::render
