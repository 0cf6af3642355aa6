// tests/images/synthetic_pictures.h -- pictures of synthetic grids without any symmetry, and
// functions that put errors into them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/render/render.h"

namespace stormcellar::images {

struct Picture {
    std::string name;  // name of its reference
    render::Scene scene;
    render::FrameFacts facts;
    grid::Grid grid;
};

// Makes the picture of this name, one of picture_names().
[[nodiscard]] Picture make_picture(const std::string& name);
[[nodiscard]] const std::vector<std::string>& picture_names();

[[nodiscard]] Result<render::Image> draw(const Picture& picture);

// Mirrors the grid east-west; the site does not move.
void mirror(grid::Grid& grid);
void swap_classes(render::Scene& scene, std::size_t first);

}  // namespace stormcellar::images
