// Merges grids and volumes of real radars by the C interface, and compares every cell with that of
// the C++ library.
#include "stormcellar/grid/mosaic.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "pipeline/mosaic/mosaic_effects.h"
#include "pipeline/plan/mosaic_of_volumes.h"
#include "stormcellar/level2/decode.h"
#include "tests/capi/opened.h"
#include "tests/testing/data.h"

namespace stormcellar::testing {
namespace {

const std::vector<const char*> files{"mosaic-northeast/KBGM20100911_012056_V03.gz",
                                     "mosaic-northeast/KENX20100911_011108_V03.gz",
                                     "mosaic-northeast/KOKX20100911_011047_V03.gz"};
const double levels[] = {1000, 2000, 4000};

// The domain of the tests: 480 x 400 km about a place between the radars.
stormcellar_grid_options domain_options() {
    stormcellar_grid_options options{};
    options.size = sizeof options;
    options.columns = 120;
    options.rows = 100;
    options.spacing_m = 4000;
    options.levels_m = levels;
    options.level_count = 3;
    options.has_center = 1;
    options.center_latitude_deg = 41.8;
    options.center_longitude_deg = -74.6;
    return options;
}

grid::GridSpec domain_spec() {
    grid::GridSpec spec = grid::default_spec(41.8, -74.6);
    spec.nx = 120;
    spec.ny = 100;
    spec.spacing_m = 4000;
    spec.levels_m = {1000, 2000, 4000};
    return spec;
}

struct Decoded {
    level2::Volume volume;
    grid::SitePosition site;
};
Decoded decoded(const char* name) {
    auto read = level2::decode_file(real_file(name));
    EXPECT_TRUE(read);
    const auto antenna = level2::antenna_position(read->volume);
    grid::SitePosition site{read->volume.station, antenna->latitude_deg, antenna->longitude_deg,
                            antenna->altitude_m};
    return {std::move(read->volume), std::move(site)};
}

void expect_same_cells(const stormcellar_grid* grid, const grid::Grid& expected) {
    const float* values = nullptr;
    const std::uint8_t* states = nullptr;
    ASSERT_EQ(stormcellar_grid_values(grid, &values, nullptr), STORMCELLAR_OK);
    ASSERT_EQ(stormcellar_grid_states(grid, &states, nullptr), STORMCELLAR_OK);
    const std::size_t count = expected.spec.cell_count();
    EXPECT_EQ(std::memcmp(values, expected.values.data(), count * sizeof(float)), 0);
    EXPECT_EQ(std::memcmp(states, expected.status.data(), count), 0);
    EXPECT_GT(std::count(states, states + count, STORMCELLAR_CELL_VALUE), 1000);
}

class CMosaic : public ::testing::Test {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        for (const char* file : files) {
            volumes_.push_back(opened(real_file(file)));
            pointers_.push_back(volumes_.back().get());
        }
        mosaic_options_.size = sizeof mosaic_options_;
    }
    // Grids each volume on the whole domain.
    void grid_each() {
        for (const stormcellar_volume* volume : pointers_) {
            stormcellar_grid* made = nullptr;
            ASSERT_EQ(stormcellar_grid_make(volume, &options_, &made, &error_), STORMCELLAR_OK)
                << error_.message;
            grids_.emplace_back(made);
            grid_pointers_.push_back(made);
        }
    }
    stormcellar_code merge() {
        stormcellar_grid* made = nullptr;
        const stormcellar_code code = stormcellar_grid_merge(
            grid_pointers_.data(), grid_pointers_.size(), &mosaic_options_, &made, &error_);
        merged_.reset(made);
        return code;
    }
    stormcellar_code make() {
        stormcellar_grid* made = nullptr;
        const stormcellar_code code = stormcellar_mosaic_make(
            pointers_.data(), pointers_.size(), &options_, &mosaic_options_, &made, &error_);
        merged_.reset(made);
        return code;
    }
    std::vector<OpenedVolume> volumes_;
    std::vector<const stormcellar_volume*> pointers_;
    std::vector<OwnedGrid> grids_;
    std::vector<const stormcellar_grid*> grid_pointers_;
    stormcellar_grid_options options_ = domain_options();
    stormcellar_mosaic_options mosaic_options_{};
    stormcellar_error error_{};
    OwnedGrid merged_;
};

TEST_F(CMosaic, MergedCellsAreThoseOfTheLibrary) {
    grid_each();
    ASSERT_EQ(merge(), STORMCELLAR_OK) << error_.message;

    const grid::GridSpec spec = domain_spec();
    std::vector<grid::BrickGrid> bricks;
    std::vector<grid::SitePosition> sites;
    for (const char* file : files) {
        const Decoded source = decoded(file);
        const auto made = grid::make_grid(source.volume, source.site,
                                          **grid::make_column_geometry(source.site, spec), {});
        ASSERT_TRUE(made);
        bricks.push_back(
            grid::BrickGrid::from(*made, grid::default_quantization(level2::Moment::ref)));
        sites.push_back(source.site);
    }
    std::vector<grid::Partial> partials;
    for (std::size_t i = 0; i < bricks.size(); ++i)
        partials.push_back({bricks[i].view(), sites[i]});
    const auto expected = grid::merge(spec, partials, {});
    ASSERT_TRUE(expected);
    expect_same_cells(merged_.get(), grid::to_dense(expected->view().cells));

    auto facts = empty_facts<stormcellar_grid_facts>();
    ASSERT_EQ(stormcellar_grid_describe(merged_.get(), &facts, nullptr), STORMCELLAR_OK);
    EXPECT_STREQ(facts.moment, "REF");
    EXPECT_EQ(facts.columns, 120);
    EXPECT_EQ(facts.time_ms, facts_of(volumes_[0]).start_ms) << "KBGM has the newest volume";
    EXPECT_LE(facts.start_ms, facts_of(volumes_[2]).start_ms) << "KOKX has the oldest volume";
}

TEST_F(CMosaic, TheOrderOfGridsDoesNotMatterButTheRuleDoes) {
    grid_each();
    ASSERT_EQ(merge(), STORMCELLAR_OK) << error_.message;
    const OwnedGrid first = std::move(merged_);
    std::ranges::reverse(grid_pointers_);
    ASSERT_EQ(merge(), STORMCELLAR_OK) << error_.message;
    const auto is_same = [&] {
        const float *values = nullptr, *others = nullptr;
        EXPECT_EQ(stormcellar_grid_values(first.get(), &values, nullptr), STORMCELLAR_OK);
        EXPECT_EQ(stormcellar_grid_values(merged_.get(), &others, nullptr), STORMCELLAR_OK);
        return std::memcmp(values, others, sizeof(float) * 120 * 100 * 3) == 0;
    };
    EXPECT_TRUE(is_same());
    mosaic_options_.overlap = "maximum";
    ASSERT_EQ(merge(), STORMCELLAR_OK) << error_.message;
    EXPECT_FALSE(is_same());
    mosaic_options_.overlap = nullptr;
    mosaic_options_.length_m = 20'000;
    ASSERT_EQ(merge(), STORMCELLAR_OK) << error_.message;
    EXPECT_FALSE(is_same());
}

TEST_F(CMosaic, AMosaicOfVolumesIsThatOfTheLibrary) {
    options_.interpolation = "eight-point";
    ASSERT_EQ(make(), STORMCELLAR_OK) << error_.message;

    std::vector<Decoded> sources;
    std::vector<pipeline::SceneVolume> scene;
    for (const char* file : files)
        sources.push_back(decoded(file));
    for (const Decoded& source : sources)
        scene.push_back({&source.volume, source.site, source.site.icao, false, {}});
    pipeline::MosaicRequest request;
    request.domain = domain_spec();
    request.chain = pipeline::mosaic_effects_of(level2::Moment::ref, grid::Averaging::in_db,
                                                grid::Overlap::distance_weighted);
    const accuracy::EffectOverride eight[] = {
        {"horizontal_interpolation", accuracy::Setting::on},
        {"beam_width", accuracy::Setting::off},
        {"cell_size", accuracy::Setting::off},
    };
    ASSERT_TRUE(accuracy::apply_overrides(request.chain, eight));
    const auto expected = pipeline::make_mosaic(scene, request);
    ASSERT_TRUE(expected);
    expect_same_cells(merged_.get(), expected->grid);
}

TEST_F(CMosaic, AMosaicReachesBeyondTheRadars) {
    options_.has_center = options_.columns = options_.rows = 0;
    options_.spacing_m = 20'000;
    ASSERT_EQ(make(), STORMCELLAR_OK) << error_.message;
    auto facts = empty_facts<stormcellar_grid_facts>();
    ASSERT_EQ(stormcellar_grid_describe(merged_.get(), &facts, nullptr), STORMCELLAR_OK);
    EXPECT_NEAR(facts.center_latitude_deg, (42.586 + 40.866) / 2, 0.01);
    EXPECT_EQ(facts.columns, 2 * 19) << "361 km to each side, 230 km beyond the radars";
    EXPECT_EQ(facts.rows, 2 * 17);
}

TEST_F(CMosaic, WhatMakesNoSenseIsRefused) {
    grid_each();
    mosaic_options_.overlap = "median";
    EXPECT_EQ(merge(), STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(make(), STORMCELLAR_BAD_ARGUMENT);
    mosaic_options_.overlap = nullptr;
    mosaic_options_.length_m = -1;
    EXPECT_EQ(merge(), STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(make(), STORMCELLAR_BAD_ARGUMENT);
    mosaic_options_.length_m = 0;
    grid_pointers_[2] = grid_pointers_[1];
    EXPECT_EQ(merge(), STORMCELLAR_BAD_ARGUMENT) << "the same radar twice";
    grid_pointers_[2] = nullptr;
    EXPECT_EQ(merge(), STORMCELLAR_BAD_ARGUMENT);
    stormcellar_grid* other = nullptr;
    options_.rows = 90;
    ASSERT_EQ(stormcellar_grid_make(pointers_[2], &options_, &other, nullptr), STORMCELLAR_OK);
    const OwnedGrid smaller(other);
    grid_pointers_[2] = smaller.get();
    EXPECT_EQ(merge(), STORMCELLAR_BAD_ARGUMENT) << "the two grids have different cells";
    EXPECT_EQ(merged_, nullptr);
    grid_pointers_.clear();
    EXPECT_EQ(merge(), STORMCELLAR_BAD_ARGUMENT);
    pointers_[1] = nullptr;
    EXPECT_EQ(make(), STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(stormcellar_grid_merge(nullptr, 1, nullptr, nullptr, nullptr),
              STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(stormcellar_mosaic_make(nullptr, 1, nullptr, nullptr, &other, nullptr),
              STORMCELLAR_BAD_ARGUMENT);
}

}  // namespace
}  // namespace stormcellar::testing
