// render/still/map_raster.h -- makes a 2D product for formats of maps: its field, and the color
// that each cell has over another map.
//
// Threads   Pure functions; the same bits for any number of threads.
#pragma once

#include "render/products/flat_field.h"
#include "stormcellar/render/still.h"

namespace stormcellar::render {

// Checks the scene and makes the field of its product. Errors: bad_argument for a product that is
// no map, and those of check_frame().
[[nodiscard]] Result<FlatField> still_field(const StillMap& map, int threads);

// Returns the color over another map. No echo, and values that the table does not show, are
// transparent. Cells that were not seen have a thin gray veil, which looks unlike any echo.
[[nodiscard]] Rgba8 overlay_color(const FlatField& field, std::size_t place,
                                  const ColorTable& table);
[[nodiscard]] Rgba8 overlay_color(grid::CellStatus status, float value, const ColorTable& table);

inline constexpr Rgba8 unseen_veil = {96, 100, 108, 72};

}  // namespace stormcellar::render
