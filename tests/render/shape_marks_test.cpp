// Tests where shapes of files are drawn, and when.
#include "render/map/shape_marks.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "render/frame/overlay_text.h"
#include "render/image/shades.h"
#include "render/map/map_ground.h"
#include "stormcellar/render/render.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

constexpr UtcTime shown_at{std::chrono::sys_days{std::chrono::year{1999} / 5 / 3}};

grid::GeoPoint plane_place(double east_m, double north_m) {
    return grid::SiteFrame(35, -97).to_geo(grid::SiteFrame::from_plane(east_m, north_m));
}

// A map of 300 x 300 km.
struct ShapedMap {
    grid::GridSpec spec = small_spec(300, 20);
    std::vector<grid::SitePosition> sites;
    ShapeOverlay overlay;
    ViewGeometry view;
    Fonts fonts = Fonts::load().value();

    explicit ShapedMap(std::vector<OverlayShape> shapes, const Camera& camera = {180, 0},
                       int side = 300)
        : view(spec, camera, 1, side, side) {
        overlay.shapes = std::move(shapes);
    }
    [[nodiscard]] std::vector<ShapeMark> marks(LabelPlaces places = LabelPlaces({0, 0, 300, 300}),
                                               bool has_labels = true) const {
        MapLines lines;
        lines.geometry = &view;
        lines.spec = &spec;
        lines.sites = &sites;
        lines.shapes = &overlay;
        lines.time = shown_at;
        return plan_shape_marks(has_labels ? &fonts : nullptr, lines, places);
    }
    [[nodiscard]] Point pixel_of(grid::GeoPoint place) const {
        const GroundPoint at = GroundMap(spec).ground(place);
        const Pixel p = view.project(at.x_m, at.y_m, view.ground_m());
        return {p.x, p.y};
    }
};

double apart(Point a, Point b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}

TEST(ShapeMarks, VerticesAreAtTheirPlaces) {
    const std::vector<grid::GeoPoint> corners = {plane_place(-40e3, 30e3), plane_place(50e3, 20e3),
                                                 plane_place(0, -60e3)};
    const ShapedMap map({{.points = corners}, {.points = {corners[0]}}});
    const double scale = map.view.metres_per_pixel();
    const auto in_closed_form = [scale](double east_m, double north_m) {
        return Point{150 + east_m / scale, 150 - north_m / scale};
    };
    const auto marks = map.marks();
    ASSERT_EQ(marks.size(), 2U);
    ASSERT_EQ(marks[0].lines.size(), 1U);
    const auto& line = marks[0].lines[0];
    EXPECT_LT(apart(line.front(), in_closed_form(-40e3, 30e3)), 0.1);
    EXPECT_LT(apart(line.back(), in_closed_form(0, -60e3)), 0.1);
    ASSERT_TRUE(marks[1].dot);
    EXPECT_LT(apart(*marks[1].dot, in_closed_form(-40e3, 30e3)), 0.1);
    EXPECT_EQ(marks[1].color, shades::dark.text) << "no color is given";
}

// An edge is straight in latitude and longitude, so between its ends it curves on the map.
TEST(ShapeMarks, EdgesFollowLatitudeAndLongitude) {
    const grid::GeoPoint west{34, -98.5}, east{36, -95.5};
    const ShapedMap map({{.points = {west, east}}}, {180, 0}, 800);
    const auto marks = map.marks();
    ASSERT_EQ(marks.size(), 1U);
    const auto& line = marks[0].lines.at(0);
    double farthest = 0;
    for (int i = 0; i <= 100; ++i) {
        const double share = i / 100.0;
        const Point p = map.pixel_of({34 + 2 * share, -98.5 + 3 * share});
        double nearest = 1e9;
        for (std::size_t k = 1; k < line.size(); ++k) {
            const Point a = line[k - 1], b = line[k];
            const double length = apart(a, b);
            const double along = std::clamp(
                ((p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)) / length, 0.0, length);
            nearest = std::min(nearest, apart(p, {a.x + along * (b.x - a.x) / length,
                                                  a.y + along * (b.y - a.y) / length}));
        }
        farthest = std::max(farthest, nearest);
    }
    EXPECT_LT(farthest, 0.2);
}

TEST(ShapeMarks, AreDrawnOnlyInForce) {
    const std::vector<grid::GeoPoint> place = {plane_place(0, 0)};
    const std::chrono::minutes minute{1};
    const ShapedMap map({{.points = place, .until = shown_at},
                         {.points = place, .from = shown_at + minute},
                         {.points = place, .from = shown_at - minute, .until = shown_at + minute}});
    EXPECT_EQ(map.marks().size(), 1U);
    EXPECT_EQ(shapes_shown(map.overlay, shown_at), "1 of 3 in force");
    ShapedMap other({});
    other.overlay.unknown = 2;
    EXPECT_EQ(shapes_shown(other.overlay, shown_at), "0 of 0 in force, 2 unknown");
}

TEST(ShapeMarks, ALabelTakesAFreePlaceOrIsLeftOut) {
    const ShapedMap map({{.points = {plane_place(0, 0)}, .label = "first"},
                         {.points = {plane_place(0, 0)}, .label = "second"},
                         {.points = {plane_place(400e3, 0)}, .label = "beyond"}});
    const auto marks = map.marks();
    ASSERT_EQ(marks.size(), 2U) << "the third is outside the picture";
    ASSERT_TRUE(marks[0].label && marks[1].label);
    const Rect &a = marks[0].label->box, &b = marks[1].label->box;
    EXPECT_TRUE(a.right() <= b.x || b.right() <= a.x || a.bottom() <= b.y || b.bottom() <= a.y);
    LabelPlaces full({0, 0, 300, 300});
    full.take({0, 0, 300, 300});
    EXPECT_FALSE(map.marks(full).at(0).label);
    EXPECT_FALSE(map.marks(LabelPlaces({}), false).at(0).label);
}

// 2026-11-30: an edge across the date line would otherwise go once around the earth.
TEST(ShapeMarks, AnEdgeAcrossTheDateLineGoesTheShortWay) {
    ShapedMap map({{.points = {{52, 179.5}, {52, -179.5}}}});
    map.spec.center_latitude_deg = 52;
    map.spec.center_longitude_deg = 180;
    const auto marks = map.marks();
    ASSERT_EQ(marks.size(), 1U);
    ASSERT_EQ(marks[0].lines.size(), 1U);
    EXPECT_EQ(marks[0].lines[0].size(), 5U) << "four parts of 0.25 degrees";
}

// 2026-11-30: a zigzag of 200 kB across the earth took a minute and 2 GB.
TEST(ShapeMarks, EdgesFarAwayAreLeftOutAndTooManyEdgesStayWhole) {
    OverlayShape zigzag, near;
    for (int i = 0; i < 40'000; ++i) {
        zigzag.points.push_back({0, i % 2 == 0 ? 0.0 : 179.0});
        near.points.push_back({i % 2 == 0 ? 30.0 : 40.0, -97});
    }
    const auto points_of = [](const OverlayShape& shape) {
        const ShapedMap map({shape});
        std::size_t points = 0;
        for (const ShapeMark& mark : map.marks())
            for (const auto& line : mark.lines)
                points += line.size();
        return points;
    };
    EXPECT_EQ(points_of(zigzag), 0U);
    EXPECT_GE(points_of(near), 40'000U);
    EXPECT_LE(points_of(near), 250'000U);
}

// A camera on the ground sees only a part of a line that leads past it.
TEST(ShapeMarks, ALineEndsWhereTheCameraDoesNotSeeIt) {
    Camera camera{180, 80};
    camera.field_of_view_deg = 60;
    const ShapedMap map({{.points = {plane_place(0, 140e3), plane_place(0, -3000e3)}}}, camera);
    for (const ShapeMark& mark : map.marks())
        for (const auto& line : mark.lines)
            for (const Point& p : line)
                EXPECT_TRUE(std::abs(p.x) < 1e5 && std::abs(p.y) < 1e5);
}

}  // namespace
}  // namespace stormcellar::render
