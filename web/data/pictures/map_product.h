// web/data/pictures/map_product.h -- the 2D products of a domain as layers of a map, by name.
//
// A layer is a product and a moment: "composite.VEL". The name of a product that needs reflectivity
// has no moment ("vil"); any other name without a moment means REF.
//
// Threads   Plain values and pure functions.
// Errors    See each function.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/render/product.h"
#include "stormcellar/render/scene.h"
#include "web/data/pictures/picture_query.h"

namespace stormcellar::web {

struct MapProduct {
    render::Product product = render::Product::composite;
    level2::Moment moment = level2::Moment::ref;

    [[nodiscard]] std::string name() const;
    bool operator==(const MapProduct&) const = default;
};

// Finds the product. Errors: not_found, listing the products, for a name of another form, for a
// product that is not a map of a grid, and for a moment that the product does not have.
[[nodiscard]] Result<MapProduct> map_product_named(std::string_view name);

// Returns the layers that grids of these moments give, in the order of products.
[[nodiscard]] std::vector<MapProduct> map_products_of(const std::vector<level2::Moment>& moments);

// A layer with the options of a query.
struct MapStyle {
    MapProduct layer;
    render::Scene scene;
    std::string key;  // the whole style as one text, for keys of kept answers
};

// Returns true for options that a layer takes as parameters: colors, smooth, height-km,
// echo-top-dbz.
[[nodiscard]] bool is_of_layers(const render::PictureOption& option);

// Reads the options of a layer. Parameters named in `others` are left to the door. Without options,
// cells are drawn unsmoothed, in colors without classes. Errors: bad_argument.
[[nodiscard]] Result<MapStyle> map_style(const MapProduct& layer, const Fields& query,
                                         std::span<const std::string_view> others);

}  // namespace stormcellar::web
