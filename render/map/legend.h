// render/map/legend.h -- makes the texts beside a picture: the name of its product, the product's
// colors, and their meaning.
//
// Threads   Plain values and a pure function.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stormcellar/render/color_table.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

struct LegendRow {
    std::string text;
    Rgba8 color{};
    std::optional<Rgba8> lines = {};  // the color is hatched with lines of this color
};

struct Legend {
    std::string product;  // "Composite reflectivity (column maximum)"
    std::string heading;  // over the rows; may be empty
    // From the top down: colors that the color bar does not have.
    std::vector<LegendRow> rows;
    std::vector<std::string> notes;     // in small print below
    std::string bar_heading;            // the unit, else the name of the moment
    const ColorTable* table = nullptr;  // of the color bar; null: no bar
    // Factor by which the table's numbers are multiplied for the bar.
    double shown_per_value = 1;
};

// Makes the legend of a valid scene. The table of the scene must outlive the legend.
[[nodiscard]] Legend legend_of(const Scene& scene);

// Adds the colors of rotation over a volume.
void add_rotation_rows(Legend& legend);

}  // namespace stormcellar::render
