// tests/export/grib_map_test.cpp and tests/export/check_grib.py read the files.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/still/still_format.h"
#include "stormcellar/render/product.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

using ::testing::HasSubstr;

// Returns the error of a map, or an empty text.
std::string refusal(grid::Projection projection, Product product) {
    grid::GridSpec spec = small_spec(40, 10, 1500, 750);
    spec.projection = projection;
    if (spec.in_degrees()) {
        spec.spacing_m = 0;
        spec.spacing_deg = 0.0125;
    }
    const grid::Grid grid = storm_grid(spec);
    const grid::BrickGrid bricks = bricks_of(grid);
    const FrameFacts facts = facts_of(grid);
    Scene scene;
    scene.product = product;
    const auto bytes = encode_grib({bricks.view(), facts, scene}, {});
    if (bytes) return {};
    EXPECT_EQ(bytes.error().code, ErrorCode::unsupported);
    return bytes.error().message;
}

TEST(StillGrib, HasTheEndingsOfGrib) {
    EXPECT_EQ(still_format_of("a.grib2")->name, "GRIB2");
    EXPECT_EQ(still_format_of("a.grb2")->name, "GRIB2");
}

TEST(StillGrib, SaysWhichProductsAndGridsGribHas) {
    const auto degrees = grid::Projection::latitude_longitude;
    const auto plane = grid::Projection::azimuthal_equidistant;
    for (const Product product : {Product::posh, Product::vil_density, Product::lowest_seen}) {
        const std::string why = refusal(degrees, product);
        EXPECT_THAT(why, HasSubstr(std::string(product_name(product))));
        EXPECT_THAT(why, HasSubstr("composite of REF"));
    }
    EXPECT_THAT(refusal(plane, Product::mesh), HasSubstr("--projection latitude_longitude"));
#if STORMCELLAR_GRIB
    for (const Product product :
         {Product::composite, Product::cappi, Product::echo_top, Product::vil, Product::mesh})
        EXPECT_EQ(refusal(degrees, product), "") << product_name(product);
#else
    EXPECT_THAT(refusal(degrees, Product::mesh), HasSubstr("has no ecCodes"));
#endif
}

}  // namespace
}  // namespace stormcellar::render
