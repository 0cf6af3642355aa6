// Tests that the hail of a frame of the cache is the largest hail of its radars.
#include "pipeline/mosaic/hail_of_frame.h"

#include <algorithm>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/pipeline/hailed_frame.h"

namespace stormcellar::pipeline {
namespace {

std::vector<float> shi_of(const grid::BrickView& view) {
    const grid::Grid cells = grid::to_dense(view);
    const auto layers = retrieve::hail_layers(cells.spec.levels_m, {}, 0).value();
    std::vector<float> all, dbz(cells.spec.levels_m.size());
    for (int iy = 0; iy < cells.spec.ny; ++iy)
        for (int ix = 0; ix < cells.spec.nx; ++ix) {
            for (int iz = 0; iz < cells.spec.nz(); ++iz) {
                const std::size_t cell = cells.spec.index(ix, iy, iz);
                dbz[static_cast<std::size_t>(iz)] = cells.status[cell] == grid::CellStatus::value
                                                        ? cells.values[cell]
                                                        : std::numeric_limits<float>::quiet_NaN();
            }
            all.push_back(retrieve::hail_of_column(layers, dbz).shi_j_per_m_s);
        }
    return all;
}

// 2026-11-30: products of hail merged the reflectivity of a cache's mosaic before they were made.
TEST(HailOfFrame, IsTheLargestHailOfItsRadars) {
    const HailedFrame frame;
    const MosaicFrame merged = frame.made_of({"KBGM", "KENX"});
    ASSERT_TRUE(is_of_several(merged.description));
    const auto made = hail_of_frame(frame.store, {.domain = "north", .levels = {}},
                                    merged.description, merged.mosaic.cells.view());
    ASSERT_TRUE(made) << made.error().message;
    const auto hail = shi_of(made->bricks.view());
    const auto one = shi_of(frame.made_of({"KBGM"}).mosaic.cells.view());
    const auto other = shi_of(frame.made_of({"KENX"}).mosaic.cells.view());
    const auto mean = shi_of(merged.mosaic.cells.view());
    int from_one = 0, from_other = 0, less = 0;
    for (std::size_t i = 0; i < hail.size(); ++i) {
        const float largest = std::max(one[i], other[i]);
        ASSERT_EQ(hail[i], largest > 0 ? largest : mean[i]) << i;
        from_one += one[i] > other[i] && other[i] > 0 ? 1 : 0;
        from_other += other[i] > one[i] && one[i] > 0 ? 1 : 0;
        less += mean[i] < hail[i] ? 1 : 0;
    }
    EXPECT_GT(from_one, 50);
    EXPECT_GT(from_other, 50);
    EXPECT_GT(less, 100) << "the mean of reflectivity has less hail";
    EXPECT_THAT(made->description.provenance.notes, ::testing::Contains(merged_hail_note));
    EXPECT_EQ(made->description.spec, merged.description.spec);
}

TEST(HailOfFrame, NeedsThePartialsOfTheFrame) {
    const HailedFrame frame;
    const MosaicFrame merged = frame.made_of({"KBGM", "KENX"});
    const auto code = [&](const HailRequest& request, const cache::GridDescription& of) {
        const auto made = hail_of_frame(frame.store, request, of, merged.mosaic.cells.view());
        return made ? ErrorCode::internal : made.error().code;
    };
    EXPECT_EQ(code({.domain = "north", .levels = {}, .most_cells = 10}, merged.description),
              ErrorCode::over_budget);
    EXPECT_EQ(code({.domain = "north", .levels = {5000, 2000}}, merged.description),
              ErrorCode::bad_argument);
    cache::GridDescription unlisted = merged.description;
    unlisted.provenance.parts.clear();
    EXPECT_EQ(code({.domain = "north", .levels = {}}, unlisted), ErrorCode::not_found);
    // A partial that was made again is not the one that the frame has.
    cache::GridDescription other = merged.description;
    other.provenance.parts.back().fingerprint += 1;
    EXPECT_EQ(code({.domain = "north", .levels = {}}, other), ErrorCode::not_found);
    frame.forget_one();
    EXPECT_EQ(code({.domain = "north", .levels = {}}, merged.description), ErrorCode::not_found);
}

}  // namespace
}  // namespace stormcellar::pipeline
