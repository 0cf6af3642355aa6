// render/volume/lit_layer.h -- lights a picture of a volume: one factor changes the color of each
// pixel.
//
// The rays find the color, and also the mean factor of the light along them
// (render/volume/shade_field.h), with the same weights as the colors. In OKLab (Ottosson 2020), in
// which the hue stays, a factor below 1 darkens and a factor above 1 lightens:
//   darker   l' = l max(0.5, 1 - 0.9 (1 - f)), chroma times sqrt(l' / l)
//   lighter  l' = l + (0.98 - l) (1 - exp(-1.44 (f - 1)))
// If displays cannot show a color, its chroma is reduced until they can. All factors of a picture
// are first multiplied by its exposure, 0.7 to 1.4. The exposure is chosen to keep the mean
// lightness of the echo as near as possible to that without light.
//
// Threads   Pure; the same bits for any number of threads.
// Accuracy  The hue stays within 1.5 degrees of OKLab, except in colors that are nearly gray. On
//           real volumes, this holds for 95 % of the echo, and the mean lightness (L*) of the echo
//           stays within 1 (tests/render/lit_layer_test.cpp).
#pragma once

#include <array>
#include <vector>

#include "render/image/layer.h"

namespace stormcellar::render {

using Rgb = std::array<float, 3>;  // sRGB, 0..1

// Returns a color, darkened or lightened by a factor.
[[nodiscard]] Rgb lit_color(const Rgb& color, float factor);
// Returns the exposure; 1 for a layer without echo. `light` has, for each pixel, the sum of the
// factors weighted by the seen opacity, that is, the mean factor times alpha.
[[nodiscard]] float exposure_of(const Layer& layer, const std::vector<float>& light);
void apply_light(Layer& layer, const std::vector<float>& light, int threads);

}  // namespace stormcellar::render
