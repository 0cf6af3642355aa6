// Tests 2D products of a real volume against its gates.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/products/flat_field.h"
#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/decode.h"
#include "tests/render/real_volume.h"
#include "tests/testing/data.h"

namespace stormcellar::render {
namespace {

using grid::CellStatus;
using level2::Moment;

class RealProducts : public ::testing::Test {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        real_ = real_volume("volumes/KTLX19990503_235621.gz");
        spec_ = grid::default_spec(real_.site.latitude_deg, real_.site.longitude_deg);
        bricks_ = grid::BrickGrid::from(real_.on(spec_), grid::default_quantization(Moment::ref));
    }

    RealVolume real_;
    grid::GridSpec spec_;
    std::optional<grid::BrickGrid> bricks_;
};

// Takes gates of echo that are at the height of a level and near the center of a column. The beam
// formula places them, not the gridder. A CAPPI at their height must show them.
TEST_F(RealProducts, ACappiShowsTheGatesAtItsHeight) {
    const grid::BeamGeometry beam(real_.site.latitude_deg, real_.site.altitude_m);
    std::vector<std::optional<FlatField>> cappis(spec_.levels_m.size());
    double squares = 0;
    int compared = 0;
    int valued = 0;
    for (const level2::Sweep& sweep : real_.volume->sweeps) {
        const level2::SweepMoment* moment = sweep.find(Moment::ref);
        if (moment == nullptr) continue;
        for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
            const auto gates = static_cast<std::int32_t>(moment->gate_counts[radial]);
            for (std::int32_t gate = 60; gate < std::min(gates, 150); ++gate) {
                if (moment->status(radial, gate) != level2::GateStatus::valid) continue;
                const float dbz = moment->value_of(moment->code(radial, gate));
                if (dbz < 20) continue;
                const double azimuth =
                    static_cast<double>(sweep.radials[radial].azimuth_deg) * M_PI / 180;
                const auto at =
                    beam.forward({moment->range_m(gate),
                                  static_cast<double>(sweep.radials[radial].elevation_deg)});
                const double x = at.arc_m * std::sin(azimuth) / 1000 + spec_.center_x();
                const double y = at.arc_m * std::cos(azimuth) / 1000 + spec_.center_y();
                const double level = at.height_m / 500 - 1;
                const auto near = [](double v, double slack) {
                    return std::abs(v - std::round(v)) < slack;
                };
                if (!near(x, 0.15) || !near(y, 0.15) || !near(level, 0.05)) continue;
                const auto iz = static_cast<std::size_t>(std::lround(level));
                if (iz >= cappis.size()) continue;
                if (!cappis[iz]) {
                    cappis[iz] =
                        cappi_field(bricks_->view(), Moment::ref, spec_.levels_m[iz], 2).value();
                }
                const std::size_t place = cappis[iz]->index(static_cast<int>(std::lround(x)),
                                                            static_cast<int>(std::lround(y)));
                ++compared;
                if (cappis[iz]->status[place] != CellStatus::value) continue;
                ++valued;
                squares += std::pow(static_cast<double>(cappis[iz]->values[place] - dbz), 2);
            }
        }
    }
    RecordProperty("gates", compared);
    RecordProperty("rms_db", std::to_string(std::sqrt(squares / valued)));
    EXPECT_GT(compared, 100);
    EXPECT_GT(valued, 0.97 * compared);
    EXPECT_LT(std::sqrt(squares / valued), 0.5);
}

// No column maximum exceeds the largest value that another decoder found in the volume. The
// greatest maximum may be lower, because the grid samples points 1 km apart.
TEST_F(RealProducts, TheCompositesMaximumIsThatOfTheGolden) {
    std::ifstream file(*testing::data_directory() / "golden/KTLX19990503_235621.gz.json");
    ASSERT_TRUE(file);
    const auto golden = nlohmann::json::parse(file);
    double most = -100;
    for (const auto& sweep : golden["sweeps"]) {
        if (sweep["moments"].contains("REF")) {
            most = std::max(most, sweep["moments"]["REF"]["max"].get<double>());
        }
    }
    const auto view = bricks_->view();
    const FlatField field = composite_field(view, summarize_columns(view, 2));
    const auto found =
        static_cast<double>(*std::max_element(field.values.begin(), field.values.end()));
    EXPECT_LE(found, most + 0.25);
    EXPECT_GT(found, most - 6);
}

// The tornadic supercells of that evening have tops between 13 km and the top of the grid, and the
// most liquid where a column is strong and deep.
TEST_F(RealProducts, EchoTopsAndVilAreThoseOfSevereStorms) {
    const auto view = bricks_->view();
    const FlatField tops = echo_top_field(view, 18.5, 2);
    const auto highest =
        static_cast<double>(*std::max_element(tops.values.begin(), tops.values.end()));
    EXPECT_GT(highest, 13);
    EXPECT_LT(highest, 16.1);
    const FlatField vil = vil_field(view, {}, 2);
    const auto most = std::max_element(vil.values.begin(), vil.values.end());
    const auto column = static_cast<std::size_t>(most - vil.values.begin());
    RecordProperty("vil", std::to_string(*most));
    EXPECT_GT(*most, 25);
    EXPECT_GT(composite_field(view, summarize_columns(view, 2)).values[column], 50);
    EXPECT_GT(tops.values[column], 10);
}

}  // namespace
}  // namespace stormcellar::render
