// Opens GeoTIFF and KMZ files with GDAL's programs, which have their own code for projections, and
// checks that the programs find each cell at its place.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/products/column_summary.h"
#include "render/still/map_raster.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/render/still.h"
#include "tests/render/synthetic_storm.h"
#include "tests/testing/program.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::render {
namespace {

using ::testing::HasSubstr;

constexpr const char* gdal_info = "/usr/bin/gdalinfo";
constexpr const char* gdal_location = "/usr/bin/gdallocationinfo";
constexpr const char* gdal_translate = "/usr/bin/gdal_translate";

grid::GridSpec spec_of(grid::Projection projection) {
    grid::GridSpec spec = small_spec(300, 8, 1500, 1000);
    spec.ny = 260;
    spec = in_projection(spec, projection);
    if (spec.in_degrees()) spec.spacing_deg = 0.0125;  // pixels of the KMZ lie on cells
    return spec;
}

class StillGdal : public ::testing::TestWithParam<grid::ProjectionFacts> {
  protected:
    void SetUp() override {
        if (!std::filesystem::exists(gdal_info)) {
            GTEST_SKIP() << "GDAL's programs are not installed (scripts/install-packages test)";
        }
        scene_.product = Product::composite;
    }

    void write(const std::string& name, const StillOptions& options) {
        const auto bytes =
            still_format_of(name)->encode_map({bricks_.view(), facts_, scene_}, options);
        ASSERT_TRUE(bytes) << bytes.error().message;
        std::ofstream(file(name), std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes->data()),
                   static_cast<std::streamsize>(bytes->size()));
    }

    [[nodiscard]] std::string file(const std::string& name) const { return directory_ / name; }

    [[nodiscard]] nlohmann::json info(const std::string& name) const {
        const auto ran = testing::run_program(gdal_info, {"-json", "-stats", file(name)});
        EXPECT_EQ(ran.status, 0) << ran.err;
        EXPECT_EQ(ran.err, "") << "GDAL must not warn";
        return nlohmann::json::parse(ran.out);
    }

    // Returns the numbers that GDAL reads at each place, band by band.
    [[nodiscard]] std::vector<std::vector<double>> at(const std::string& name, int bands,
                                                      const std::vector<grid::GeoPoint>& places) {
        {
            std::ofstream points(file("points"));
            for (const grid::GeoPoint& place : places)
                points << fmt::format("{:.9f} {:.9f}\n", place.longitude_deg, place.latitude_deg);
        }
        const auto ran =
            testing::run_program("/bin/sh", {"-c", R"("$0" -valonly -wgs84 "$1" < "$2")",
                                             gdal_location, file(name), file("points")});
        EXPECT_EQ(ran.status, 0) << ran.err;
        std::istringstream lines(ran.out);
        std::vector<std::vector<double>> found;
        for (std::string line; std::getline(lines, line);) {
            if (found.empty() || std::ssize(found.back()) == bands) found.emplace_back();
            found.back().push_back(line.empty() ? -1e9 : std::stod(line));
        }
        EXPECT_EQ(found.size(), places.size());
        found.resize(places.size());
        return found;
    }

    [[nodiscard]] std::vector<grid::GeoPoint> places_of(
        const std::vector<grid::ColumnPoint>& columns, double off) const {
        const grid::GridProjection projection(spec_);
        std::vector<grid::GeoPoint> places;
        for (const grid::ColumnPoint column : columns)
            places.push_back(projection.to_geo({column.x + off, column.y - off}));
        return places;
    }

    [[nodiscard]] static std::size_t place_in(const FlatField& field, grid::ColumnPoint column) {
        return field.index(static_cast<int>(column.x), static_cast<int>(column.y));
    }

    testing::TemporaryDirectory directory_;
    grid::GridSpec spec_ = spec_of(GetParam().projection);
    grid::Grid grid_ = storm_grid(spec_);
    grid::BrickGrid bricks_ = bricks_of(grid_);
    FrameFacts facts_ = facts_of(grid_);
    Scene scene_;
};

std::vector<grid::ColumnPoint> some_columns(const grid::GridSpec& spec) {
    std::mt19937 random(7);
    std::vector<grid::ColumnPoint> columns = {
        {0, 0}, {0, spec.ny - 1.0}, {spec.nx - 1.0, 0}, {spec.nx - 1.0, spec.ny - 1.0}};
    for (int i = 0; i < 24; ++i) {
        columns.push_back({static_cast<double>(random() % static_cast<unsigned>(spec.nx)),
                           static_cast<double>(random() % static_cast<unsigned>(spec.ny))});
    }
    return columns;
}

// Reads places 0.4 cells off the middle of a cell, so that a raster shifted by half a cell fails.
TEST_P(StillGdal, EachValueOfAGeotiffIsWhereItsCellIs) {
    write("a.tif", {});
    const auto field = still_field({bricks_.view(), facts_, scene_}, 1);
    const auto columns = some_columns(spec_);
    int valued = 0;
    for (const double off : {-0.4, 0.4}) {
        const auto found = at("a.tif", 1, places_of(columns, off));
        for (std::size_t i = 0; i < columns.size(); ++i) {
            const std::size_t place = place_in(*field, columns[i]);
            if (field->status[place] == grid::CellStatus::value) {
                ++valued;
                ASSERT_NEAR(found[i][0], static_cast<double>(field->values[place]), 1e-6);
            } else {
                ASSERT_TRUE(std::isnan(found[i][0])) << found[i][0];
            }
        }
    }
    EXPECT_GT(valued, 8);
}

TEST_P(StillGdal, AGeotiffIsCloudOptimizedAndSaysWhatItIs) {
    StillOptions options;
    options.metadata = {{"Title", "KTLX & <more>"}, {"Domain", "KTLX"}};
    write("a.tif", options);
    const auto json = info("a.tif");
    EXPECT_EQ(json["size"], (std::vector<int>{spec_.nx, spec_.ny}));
    const auto& band = json["bands"][0];
    EXPECT_EQ(band["type"], "Float32");
    EXPECT_EQ(band["block"], (std::vector<int>{256, 256}));
    EXPECT_EQ(band["noDataValue"], "NaN");
    EXPECT_EQ(band["unit"], "dBZ");
    EXPECT_EQ(band["description"], product_title(scene_));
    EXPECT_EQ(band["overviews"].size(), 1U);
    EXPECT_EQ(band["overviews"][0]["size"], (std::vector<int>{150, 130}));
    const auto& structure = json["metadata"]["IMAGE_STRUCTURE"];
    EXPECT_EQ(structure["LAYOUT"], "COG");
    EXPECT_EQ(structure["COMPRESSION"], "DEFLATE");
    EXPECT_EQ(json["metadata"][""]["AREA_OR_POINT"], "Area");
    EXPECT_EQ(json["metadata"][""]["Title"], "KTLX & <more>");
    EXPECT_EQ(json["metadata"][""]["TIFFTAG_DATETIME"], "1999:05:03 23:56:21");
    const std::string wkt = json["coordinateSystem"]["wkt"];
    EXPECT_THAT(wkt, HasSubstr("WGS 84"));
    double least = 1e9;
    double most = -1e9;
    const auto field = still_field({bricks_.view(), facts_, scene_}, 1);
    for (std::size_t i = 0; i < field->values.size(); ++i) {
        if (field->status[i] != grid::CellStatus::value) continue;
        least = std::min(least, static_cast<double>(field->values[i]));
        most = std::max(most, static_cast<double>(field->values[i]));
    }
    EXPECT_NEAR(band["minimum"], least, 1e-3);
    EXPECT_NEAR(band["maximum"], most, 1e-3);
}

// Makes a copy of half the size, for which GDAL reads an overview.
TEST_P(StillGdal, OverviewsHoldValuesOfCells) {
    write("a.tif", {});
    const auto ran =
        testing::run_program(gdal_translate, {"-q", "-of", "ENVI", "-outsize", "150", "130", "-r",
                                              "nearest", file("a.tif"), file("a.raw")});
    ASSERT_EQ(ran.status, 0) << ran.err;
    std::ifstream raw(file("a.raw"), std::ios::binary);
    std::vector<float> cells(150 * 130);
    raw.read(reinterpret_cast<char*>(cells.data()), static_cast<std::streamsize>(cells.size() * 4));
    ASSERT_TRUE(raw);
    const auto field = still_field({bricks_.view(), facts_, scene_}, 1);
    for (int y = 0; y < 130; ++y) {
        for (int x = 0; x < 150; ++x) {
            const float found = cells[static_cast<std::size_t>(y * 150 + x)];
            const std::size_t place = field->index(2 * x, spec_.ny - 1 - 2 * y);
            if (field->status[place] == grid::CellStatus::value) {
                ASSERT_EQ(found, field->values[place]);
            } else {
                ASSERT_TRUE(std::isnan(found));
            }
        }
    }
}

TEST_P(StillGdal, StatesAndColorsAreOtherContentsOfAGeotiff) {
    const auto field = still_field({bricks_.view(), facts_, scene_}, 1);
    StillOptions options;
    options.tiff = TiffContent::states;
    write("states.tif", options);
    options.tiff = TiffContent::colors;
    write("colors.tif", options);
    EXPECT_EQ(info("states.tif")["bands"][0]["colorInterpretation"], "Palette");
    EXPECT_EQ(info("states.tif")["metadata"][""]["STATES"],
              "0 not seen, 1 no echo, 2 range folded, 3 value, 4 value or more");
    const auto colors = info("colors.tif");
    ASSERT_EQ(colors["bands"].size(), 4U);
    EXPECT_EQ(colors["bands"][3]["colorInterpretation"], "Alpha");
    const auto columns = some_columns(spec_);
    const auto states = at("states.tif", 1, places_of(columns, 0));
    const auto drawn = at("colors.tif", 4, places_of(columns, 0));
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const std::size_t place = place_in(*field, columns[i]);
        EXPECT_EQ(states[i][0], static_cast<double>(field->status[place]));
        const Rgba8 color = overlay_color(*field, place, colors_of(scene_));
        EXPECT_EQ(drawn[i], std::vector<double>(color.begin(), color.end()));
    }
}

// In the western half of the grid, every cell of the level that is drawn is ambiguous.
TEST_P(StillGdal, AmbiguousCellsAreAStateAndHalfTransparent) {
    for (int ix = 0; ix < spec_.nx / 2; ++ix) {
        for (int iy = 0; iy < spec_.ny; ++iy)
            grid_.status[spec_.index(ix, iy, 2)] = grid::CellStatus::ambiguous;
    }
    facts_.moment = scene_.moment = level2::Moment::veld;
    scene_.product = Product::cappi;
    scene_.cappi_height_m = spec_.levels_m[2];
    bricks_ = bricks_of(grid_, 2, true);
    StillOptions options;
    write("values.tif", options);
    options.tiff = TiffContent::states;
    write("states.tif", options);
    options.tiff = TiffContent::colors;
    write("colors.tif", options);
    write("a.kmz", {});
    const auto json = info("states.tif");
    EXPECT_THAT(json["metadata"][""]["STATES"].get<std::string>(), HasSubstr(", 5 ambiguous"));
    EXPECT_EQ(json["bands"][0]["colorTable"]["entries"][5], (std::vector<int>{187, 128, 190, 255}));
    const auto columns = some_columns(spec_);
    const auto places = places_of(columns, 0);
    const auto values = at("values.tif", 1, places), states = at("states.tif", 1, places);
    const auto colors = at("colors.tif", 4, places), kmz = at("a.kmz", 4, places);
    const Rgba8 folded = colors_of(scene_).range_folded;
    const std::vector<double> half = {double{1} * folded[0], double{1} * folded[1],
                                      double{1} * folded[2], std::floor(folded[3] / 2.0)};
    int ambiguous = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const bool is_ambiguous = columns[i].x < spec_.nx / 2;
        EXPECT_EQ(states[i][0] == 5, is_ambiguous);
        EXPECT_EQ(colors[i] == half, is_ambiguous);
        EXPECT_EQ(kmz[i] == half, is_ambiguous);
        if (!is_ambiguous) continue;
        EXPECT_TRUE(std::isnan(values[i][0]));
        ++ambiguous;
    }
    EXPECT_GT(ambiguous, 8);
}

TEST_P(StillGdal, AKmzLiesWhereItsCellsAre) {
    write("a.kmz", {});
    const auto field = still_field({bricks_.view(), facts_, scene_}, 1);
    const auto columns = some_columns(spec_);
    const auto found = at("a.kmz", 4, places_of(columns, 0));
    int visible = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const Rgba8 color = overlay_color(*field, place_in(*field, columns[i]), colors_of(scene_));
        ASSERT_EQ(found[i], std::vector<double>(color.begin(), color.end()))
            << columns[i].x << ' ' << columns[i].y;
        visible += color[3] == 255 ? 1 : 0;
    }
    EXPECT_GT(visible, 4);
}

INSTANTIATE_TEST_SUITE_P(Projections, StillGdal, ::testing::ValuesIn(grid::projection_facts),
                         [](const auto& tested) { return std::string(tested.param.name); });

// A map of the synthetic storm, with its grid.
struct StormMap {
    grid::Grid grid;
    grid::BrickGrid bricks = bricks_of(grid);
    FrameFacts facts = facts_of(grid);
    Scene scene{};

    explicit StormMap(const grid::GridSpec& spec) : grid(storm_grid(spec)) {
        scene.product = Product::composite;
    }
    [[nodiscard]] Result<std::vector<std::byte>> encoded(const char* name, int threads = 1) const {
        StillOptions options;
        options.threads = threads;
        return still_format_of(name)->encode_map({bricks.view(), facts, scene}, options);
    }
};

TEST(StillMaps, ProductsThatAreNoMapsAreRefused) {
    StormMap map(small_spec(16, 4));
    map.scene.product = Product::volume;
    for (const char* name : {"a.tif", "a.nc", "a.kmz"}) {
        const auto made = map.encoded(name);
        ASSERT_FALSE(made);
        EXPECT_EQ(made.error().code, ErrorCode::bad_argument);
        EXPECT_THAT(made.error().message, HasSubstr("volume is no map"));
    }
}

TEST(StillMaps, AGridThatHoldsAPoleIsNoKmz) {
    grid::GridSpec spec = small_spec(64, 4, 5000);
    spec.center_latitude_deg = 89.5;
    const StormMap map(spec);
    const auto made = map.encoded("a.kmz");
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::unsupported);
    EXPECT_TRUE(map.encoded("a.tif"));
}

TEST(StillMaps, TheSameMapGivesTheSameBytesForAnyNumberOfThreads) {
    const StormMap map(small_spec(300, 4));
    for (const char* name : {"a.tif", "a.nc", "a.kmz"}) {
        const auto first = map.encoded(name);
        ASSERT_TRUE(first);
        EXPECT_GT(first->size(), 1000U);
        EXPECT_TRUE(*first == map.encoded(name, 3).value()) << name;
    }
}

}  // namespace
}  // namespace stormcellar::render
