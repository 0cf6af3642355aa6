// render/frame/overlay_text.h -- says which storm cells a picture marks, how they were found, and
// how many shapes of files it shows.
//
// Threads   Pure functions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stormcellar/render/overlays.h"

namespace stormcellar::render {

// Returns short lines for the labels: the number of cells, the least peak, and the number of
// volumes through which they were followed. One volume shows no motion, so the lines say that there
// is no forecast.
[[nodiscard]] std::vector<std::string> cell_notes(const CellOverlay& overlay);

// Returns the same lines with the whole method, for the metadata of a picture.
[[nodiscard]] std::string cells_sentence(const CellOverlay& overlay);
// Returns the method alone, for the metadata of a loop.
[[nodiscard]] std::string cells_method(const std::optional<retrieve::FreezingLevels>& freezing,
                                       const retrieve::CellOptions& method = {});

// Returns how many of the shapes are drawn in a picture of this time: "3 of 8 in force", or "3 of 8
// in force, 2 unknown" if the file has parts that cannot be drawn.
[[nodiscard]] std::string shapes_shown(const ShapeOverlay& shapes, UtcTime time);

}  // namespace stormcellar::render
