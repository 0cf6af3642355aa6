// render/scene.h -- what is to be shown: product, camera, colours, labels.
#pragma once

#include <string>

#include "base/result.h"
#include "level2/volume.h"

namespace stormcellar::render {

enum class Product { volume, composite };
[[nodiscard]] Result<Product> product_from_name(std::string_view name);  // bad_argument lists names
[[nodiscard]] std::string_view product_name(Product product);

// Orthographic camera that looks at the grid's centre, at sea level.
struct Camera {
    double azimuth_deg = 180;  // from where it looks: 180 is from the south, north is up
    double tilt_deg = 55;      // from the vertical: 0 straight down, 90 along the ground
    double zoom = 1;           // 1: the whole grid fits into the image
};

struct Scene {
    Product product = Product::volume;
    int width = 796, height = 532;  // pixels; 16..8192
    Camera camera;
    int slices = 256;                  // parallel to the image plane; 8..4096
    double vertical_exaggeration = 8;  // stated in the picture
    double opacity = 1;                // scales the transfer function's opacity, > 0
    double range_ring_spacing_m = 50e3;
    bool labels = true;  // colour bar, title, time, rings
};
[[nodiscard]] Status validate(const Scene& scene);  // bad_argument names the field

}  // namespace stormcellar::render
