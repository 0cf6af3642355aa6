// render/map/legend.h -- what a product says of itself beside the picture: its name, its colours,
// what stands for what.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "level2/volume.h"
#include "render/colour/colour_table.h"
#include "render/scene.h"

namespace stormcellar::render {

struct LegendRow {
    std::string text;
    Rgba8 colour{};
    bool hatched = false;
};

struct Legend {
    std::string product;                 // "Composite reflectivity (column maximum)"
    std::string heading;                 // over the rows; may be empty
    std::vector<LegendRow> rows;         // from the top down
    std::vector<std::string> notes;      // in small print below
    const ColourTable* table = nullptr;  // of the colour bar; none: no bar
};

// "Radial velocity"
[[nodiscard]] std::string_view moment_words(level2::Moment moment);

// Of the products of render/scene.h. `table` must outlive the legend.
[[nodiscard]] Legend legend_of(const Scene& scene, level2::Moment moment, const ColourTable& table);

}  // namespace stormcellar::render
