// render/scene.h -- what is to be shown: product, camera, colours, labels.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "level2/volume.h"

namespace stormcellar::render {

enum class Product { volume, composite };
[[nodiscard]] Result<Product> product_from_name(std::string_view name);  // bad_argument lists names
[[nodiscard]] std::string_view product_name(Product product);

// Orthographic camera that looks at the middle of the box of the cells and the ground under them.
struct Camera {
    double azimuth_deg = 180;  // from where it looks: 180 is from the south, north is up; finite
    double tilt_deg = 55;      // from the vertical: 0 straight down, 90 along the ground; 0..90
    double zoom = 1;           // 1: the whole grid fits into the image; 0.01..1000
};

struct Scene {
    Product product = Product::volume;
    int width = 796, height = 532;  // pixels; 16..8192
    Camera camera;
    int slices = 256;                    // parallel to the image plane; 8..4096
    double vertical_exaggeration = 5;    // stated in the picture; 0.1..100
    double opacity = 1;                  // scales the transfer function's opacity; 0.001..1000
    double range_ring_spacing_m = 50e3;  // 1..1000 km
    bool labels = true;                  // colour bar, title, time, rings
};
// bad_argument names the first field that is outside its range; NaN is outside every range.
[[nodiscard]] Status validate(const Scene& scene);

}  // namespace stormcellar::render
