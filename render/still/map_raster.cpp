#include "render/still/map_raster.h"

#include "render/products/column_summary.h"
#include "stormcellar/render/product.h"
#include "stormcellar/render/render.h"

namespace stormcellar::render {

Result<FlatField> still_field(const StillMap& map, int threads) {
    if (!is_map(map.scene.product)) {
        return fail(ErrorCode::bad_argument,
                    "{} is no map; GeoTIFF, netCDF and KMZ hold products that are maps, such as {}",
                    product_name(map.scene.product), product_name(Product::composite));
    }
    if (auto valid = check_frame(map.view, map.facts, map.scene); !valid) return pass_on(valid);
    // Other products do not use the columns.
    const bool uses_columns =
        map.scene.product == Product::composite || facts_of(map.scene.product).hail != nullptr;
    const auto columns =
        uses_columns ? summarize_columns(map.view, threads) : std::vector<ColumnSummary>{};
    return map_field(map.view, map.facts, map.scene, columns, threads);
}

Rgba8 overlay_color(const FlatField& field, std::size_t place, const ColorTable& table) {
    return overlay_color(field.status[place], field.values[place], table);
}

Rgba8 overlay_color(grid::CellStatus status, float value, const ColorTable& table) {
    constexpr Rgba8 clear = {0, 0, 0, 0};
    switch (status) {
        case grid::CellStatus::not_seen:
            return unseen_veil;
        case grid::CellStatus::no_echo:
            return clear;
        case grid::CellStatus::range_folded:
            return table.range_folded;
        case grid::CellStatus::ambiguous: {
            Rgba8 half = table.range_folded;
            half[3] /= 2;
            return half;
        }
        case grid::CellStatus::value:
            return color_of(table, value).value_or(clear);
    }
    return clear;
}

}  // namespace stormcellar::render
