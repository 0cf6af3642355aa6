#include "render/map/beam_glyphs.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/degree.h"
#include "render/frame/picture_layout.h"
#include "render/image/shades.h"
#include "render/map/map_ground.h"
#include "stormcellar/render/render.h"
#include "tests/grid/volume_maker.h"

namespace stormcellar::render {
namespace {

using level2::Moment;

constexpr std::uint16_t ambiguous = 2;

// Codes of the made volumes have scale 2 and offset 66, whatever the moment.
std::uint16_t velocity_code(double mps) {
    return grid::ref_code(mps);
}

// A sweep with known gates, and the map of 600 x 600 km on which it is drawn.
struct SweptMap {
    grid::SitePosition site{"KTLX", 35, -97, 400};
    std::vector<grid::SitePosition> sites{site};
    grid::GridSpec spec;
    std::unique_ptr<grid::SweepLookup> sweep;

    explicit SweptMap(std::function<std::uint16_t(int, int)> code, Moment moment = Moment::veld,
                      double latitude_deg = 35, double longitude_deg = -97) {
        spec = grid::default_spec(latitude_deg, longitude_deg);
        spec.levels_m = {site.altitude_m};
        grid::SweepPlan plan;
        plan.moment = moment;
        plan.code = std::move(code);
        auto volume = std::make_shared<const level2::Volume>(grid::make_volume({plan}));
        sweep = std::make_unique<grid::SweepLookup>(
            grid::SweepLookup::find(volume, site, moment, 0.475, {}).value());
    }
    [[nodiscard]] Scene scene(bool has_glyphs, int side = 400) const {
        Scene scene;
        scene.product = Product::ppi;
        scene.moment = sweep->moment();
        scene.width = scene.height = side;
        scene.labels = false;
        scene.glyphs = has_glyphs;
        return scene;
    }
    [[nodiscard]] ViewGeometry geometry() const {
        return picture_geometry(spec, scene(true), 400, 400);
    }
    [[nodiscard]] std::vector<BeamGlyph> glyphs(const ViewGeometry& view,
                                                const MapMarks& marks = {}) const {
        MapLines lines;
        lines.geometry = &view;
        lines.spec = &spec;
        lines.sites = &sites;
        return plan_beam_glyphs(*sweep, lines, marks);
    }
    [[nodiscard]] grid::PolarPoint place_of(const ViewGeometry& view, Point pixel) const {
        const auto ground = view.ground({pixel.x, pixel.y}).value();
        return grid::SiteFrame(site.latitude_deg, site.longitude_deg)
            .to_polar(GroundMap(spec).place(ground));
    }
    [[nodiscard]] Point pixel_of(const ViewGeometry& view, grid::PolarPoint place) const {
        const GroundPoint ground = GroundMap(spec).ground(
            grid::SiteFrame(site.latitude_deg, site.longitude_deg).to_geo(place));
        const Pixel pixel = view.project(ground.x_m, ground.y_m, view.ground_m());
        return {pixel.x, pixel.y};
    }
    [[nodiscard]] Image draw(const Scene& scene) const {
        grid::BrickView view;
        view.spec = &spec;
        view.sweep = sweep.get();
        return render_frame(view, {"KTLX", scene.moment, sweep->facts().start, sites}, scene, 2)
            .value();
    }
};

double length_of(const BeamGlyph& glyph) {
    return std::hypot(glyph.tip.x - glyph.gate.x, glyph.tip.y - glyph.gate.y);
}

// As in a uniform flow, the wind blows away from the radar on one side and toward the radar on the
// other side. The wind has only one speed on each side. The maps are about the radar and about a
// place 150 km off.
TEST(BeamGlyphs, PointAlongTheBeamToWhereTheAirGoes) {
    for (const auto& [latitude_deg, longitude_deg] : {std::pair{35.0, -97.0}, {34.0, -98.0}}) {
        const SweptMap map([](int radial, int) { return velocity_code(radial < 180 ? 20 : -10); },
                           Moment::veld, latitude_deg, longitude_deg);
        const ViewGeometry view = map.geometry();
        int away = 0, toward = 0;
        for (const BeamGlyph& glyph : map.glyphs(view)) {
            const grid::PolarPoint place = map.place_of(view, glyph.gate);
            ASSERT_EQ(glyph.speed_mps, place.azimuth_deg < 180 ? 20 : -10);
            EXPECT_NEAR(length_of(glyph), glyph_length(std::abs(glyph.speed_mps), 1), 1e-9);
            // Air that moves away goes to the place that is ten kilometers farther along the beam.
            const Point beyond = map.pixel_of(view, {place.azimuth_deg, place.arc_m + 10e3});
            const double wanted = std::atan2(beyond.y - glyph.gate.y, beyond.x - glyph.gate.x);
            const double drawn = std::atan2(glyph.tip.y - glyph.gate.y, glyph.tip.x - glyph.gate.x);
            const double turned = drawn - wanted + (glyph.speed_mps < 0 ? 180 * degree : 0);
            EXPECT_LT(std::abs(std::remainder(turned, 360 * degree)), 0.5 * degree);
            (glyph.speed_mps > 0 ? away : toward) += 1;
        }
        EXPECT_GT(away, 40);
        EXPECT_GT(toward, 40);
    }
    EXPECT_NEAR(glyph_length(40, 1), 2 * glyph_length(20, 1), 1e-12);
    EXPECT_NEAR(glyph_length(20, 3), 3 * glyph_length(20, 1), 1e-12);
}

// Each kind of gate without a velocity covers a sector. The sectors have no glyphs, and no pixel of
// the sectors differs from the picture without glyphs, except where a line reaches in from outside.
TEST(BeamGlyphs, AreOnlyWhereTheVelocityIsKnown) {
    const auto is_unknown = [](double azimuth_deg) { return azimuth_deg < 180; };
    const SweptMap map([&](int radial, int) {
        if (!is_unknown(radial)) return velocity_code(5);
        return radial < 60 ? ambiguous : radial < 120 ? grid::range_folded : grid::below_threshold;
    });
    const ViewGeometry view = map.geometry();
    const auto glyphs = map.glyphs(view);
    EXPECT_GT(glyphs.size(), 60U);
    for (const BeamGlyph& glyph : glyphs)
        EXPECT_FALSE(is_unknown(map.place_of(view, glyph.gate).azimuth_deg));
    const Image with = map.draw(map.scene(true));
    const Image without = map.draw(map.scene(false));
    int changed = 0;
    for (int y = 0; y < 400; ++y) {
        for (int x = 0; x < 400; ++x) {
            if (with.at(x, y) == without.at(x, y)) continue;
            ++changed;
            const Point at = {x + 0.5, y + 0.5};
            EXPECT_TRUE(std::ranges::any_of(glyphs,
                                            [&](const BeamGlyph& glyph) {
                                                return std::hypot(glyph.gate.x - at.x,
                                                                  glyph.gate.y - at.y) < 12;
                                            }))
                << x << "," << y;
        }
    }
    EXPECT_GT(changed, 2000);
    const SweptMap nothing([](int, int) { return ambiguous; });
    EXPECT_TRUE(nothing.glyphs(view).empty());
    EXPECT_EQ(nothing.draw(nothing.scene(true)).rgba, nothing.draw(nothing.scene(false)).rgba);
}

// At each glyph, the line and the head have the color of text, the disc lies on both sides of the
// line, and behind the disc nothing is drawn.
TEST(BeamGlyphs, TheLineStartsAtTheDiscAndEndsInAHead) {
    const SweptMap map([](int, int) { return velocity_code(24); });
    const ViewGeometry view = map.geometry();
    const Image with = map.draw(map.scene(true));
    const Image without = map.draw(map.scene(false));
    const Rgba8 text = shades_of(Theme::dark).text;
    const auto is_changed = [&](Point p) {
        const int x = static_cast<int>(p.x);
        const int y = static_cast<int>(p.y);
        return with.at(x, y) != without.at(x, y);
    };
    const auto is_text = [&](Point p) {
        const Rgba8 color = with.at(static_cast<int>(p.x), static_cast<int>(p.y));
        return std::abs(color[1] - text[1]) < 40;
    };
    const auto glyphs = map.glyphs(view);
    ASSERT_GT(glyphs.size(), 100U);
    for (const BeamGlyph& glyph : glyphs) {
        const auto at = [&](double along, double across) {
            return Point{glyph.gate.x + along * glyph.along.x - across * glyph.along.y,
                         glyph.gate.y + along * glyph.along.y + across * glyph.along.x};
        };
        EXPECT_TRUE(is_text(at(length_of(glyph) - 3, 0)));
        EXPECT_TRUE(is_changed(at(length_of(glyph) / 2, 0)));
        EXPECT_TRUE(is_changed(at(0, 4)) && is_changed(at(0, -4)));
    }
}

TEST(BeamGlyphs, ACalmHasADotAndNoHead) {
    const SweptMap map([](int, int) { return velocity_code(0.5); });
    const ViewGeometry view = map.geometry();
    const auto glyphs = map.glyphs(view);
    ASSERT_GT(glyphs.size(), 100U);
    for (const BeamGlyph& glyph : glyphs)
        EXPECT_EQ(length_of(glyph), 0);
    EXPECT_NE(map.draw(map.scene(true)).rgba, map.draw(map.scene(false)).rgba);
}

// Even winds of 90 m/s leave room between the glyphs, and no glyph is under a mark of the map.
TEST(BeamGlyphs, DoNotOverlap) {
    for (const double mps : {3.0, 25.0, 90.0}) {
        const SweptMap map([&](int, int) { return velocity_code(mps); });
        const ViewGeometry view = map.geometry();
        MapMarks marks;
        marks.north = {20, 300, 60, 80};
        const auto glyphs = map.glyphs(view, marks);
        EXPECT_GT(glyphs.size(), 20U) << mps;
        for (std::size_t i = 0; i < glyphs.size(); ++i) {
            for (const Point& p : {glyphs[i].gate, glyphs[i].tip}) {
                EXPECT_FALSE(p.x > 20 && p.x < 80 && p.y > 300 && p.y < 380);
                EXPECT_TRUE(p.x > 0 && p.y > 0 && p.x < 400 && p.y < 400);
            }
            for (std::size_t j = 0; j < i; ++j) {
                EXPECT_GT(std::hypot(glyphs[i].gate.x - glyphs[j].gate.x,
                                     glyphs[i].gate.y - glyphs[j].gate.y),
                          7);
                EXPECT_GT(std::hypot(glyphs[i].tip.x - glyphs[j].gate.x,
                                     glyphs[i].tip.y - glyphs[j].gate.y),
                          7);
            }
        }
    }
}

TEST(BeamGlyphs, TheKeySaysALengthAndWhatIsNotObserved) {
    const GlyphKey key = glyph_key({});
    EXPECT_EQ(key.speed_mps, 20);
    EXPECT_EQ(key.along, "20 m/s along the beam");
    EXPECT_THAT(key.across, ::testing::HasSubstr("not observed"));
    EXPECT_EQ(glyph_key(units_from_names("knots").value()).along, "40 kt along the beam");
    EXPECT_EQ(glyph_key(units_from_names("km/h").value()).along, "70 km/h along the beam");
    EXPECT_NEAR(glyph_key(units_from_names("knots").value()).speed_mps, 20.58, 0.01);
}

// The smallest labeled picture has the key, in a corner of its map and within its frame.
TEST(BeamGlyphs, SmallAndLargePicturesHaveTheKey) {
    const SweptMap map([](int, int) { return velocity_code(20); });
    const auto fonts = Fonts::load().value();
    for (const auto& [width, height] : {std::pair{400, 300}, {796, 532}, {1600, 1200}}) {
        Scene scene = map.scene(true);
        scene.width = width;
        scene.height = height;
        scene.labels = true;
        grid::BrickView view;
        view.spec = &map.spec;
        view.sweep = map.sweep.get();
        const FrameFacts facts{"KTLX", scene.moment, map.sweep->facts().start, map.sites};
        const LabelLayout layout = layout_of(view, facts, scene).value();
        const ViewGeometry geometry =
            picture_geometry(map.spec, scene, layout.width, layout.height);
        MapLines lines;
        lines.geometry = &geometry;
        lines.spec = &map.spec;
        lines.sites = &map.sites;
        lines.scale = layout.scale;
        lines.glyph_key = size_of_glyph_key(fonts, {}, layout.scale);
        const MapMarks marks = plan_marks(fonts, lines);
        ASSERT_TRUE(marks.glyph_key) << width;
        const Rect& box = *marks.glyph_key;
        EXPECT_TRUE(box.x >= 0 && box.y >= 0 && box.right() <= layout.width &&
                    box.bottom() <= layout.height);
        ASSERT_EQ(marks.sites.size(), 1U) << "the key hides no site";
        for (const BeamGlyph& glyph : plan_beam_glyphs(*map.sweep, lines, marks)) {
            for (const Point& p : {glyph.gate, glyph.tip})
                EXPECT_FALSE(p.x > box.x && p.x < box.right() && p.y > box.y && p.y < box.bottom());
        }
        const Image with = map.draw(scene);
        scene.glyphs = false;
        EXPECT_NE(with.rgba, map.draw(scene).rgba);
    }
}

TEST(BeamGlyphs, ShowVelocitiesOnly) {
    Scene scene;
    scene.product = Product::ppi;
    scene.glyphs = true;
    EXPECT_EQ(validate(scene).error().message, "beam glyphs show velocities, not REF");
    for (const Moment moment : {Moment::vel, Moment::veld, Moment::srv}) {
        scene.moment = moment;
        EXPECT_TRUE(validate(scene));
    }
    scene.moment = Moment::sw;
    EXPECT_FALSE(validate(scene));
}

}  // namespace
}  // namespace stormcellar::render
