// render/map/legend.h -- what a product says of itself beside the picture: its name, its colours,
// what stands for what.
#pragma once

#include <string>
#include <vector>

#include "stormcellar/render/colour_table.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

struct LegendRow {
    std::string text;
    Rgba8 colour{};
    bool hatched = false;
};

struct Legend {
    std::string product;                 // "Composite reflectivity (column maximum)"
    std::string heading;                 // over the rows; may be empty
    std::vector<LegendRow> rows;         // from the top down: what is not in the colour bar
    std::vector<std::string> notes;      // in small print below
    std::string bar_heading;             // the unit, else the moment's name
    const ColourTable* table = nullptr;  // of the colour bar; none: no bar
};

// Of a valid scene, whose table must outlive the legend.
[[nodiscard]] Legend legend_of(const Scene& scene);

}  // namespace stormcellar::render
