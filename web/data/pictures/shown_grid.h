// web/data/pictures/shown_grid.h -- the cells that a picture of a grid shows: those of the open
// grid or, for hail of a mosaic, the hail of its radars, merged by maximum
// (pipeline/mosaic/hail_of_frame.h).
//
// If the hail of the radars cannot be merged, because the mosaic is too large or their grids are
// gone, the picture shows the hail of the merged reflectivity, and a note says so.
//
// Threads   A ShownGrid is constant. The open grid must outlive it.
// Errors    See shown_grid().
#pragma once

#include <filesystem>
#include <optional>

#include "pipeline/mosaic/hail_of_frame.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/scene.h"
#include "web/data/grids/grids.h"

namespace stormcellar::web {

class ShownGrid {
  public:
    explicit ShownGrid(const OpenGrid& grid) : grid_(&grid) {}
    ShownGrid(const OpenGrid& grid, pipeline::HailFrame hail)
        : grid_(&grid), hail_(std::move(hail)) {}
    ShownGrid(const OpenGrid& grid, cache::GridDescription description)
        : grid_(&grid), description_(std::move(description)) {}

    [[nodiscard]] grid::BrickView view() const {
        return hail_ ? hail_->bricks.view() : grid_->file.view();
    }
    [[nodiscard]] const cache::GridDescription& description() const {
        if (hail_) return hail_->description;
        return description_ ? *description_ : grid_->file.description();
    }
    // Checks that the file of the open grid was not truncated. Call it after using the view.
    [[nodiscard]] Status check_whole() const { return grid_->file.check_whole(); }

  private:
    const OpenGrid* grid_;
    std::optional<pipeline::HailFrame> hail_;
    std::optional<cache::GridDescription> description_;  // with another note
};

// Returns what the scene shows of the grid. `cache` is the directory of the cache that has it.
// Errors: those of pipeline::hail_of_frame(), except not_found and over_budget.
[[nodiscard]] Result<ShownGrid> shown_grid(const std::filesystem::path& cache, const OpenGrid& grid,
                                           const render::Scene& scene, int threads);

}  // namespace stormcellar::web
