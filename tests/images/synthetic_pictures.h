// tests/images/synthetic_pictures.h -- the pictures that need no data: scenes of grids made from a
// function of place, in which nothing is symmetric, and what can be wrong with them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/render/render.h"

namespace stormcellar::images {

struct Picture {
    std::string name;  // of its reference
    render::Scene scene;
    render::FrameFacts facts;
    grid::Grid grid;
};

// By name; the name is one of picture_names().
[[nodiscard]] Picture make_picture(const std::string& name);
[[nodiscard]] const std::vector<std::string>& picture_names();

[[nodiscard]] Result<render::Image> draw(const Picture& picture);

// The grid mirrored east-west; its site stays where it is.
void mirror(grid::Grid& grid);
// The scene's colors with those of two neighboring classes exchanged.
void swap_classes(render::Scene& scene, std::size_t first);

}  // namespace stormcellar::images
