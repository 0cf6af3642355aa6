// web/data/pictures/map_product.h -- the 2D products of a domain as layers of a map, by name.
//
// A layer is a product of a moment, as in "composite.VEL". A product that always needs reflectivity
// has a name without a moment ("vil"). For other products, a name without a moment means REF. A
// rain total has its length in hours, from 1 to 24: "rain-total.3h".
//
// Threads   Plain values and pure functions.
// Errors    See each function.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/still/plane_picture.h"
#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/render/product.h"
#include "stormcellar/render/scene.h"
#include "web/data/pictures/picture_query.h"

namespace stormcellar::web {

struct MapProduct {
    render::Product product = render::Product::composite;
    level2::Moment moment = level2::Moment::ref;
    int hours = 0;  // of a rain total, whose grid RainTotals makes; 0: a product of a kept grid

    [[nodiscard]] std::string name() const;
    bool operator==(const MapProduct&) const = default;
};

// Returns the moment after the dot of a layer's name, or REF if there is no dot. Errors: not_found,
// with a list of the moments.
[[nodiscard]] Result<level2::Moment> moment_in_layer(std::string_view name);

// Finds the product. Errors: not_found, with a list of the products, for a name of another form,
// for a product that is not a map of a grid, and for a moment that the product does not have.
[[nodiscard]] Result<MapProduct> map_product_named(std::string_view name);

// Returns the layers that grids of these moments have, in the order of products. Rain totals are
// those of 1, 3 and 24 hours.
[[nodiscard]] std::vector<MapProduct> map_products_of(const std::vector<level2::Moment>& moments);

// Returns the title of a product, and the length of a rain total.
[[nodiscard]] std::string title_of(const MapProduct& layer, const render::Scene& scene);
[[nodiscard]] std::string title_of(const MapProduct& layer);  // with the usual options

// A layer with the options of a query.
struct MapStyle {
    MapProduct layer;
    render::Scene scene;
    std::string key;  // the whole style as one text, for keys of kept answers
    render::PlaneLook look = render::PlaneLook::overlay;
};

// Returns true for the options that a layer takes as parameters: colors, smooth, height-km,
// echo-top-dbz, freezing-levels.
[[nodiscard]] bool is_of_layers(const render::PictureOption& option);

// Reads the options of a layer. Ignores parameters named in `others`, which the caller reads.
// Without options, cells are drawn unsmoothed, with colors without classes. Errors: bad_argument.
[[nodiscard]] Result<MapStyle> map_style(const MapProduct& layer, const Fields& query,
                                         std::span<const std::string_view> others);

}  // namespace stormcellar::web
