#include "render/products/sweep_field.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/frame/probe.h"
#include "render/frame/sweep_text.h"
#include "render/image/shades.h"
#include "render/products/ground.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/render/panels.h"
#include "stormcellar/render/render.h"
#include "tests/grid/volume_maker.h"
#include "tests/render/real_volume.h"
#include "tests/testing/data.h"

namespace stormcellar::render {
namespace {

using grid::CellStatus;
using level2::Moment;

class SweepField : public ::testing::Test {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        real_ = real_volume("volumes/KLBB20160601_150025_V06");
        auto sweep = grid::SweepLookup::find(real_.volume, real_.site, Moment::ref,
                                             grid::beam_width_of(real_.site.icao) / 2, {});
        ASSERT_TRUE(sweep);
        sweep_ = std::make_unique<grid::SweepLookup>(std::move(*sweep));
    }

    [[nodiscard]] grid::GridSpec plane(double latitude_deg, double longitude_deg) const {
        grid::GridSpec spec = grid::default_spec(latitude_deg, longitude_deg);
        spec.levels_m = {real_.site.altitude_m};
        return spec;
    }
    [[nodiscard]] Scene scene() const {
        Scene scene;
        scene.product = Product::ppi;
        scene.width = 300;
        scene.height = 200;
        scene.labels = false;
        return scene;
    }
    // Returns azimuth and arc from the radar to the middle of a pixel, by geodesics.
    [[nodiscard]] grid::PolarPoint exact(const grid::GridSpec& spec, const ViewGeometry& geometry,
                                         int x, int y) const {
        const auto p = geometry.ground({x + 0.5, y + 0.5}).value();
        const auto geo =
            grid::GridProjection(spec).to_geo({p.x_m / spec.cell_width_m() + 0.5 * (spec.nx - 1),
                                               p.y_m / spec.cell_height_m() + 0.5 * (spec.ny - 1)});
        return grid::SiteFrame(real_.site.latitude_deg, real_.site.longitude_deg).to_polar(geo);
    }
    // Returns true if the gate at the place, or at a place 0.5 m beside it, has this state and
    // value.
    [[nodiscard]] bool is_there(grid::PolarPoint place, CellStatus status, float value) const {
        const grid::PlanePoint at = grid::SiteFrame::to_plane(place);
        for (const double east : {0.0, -0.5, 0.5}) {
            for (const double north : {0.0, -0.5, 0.5}) {
                const auto gate =
                    sweep_->at(grid::SiteFrame::from_plane(at.x_m + east, at.y_m + north));
                const bool same_value = status != CellStatus::value || gate.value == value;
                if (gate.status == status && same_value) return true;
            }
        }
        return false;
    }

    RealVolume real_;
    std::unique_ptr<grid::SweepLookup> sweep_;
};

TEST_F(SweepField, EachPixelShowsItsGate) {
    // The planes are about the radar and about other places, up to 300 km off, in three
    // projections.
    std::vector<grid::GridSpec> planes = {plane(real_.site.latitude_deg, real_.site.longitude_deg),
                                          plane(35, -99), plane(31.5, -103.5), plane(34, -101),
                                          plane(34, -101)};
    planes[3].projection = grid::Projection::lambert_conformal;
    planes[3].parallels_deg = {33, 45};
    planes[4].projection = grid::Projection::latitude_longitude;
    planes[4].spacing_m = 0;
    planes[4].spacing_deg = 0.01;
    for (const grid::GridSpec& spec : planes) {
        ASSERT_TRUE(grid::validate(spec));
        const ViewGeometry geometry = picture_geometry(spec, scene(), 300, 200);
        const FlatField field = sweep_in_picture(*sweep_, spec, geometry, 2);
        int valued = 0;
        for (int y = 0; y < 200; ++y) {
            for (int x = 0; x < 300; ++x) {
                const std::size_t at = field.index(x, y);
                const auto p = geometry.ground({x + 0.5, y + 0.5}).value();
                if (column_at(spec, p) < 0) {
                    ASSERT_EQ(field.status[at], CellStatus::not_seen);
                    continue;
                }
                ASSERT_TRUE(
                    is_there(exact(spec, geometry, x, y), field.status[at], field.values[at]))
                    << spec.center_latitude_deg << " " << x << "," << y;
                valued += field.status[at] == CellStatus::value ? 1 : 0;
            }
        }
        EXPECT_GT(valued, 300);
        EXPECT_EQ(field.values, sweep_in_picture(*sweep_, spec, geometry, 1).values);
    }
}

TEST_F(SweepField, ColumnsShowTheGateAtTheirCenter) {
    const grid::GridSpec spec = plane(33, -101);
    const FlatField field = sweep_in_columns(*sweep_, spec, 2);
    const grid::SiteFrame frame(real_.site.latitude_deg, real_.site.longitude_deg);
    for (int iy = 3; iy < spec.ny; iy += 17) {
        for (int ix = 3; ix < spec.nx; ix += 17) {
            const std::size_t at = field.index(ix, iy);
            ASSERT_TRUE(is_there(frame.to_polar(grid::column_position(spec, ix, iy)),
                                 field.status[at], field.values[at]));
        }
    }
}

// The picture has the color of the gate that exact() finds, or the shade of its state.
TEST_F(SweepField, ThePictureHasTheColorsOfTheGates) {
    const grid::GridSpec spec = plane(real_.site.latitude_deg, real_.site.longitude_deg);
    grid::BrickView view;
    view.spec = &spec;
    view.sweep = sweep_.get();
    FrameFacts facts{real_.site.icao, Moment::ref, sweep_->facts().start, {real_.site}};
    const auto picture = render_frame(view, facts, scene(), 2);
    ASSERT_TRUE(picture);
    const ViewGeometry geometry = picture_geometry(spec, scene(), 300, 200);
    int valued = 0;
    int colored = 0;
    for (int y = 2; y < 198; ++y) {
        for (int x = 2; x < 298; ++x) {
            if (column_at(spec, geometry.ground({x + 0.5, y + 0.5}).value()) < 0) continue;
            const auto gate = sweep_->at(exact(spec, geometry, x, y));
            const auto color = gate.status == CellStatus::value
                                   ? color_of(colors_of(scene()), gate.value)
                                   : std::nullopt;
            if (!color) continue;
            const auto probe = probe_pixel(view, facts, scene(), x, y, 1);
            ASSERT_TRUE(probe);
            ASSERT_EQ(probe->value, gate.value);
            ASSERT_TRUE(probe->gate);
            ASSERT_TRUE(probe->height_m);
            ++valued;
            if (picture->at(x, y) == *color) ++colored;
        }
    }
    EXPECT_GT(valued, 1000);
    EXPECT_GT(colored, 0.97 * valued) << "the line around the ground covers some pixels";
}

// The footer says how much of the circle was seen, and whether the view shows the whole range.
TEST_F(SweepField, TheFooterTellsTheSweepAndTheView) {
    const auto text_of = [&](const grid::GridSpec& spec, double zoom) {
        Scene zoomed = scene();
        zoomed.camera.zoom = zoom;
        return sweep_text(*sweep_, spec, picture_geometry(spec, zoomed, 300, 200));
    };
    grid::GridSpec whole = plane(real_.site.latitude_deg, real_.site.longitude_deg);
    whole.nx = whole.ny = 920;
    EXPECT_EQ(text_of(whole, 1), "Cut 1: 720 radials, gates of 0.25 km up to 460 km");
    EXPECT_THAT(text_of(whole, 2), ::testing::EndsWith("view cut: the sweep reaches 460 km"));
    EXPECT_THAT(text_of(plane(real_.site.latitude_deg, real_.site.longitude_deg), 1),
                ::testing::EndsWith("view cut: the sweep reaches 460 km"));
    EXPECT_THAT(text_of(plane(35, -99), 1), ::testing::HasSubstr("view cut"));

    auto volume = std::make_shared<level2::Volume>(*real_.volume);
    for (level2::SweepMoment& kind : volume->sweeps[0].moments)
        std::fill(kind.gate_counts.begin() + 240, kind.gate_counts.end(), 0);
    grid::SweepWish first;
    first.number = 0;
    const auto begun = grid::SweepLookup::find(volume, real_.site, Moment::ref, 0.475, first);
    ASSERT_TRUE(begun);
    EXPECT_EQ(sweep_text(*begun, whole, picture_geometry(whole, scene(), 300, 200)),
              "Cut 1: 240 radials, 33 % of the circle, gates of 0.25 km up to 460 km");
}

// Panels state the angle of the sweep that they show, as single pictures do, and not the angle that
// the scene asked for.
TEST_F(SweepField, PanelsSayTheAngleOfTheirSweep) {
    const grid::GridSpec spec = plane(real_.site.latitude_deg, real_.site.longitude_deg);
    grid::BrickView view;
    view.spec = &spec;
    view.sweep = sweep_.get();
    const FrameFacts facts{real_.site.icao, Moment::ref, sweep_->facts().start, {real_.site}};
    Scene asked = scene();
    asked.width = 800;
    asked.height = 600;
    asked.labels = true;
    asked.colors = colors_of(asked);  // a table of the scene's own
    const Panel lowest{view, facts, asked};
    const Panel by_angle{view, facts, scene_shown(view, asked)};
    const auto pair = render_panels(std::vector<Panel>{lowest, lowest}, 2);
    ASSERT_TRUE(pair) << pair.error().message;
    const auto shown = render_panels(std::vector<Panel>{by_angle, by_angle}, 2);
    ASSERT_TRUE(shown);
    EXPECT_TRUE(pair->rgba == shown->rgba);
}

TEST_F(SweepField, ASweepIsNoGridAndAGridIsNoSweep) {
    const grid::GridSpec spec = plane(real_.site.latitude_deg, real_.site.longitude_deg);
    grid::BrickView view;
    view.spec = &spec;
    FrameFacts facts{real_.site.icao, Moment::ref, {}, {real_.site}};
    EXPECT_EQ(check_frame(view, facts, scene()).error().code, ErrorCode::bad_argument);
    view.sweep = sweep_.get();
    EXPECT_TRUE(check_frame(view, facts, scene()));
    Scene composite = scene();
    composite.product = Product::composite;
    EXPECT_EQ(check_frame(view, facts, composite).error().code, ErrorCode::bad_argument);
    EXPECT_EQ(product_title(scene_shown(view, scene())),
              "Reflectivity at 0.5 degrees elevation (PPI)");
}

// Draws a sweep twice, with no echo in place of ambiguous gates. The pictures may differ only at
// the ambiguous gates, and there by thin lines in the color of range folding.
TEST(AmbiguousGates, AreHatchedInThePictureOfTheirSweep) {
    const grid::SitePosition site{"KTLX", 35, -97, 400};
    Scene scene;
    scene.product = Product::ppi;
    scene.moment = Moment::veld;
    scene.width = scene.height = 300;
    scene.labels = false;
    grid::GridSpec spec = grid::default_spec(site.latitude_deg, site.longitude_deg);
    spec.levels_m = {site.altitude_m};
    const auto draw = [&](std::uint16_t code, FlatField& field) {
        grid::SweepPlan plan;
        plan.moment = Moment::veld;
        plan.code = [code](int radial, int gate) {
            const bool is_patch = radial >= 30 && radial < 120 && gate >= 50 && gate < 150;
            return is_patch ? code : gate % 4 == 0 ? grid::range_folded : grid::ref_code(20);
        };
        auto volume = std::make_shared<const level2::Volume>(grid::make_volume({plan}));
        auto sweep = grid::SweepLookup::find(volume, site, Moment::veld, 0.475, {});
        grid::BrickView view;
        view.spec = &spec;
        view.sweep = &*sweep;
        const FrameFacts facts{"KTLX", Moment::veld, sweep->facts().start, {site}};
        field = sweep_in_picture(*sweep, spec, picture_geometry(spec, scene, 300, 300), 1);
        return render_frame(view, facts, scene, 2).value();
    };
    FlatField field(0, 0), quiet_field(0, 0);
    const Image image = draw(2, field);  // code 2 is ambiguous
    const Image plain_ground = draw(0, quiet_field);
    const Rgba8 folded = colors_of(scene).range_folded;
    int hatched_pixels = 0;
    for (int y = 0; y < 300; ++y) {
        for (int x = 0; x < 300; ++x) {
            const std::size_t at = field.index(x, y);
            const Rgba8 ground = plain_ground.at(x, y);
            if (field.status[at] != CellStatus::ambiguous) {
                ASSERT_EQ(image.at(x, y), ground) << x << "," << y;
                continue;
            }
            ASSERT_EQ(quiet_field.status[at], CellStatus::no_echo);
            ASSERT_EQ(image.at(x, y), hatched(ground, folded, x, y, 1)) << x << "," << y;
            hatched_pixels += image.at(x, y) == folded ? 1 : 0;
        }
    }
    EXPECT_GT(hatched_pixels, 300);
    EXPECT_GT(std::ranges::count(field.status, CellStatus::ambiguous), 3000);
}

}  // namespace
}  // namespace stormcellar::render
