// stormcellar/render/product.h -- the products that a picture can show, and the facts about each.
//
// This is the only list of products. render/products/flat_field.h says how the numbers of a map are
// made, and CONTRIBUTING.md says how to add a product. The table of options knows which options of
// the command line a product uses.
//
// Threads   Constants and pure functions.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/moment.h"
#include "stormcellar/retrieve/hail.h"

namespace stormcellar::render {

struct ColorTable;
struct Scene;
struct ShownUnit;

enum class Product {
    volume,
    composite,
    ppi,
    cappi,
    section,
    echo_top,
    vil,
    vil_density,
    maximum_height,
    lowest_seen,
    highest_seen,
    rotation,
    rotation_aloft,
    rotation_tracks,
    mesh,
    posh,
    shi,
    rain_total
};

// The kind of picture that a product makes.
enum class View {
    volume,   // the grid in three dimensions, by a camera
    map,      // one value for each column of the grid, seen from above
    section,  // a vertical section between two places
};

// Heights above the radar; the bottom belongs to the layer.
struct HeightLayer {
    double bottom_m = 0, top_m = 0;
};

struct ProductFacts {
    Product product = Product::volume;
    std::string_view name = {};   // on the command line and in scene files
    std::string_view aside = {};  // text that help adds to the name in brackets
    View view = View::map;
    std::string (*title)(const Scene&) = nullptr;    // "Echo tops, 18.5 dBZ"
    std::string_view unit = {};                      // empty: the moment's
    const ColorTable& (*colors)() = nullptr;         // null: the moment's
    std::optional<level2::Moment> only_moment = {};  // the only moment it is made of; none: any
    // The value that echo must reach for a column to have a value.
    double Scene::*threshold_dbz = nullptr;
    bool may_be_higher = false;  // for tops: the picture marks where the true value may be larger
    // True if a column that was seen may be without a value: no echo, or range folded.
    bool has_echo_states = true;
    bool is_smooth = false;  // true if the map may be drawn smoothly
    // True if the product draws a sweep (BrickView::sweep) instead of a grid.
    bool is_of_sweep = false;
    std::optional<HeightLayer> layer = {};  // the layer whose largest value it shows
    float retrieve::Hail::*hail = nullptr;  // for hail: the number that it shows
    // True if the product shows the largest values of several volumes
    // (cli/picture/frame_sources.h).
    bool is_over_time = false;
    bool is_sum = false;  // true: a product over time shows sums, not largest values
};

[[nodiscard]] std::span<const ProductFacts> all_products();
[[nodiscard]] const ProductFacts& facts_of(Product product);
[[nodiscard]] std::string_view product_name(Product product);
[[nodiscard]] Result<Product> product_from_name(std::string_view name);  // else bad_argument
// Returns the names, each with its `aside`: "volume, composite (column maximum), ... or
// highest-seen".
[[nodiscard]] std::string products_for_help();
[[nodiscard]] View view_of(Product product);
[[nodiscard]] bool is_map(Product product);

// Returns a title such as "Composite reflectivity (column maximum)".
[[nodiscard]] std::string product_title(const Scene& scene);
// Returns the scene's table, or else the product's, or else the moment's.
[[nodiscard]] const ColorTable& colors_of(const Scene& scene);
// Returns the unit of the product's values: "dBZ", "km"; empty for a number without a unit.
[[nodiscard]] std::string unit_shown(const Scene& scene);
// Returns the unit in which the picture writes the product's values.
[[nodiscard]] ShownUnit written_unit(const Scene& scene);

}  // namespace stormcellar::render
