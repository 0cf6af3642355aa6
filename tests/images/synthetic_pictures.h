// tests/images/synthetic_pictures.h -- pictures that need no data: scenes of grids made from a
// function of place without any symmetry, and the errors that can be made in them.
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

// Makes the picture of a name, which must be one of picture_names().
[[nodiscard]] Picture make_picture(const std::string& name);
[[nodiscard]] const std::vector<std::string>& picture_names();

[[nodiscard]] Result<render::Image> draw(const Picture& picture);

// Mirrors the grid east-west; its site stays where it is.
void mirror(grid::Grid& grid);
// Exchanges the colors of two neighboring classes of the scene.
void swap_classes(render::Scene& scene, std::size_t first);

}  // namespace stormcellar::images
