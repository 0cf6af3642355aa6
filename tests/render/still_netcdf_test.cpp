// Reads the netCDF of products with the netCDF library and with GDAL, and compares them with the
// field and with the GeoTIFF of the same product.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/still/map_attributes.h"
#include "render/still/map_raster.h"
#include "stormcellar/render/still.h"
#include "tests/export/netcdf_reader.h"
#include "tests/render/synthetic_storm.h"
#include "tests/testing/program.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::render {
namespace {

using ::testing::HasSubstr;

struct ProductCase {
    Product product;
    grid::Projection projection;
};

class StillNetcdf : public ::testing::TestWithParam<ProductCase> {
  protected:
    void SetUp() override { scene_.product = GetParam().product; }

    static grid::GridSpec spec_of(grid::Projection projection) {
        grid::GridSpec spec = small_spec(200, 20, 1500, 750);
        spec.ny = 170;
        return in_projection(spec, projection);
    }

    // Returns the storm. One half of its core is not seen above 6 km.
    static grid::Grid half_seen_storm(const grid::GridSpec& spec) {
        grid::Grid storm = storm_grid(spec);
        for (int iy = 0; iy < spec.ny; ++iy)
            for (int ix = 143; ix < spec.nx; ++ix)
                for (int iz = 8; iz < spec.nz(); ++iz)
                    storm.status[spec.index(ix, iy, iz)] = grid::CellStatus::not_seen;
        return storm;
    }

    [[nodiscard]] StillMap map() const { return {view_, facts_, scene_}; }
    void write(const std::string& name, const StillOptions& options = {}) const {
        const auto bytes = still_format_of(name)->encode_map(map(), options);
        ASSERT_TRUE(bytes) << bytes.error().message;
        std::ofstream(file(name), std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes->data()),
                   static_cast<std::streamsize>(bytes->size()));
    }
    [[nodiscard]] std::string file(const std::string& name) const { return directory_ / name; }

    testing::TemporaryDirectory directory_;
    grid::Grid grid_ = half_seen_storm(spec_of(GetParam().projection));
    grid::BrickGrid bricks_ = bricks_of(grid_);
    grid::BrickView view_ = bricks_.view();
    FrameFacts facts_ = facts_of(grid_);
    Scene scene_;
};

TEST_P(StillNetcdf, HasTheValueAndTheStateOfEachColumn) {
    write("a.nc");
    const auto field = still_field(map(), 1);
    ASSERT_TRUE(field);
    netcdf::Reader reader(file("a.nc"));
    const std::string name = map_variable(scene_.product);
    const auto values = reader.values(name.c_str(), field->values.size());
    const auto states = reader.values("status", field->values.size());
    const double fill = reader.number(name.c_str(), "_FillValue");
    std::set<double> seen;
    for (std::size_t place = 0; place < values.size(); ++place) {
        const bool valued = field->status[place] == grid::CellStatus::value;
        ASSERT_EQ(values[place], valued ? static_cast<double>(field->values[place]) : fill);
        ASSERT_EQ(states[place], static_cast<double>(state_of(*field, place)));
        seen.insert(states[place]);
    }
    EXPECT_TRUE(seen.contains(3)) << "the case has columns with a value";
    const auto flags = reader.numbers("status", "flag_values");
    for (const double state : seen)
        EXPECT_EQ(std::ranges::count(flags, state), 1) << state;
    EXPECT_TRUE(seen.contains(4) || !facts_of(scene_.product).may_be_higher);
    EXPECT_EQ(reader.text(name.c_str(), "ancillary_variables"), "status");
    EXPECT_EQ(reader.text(name.c_str(), "long_name"), product_title(scene_));
    EXPECT_EQ(reader.text(name.c_str(), "units"), unit_shown(scene_));
    EXPECT_EQ(reader.length("time"), 1U);
    EXPECT_TRUE(reader.is_unlimited("time"));
}

// GDAL turns the rows of both files from north to south.
TEST_P(StillNetcdf, GdalReadsTheValuesAndThePlaceOfTheGeotiff) {
    if (!std::filesystem::exists("/usr/bin/gdal_translate"))
        GTEST_SKIP() << "GDAL's programs are not installed (scripts/install-packages test)";
    write("a.nc");
    write("a.tif");
    const std::string inside =
        fmt::format("NETCDF:{}:{}", file("a.nc"), map_variable(scene_.product));
    const auto raw = [&](const std::string& from, const std::string& name) {
        const auto ran = testing::run_program("/usr/bin/gdal_translate",
                                              {"-q", "-of", "ENVI", from, file(name)});
        EXPECT_EQ(ran.status, 0) << ran.err;
        std::vector<float> cells(view_.spec->column_count());
        std::ifstream(file(name), std::ios::binary)
            .read(reinterpret_cast<char*>(cells.data()),
                  static_cast<std::streamsize>(cells.size() * sizeof(float)));
        return cells;
    };
    const auto ours = raw(inside, "nc.raw"), theirs = raw(file("a.tif"), "tif.raw");
    netcdf::Reader reader(file("a.nc"));
    const auto fill =
        static_cast<float>(reader.number(map_variable(scene_.product).c_str(), "_FillValue"));
    for (std::size_t i = 0; i < ours.size(); ++i)
        ASSERT_TRUE(std::isnan(theirs[i]) ? ours[i] == fill : ours[i] == theirs[i]) << i;
    const auto info = [&](const std::string& of) {
        const auto ran = testing::run_program("/usr/bin/gdalinfo", {"-json", of});
        EXPECT_EQ(ran.status, 0) << ran.err;
        return nlohmann::json::parse(ran.out);
    };
    const auto of_netcdf = info(inside), of_tiff = info(file("a.tif"));
    EXPECT_THAT(of_netcdf["coordinateSystem"]["wkt"].get<std::string>(),
                HasSubstr("6378137,298.257223563"));
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(of_netcdf["geoTransform"][i].get<double>(),
                    of_tiff["geoTransform"][i].get<double>(), 1e-6)
            << i;
}

INSTANTIATE_TEST_SUITE_P(
    Products, StillNetcdf,
    ::testing::Values(ProductCase{Product::composite, grid::Projection::azimuthal_equidistant},
                      ProductCase{Product::echo_top, grid::Projection::latitude_longitude},
                      ProductCase{Product::vil, grid::Projection::lambert_conformal},
                      ProductCase{Product::mesh, grid::Projection::azimuthal_equidistant},
                      ProductCase{Product::lowest_seen, grid::Projection::lambert_conformal}),
    [](const auto& tested) { return map_variable(tested.param.product); });

// A map of the synthetic storm as a file.
struct StormFile {
    explicit StormFile(Product product) { scene.product = product; }
    [[nodiscard]] std::string write(const StillOptions& options = {}) const {
        const grid::BrickView view = bricks.view();
        const auto bytes = still_format_of("a.nc")->encode_map({view, facts, scene}, options);
        EXPECT_TRUE(bytes) << bytes.error().message;
        std::string path = directory / "a.nc";
        if (bytes) {
            std::ofstream(path, std::ios::binary)
                .write(reinterpret_cast<const char*>(bytes->data()),
                       static_cast<std::streamsize>(bytes->size()));
        }
        return path;
    }
    testing::TemporaryDirectory directory;
    grid::Grid grid = storm_grid(small_spec(64, 20, 1500, 750));
    grid::BrickGrid bricks = bricks_of(grid);
    FrameFacts facts = facts_of(grid);
    Scene scene{};
};

TEST(StillNetcdfFacts, HailNamesTheHeightsThatWereAssumed) {
    StormFile file(Product::posh);
    file.scene.freezing_levels = {3100, 6200};
    StillOptions options;
    options.metadata = {{"Title", "KTLX"}, {"Hail error", "heights 300 m off"}, {"Units", "%"}};
    netcdf::Reader reader(file.write(options));
    EXPECT_EQ(reader.number("posh", "assumed_height_of_0_C_m"), 3100);
    EXPECT_EQ(reader.number("posh", "assumed_height_of_minus_20_C_m"), 6200);
    EXPECT_EQ(reader.text("posh", "units"), "%");
    EXPECT_EQ(reader.text(nullptr, "hail_error"), "heights 300 m off");
    EXPECT_EQ(reader.text(nullptr, "title"), "KTLX");
    EXPECT_EQ(reader.text(nullptr, "Conventions"), "CF-1.8");
    EXPECT_FALSE(reader.has_attribute(nullptr, "units"));
    EXPECT_THAT(reader.text("status", "flag_meanings"), HasSubstr(" value value_or_more"));
}

TEST(StillNetcdfFacts, QualityIsANumber) {
    StormFile file(Product::composite);
    file.facts.quality = "probability of weather at least 0.5; 41 % of the echo left out";
    netcdf::Reader reader(file.write());
    EXPECT_EQ(reader.number("composite", "least_probability_of_weather"), 0.5);
    EXPECT_DOUBLE_EQ(reader.number("composite", "share_of_echo_left_out"), 0.41);
    EXPECT_EQ(reader.text("composite", "standard_name"), "equivalent_reflectivity_factor");
    EXPECT_EQ(reader.text("status", "flag_meanings"), "not_seen no_echo range_folded value");
}

TEST(StillNetcdfFacts, AProductOverTimeHasTheBoundsOfItsSpan) {
    StormFile file(Product::rain_total);
    file.scene.moment = file.facts.moment = level2::Moment::rate;
    file.facts.since = file.facts.time - std::chrono::hours(3);
    netcdf::Reader reader(file.write());
    const auto bounds = reader.values("time_bnds", 2);
    EXPECT_EQ(bounds[1] - bounds[0], 3 * 3600);
    EXPECT_EQ(bounds[1], reader.values("time", 1)[0]);
    EXPECT_EQ(reader.text("time", "bounds"), "time_bnds");
    EXPECT_EQ(reader.text("rain_total", "cell_methods"), "time: sum");
    EXPECT_EQ(reader.text("rain_total", "units"), "mm");
    EXPECT_EQ(reader.text("rain_total", "standard_name"), "thickness_of_rainfall_amount");
}

TEST(StillNetcdfFacts, AVolumeIsRefused) {
    const StormFile file(Product::volume);
    const grid::BrickView view = file.bricks.view();
    const auto made = still_format_of("a.nc")->encode_map({view, file.facts, file.scene}, {});
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::bad_argument);
    EXPECT_THAT(made.error().message, HasSubstr("volume is no map"));
}

TEST(StillNetcdfFacts, UnitsOfLabelsDoNotChangeTheFile) {
    StormFile file(Product::echo_top);
    const auto read = [&] {
        std::ifstream in(file.write(), std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    const std::string usual = read();
    file.scene.units.height = Unit::feet;
    EXPECT_EQ(read(), usual);
}

}  // namespace
}  // namespace stormcellar::render
