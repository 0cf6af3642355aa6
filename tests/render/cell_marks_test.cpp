// Tests where the marks of storm cells are, that their labels do not collide, and that they are
// legible on any echo.
#include "render/map/cell_marks.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/frame/overlay_text.h"
#include "render/image/shades.h"
#include "render/map/labels.h"
#include "render/map/map_marks.h"
#include "stormcellar/render/render.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr UtcTime start{std::chrono::sys_days{std::chrono::year{1999} / 5 / 3}};
constexpr double speed_mps = 15;  // to the east

// Returns the place at a distance from the middle of the map.
grid::GeoPoint place_at(double east_m, double north_m) {
    return grid::SiteFrame(35, -97).to_geo(grid::SiteFrame::from_plane(east_m, north_m));
}

retrieve::TrackedCell still_cell(double east_m, double north_m, float max_dbz) {
    retrieve::TrackedCell cell;
    cell.cell.position = place_at(east_m, north_m);
    cell.cell.max_dbz = max_dbz;
    cell.cell.max_dbz_height_m = 5000;
    cell.time = start;
    return cell;
}

// A cell that was seen five minutes before and moves to the east.
retrieve::TrackedCell moving_cell(double east_m, double north_m, float max_dbz) {
    retrieve::TrackedCell cell = still_cell(east_m, north_m, max_dbz);
    const std::chrono::minutes before{5};
    cell.past = {{start - before, place_at(east_m - speed_mps * 300, north_m)}};
    cell.motion = retrieve::TrackMotion{{speed_mps, 0}, 1};
    for (const int minutes : retrieve::forecast_minutes) {
        cell.forecasts.push_back({minutes, start + std::chrono::minutes(minutes),
                                  place_at(east_m + speed_mps * 60 * minutes, north_m),
                                  100.0 * minutes});
    }
    return cell;
}

// A map of 300 x 300 km, a kilometer a pixel, or another view of it.
struct MarkedMap {
    grid::GridSpec spec = small_spec(300, 20);
    std::vector<grid::SitePosition> sites;
    CellOverlay overlay;
    ViewGeometry view;
    Fonts fonts = Fonts::load().value();

    explicit MarkedMap(std::vector<retrieve::TrackedCell> cells, const Camera& camera = {180, 0},
                       int side = 300)
        : view(spec, camera, 1, side, side) {
        overlay.scan = {start, "KTLX", std::move(cells), {}};
        overlay.volumes = 2;
    }
    [[nodiscard]] MapLines lines(std::chrono::minutes later = {}) const {
        MapLines lines;
        lines.geometry = &view;
        lines.spec = &spec;
        lines.sites = &sites;
        lines.cells = &overlay;
        lines.time = start + later;
        return lines;
    }
    [[nodiscard]] std::vector<CellMark> marks(std::chrono::minutes later = {},
                                              bool heights = false) const {
        LabelPlaces places(
            {0, 0, static_cast<double>(view.width()), static_cast<double>(view.height())});
        MapLines drawn = lines(later);
        drawn.heights = heights;
        return plan_cell_marks(&fonts, drawn, places);
    }
    // Returns the pixel of a place of the plane, in closed form. The map is azimuthal equidistant.
    [[nodiscard]] Point pixel_of(double east_m, double north_m) const {
        const double scale = view.metres_per_pixel();
        return {view.width() / 2 + east_m / scale, view.height() / 2 - north_m / scale};
    }
};

void expect_at(Point p, Point wanted) {
    EXPECT_NEAR(p.x, wanted.x, 0.1);
    EXPECT_NEAR(p.y, wanted.y, 0.1);
}

TEST(CellMarks, AreAtTheirPlaces) {
    const MarkedMap map({moving_cell(-40e3, 30e3, 55)});
    const auto marks = map.marks();
    ASSERT_EQ(marks.size(), 1U);
    expect_at(marks[0].center, map.pixel_of(-40e3, 30e3));
    ASSERT_EQ(marks[0].track.size(), 2U);
    expect_at(marks[0].track[1], map.pixel_of(-44.5e3, 30e3));
    ASSERT_EQ(marks[0].ahead.size(), 5U);
    ASSERT_EQ(marks[0].ticks.size(), 4U);
    for (std::size_t i = 1; i < 5; ++i) {
        const Point at = map.pixel_of(-40e3 + 13.5e3 * static_cast<double>(i), 30e3);
        expect_at(marks[0].ahead[i], at);
        const auto& tick = marks[0].ticks[i - 1];
        expect_at({(tick[0].x + tick[1].x) / 2, (tick[0].y + tick[1].y) / 2}, at);
    }
    ASSERT_EQ(marks[0].errors.size(), 2U) << "after 30 and 60 minutes";
    for (const Point& p : marks[0].errors[1]) {
        const Point middle = map.pixel_of(14e3, 30e3);
        EXPECT_NEAR(std::hypot(p.x - middle.x, p.y - middle.y), 6000 / map.view.metres_per_pixel(),
                    0.1);
    }
    EXPECT_FALSE(marks[0].top) << "a map shows no heights";
}

TEST(CellMarks, HaveNoForecastWithoutMotion) {
    const auto marks = MarkedMap({still_cell(0, 0, 50)}).marks();
    ASSERT_EQ(marks.size(), 1U);
    EXPECT_EQ(marks[0].ahead.size(), 1U);
    EXPECT_EQ(marks[0].track.size(), 1U);
    EXPECT_TRUE(marks[0].ticks.empty() && marks[0].errors.empty());
    EXPECT_TRUE(MarkedMap({}).marks().empty());
}

TEST(CellMarks, MoveOnToTheTimeOfTheirPicture) {
    const MarkedMap map({moving_cell(0, 0, 55), still_cell(0, 60e3, 50)});
    const auto marks = map.marks(std::chrono::minutes{20});
    expect_at(marks[0].center, map.pixel_of(speed_mps * 1200, 0));
    EXPECT_EQ(marks[0].ticks.size(), 3U) << "the forecast for 15 minutes is past";
    EXPECT_EQ(marks[0].track.size(), 3U);
    expect_at(marks[1].center, map.pixel_of(0, 60e3));
    EXPECT_EQ(map.marks(std::chrono::minutes{60})[0].ticks.size(), 0U);
    expect_at(map.marks(std::chrono::minutes{-5})[0].center, map.pixel_of(0, 0));
}

TEST(CellMarks, LabelsHaveReflectivityAndHail) {
    auto hail = still_cell(-60e3, 0, 62.7F);
    hail.cell.mesh_mm = 41.6F;
    auto graupel = still_cell(60e3, 0, 48);
    graupel.cell.mesh_mm = 3.0F;
    const auto marks = MarkedMap({hail, graupel}).marks();
    EXPECT_EQ(marks[0].label->text, "63 dBZ, 42 mm");
    EXPECT_EQ(marks[1].label->text, "48 dBZ");
}

bool overlap(const Rect& a, const Rect& b) {
    return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
}

// A field of cells every 14 km has room for rings, but not for all labels.
TEST(CellMarks, LabelsDoNotCollide) {
    std::vector<retrieve::TrackedCell> cells;
    for (int i = 0; i < 100; ++i)
        cells.push_back(moving_cell(-70e3 + 14e3 * (i % 10), -70e3 + 14e3 * (i / 10),
                                    70 - 0.2F * static_cast<float>(i)));
    const MarkedMap map(cells);
    const auto marks = map.marks();
    ASSERT_EQ(marks.size(), 100U);
    EXPECT_TRUE(marks[0].label) << "the strongest cell comes first";
    std::vector<Rect> boxes;
    for (const CellMark& mark : marks) {
        boxes.push_back({mark.center.x - 5, mark.center.y - 5, 10, 10});
        if (!mark.label) continue;
        boxes.push_back(mark.label->box);
        EXPECT_GE(mark.label->box.x, 0);
        EXPECT_LE(mark.label->box.right(), map.view.width());
    }
    EXPECT_GT(boxes.size(), 120U) << "some labels have room";
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_FALSE(overlap(boxes[i], boxes[j])) << i << ", " << j;
    }
}

TEST(CellMarks, KeepNamesOfCitiesAway) {
    const MarkedMap map({still_cell(0, 0, 60)});
    MapLines lines = map.lines();
    MapLayer layer;
    layer.cities = {{{150, 150}, "Under the ring", 500'000}, {{40, 40}, "Far away", 500'000}};
    lines.map = &layer;
    const MapMarks marks = plan_marks(map.fonts, lines);
    ASSERT_EQ(marks.cells.size(), 1U);
    ASSERT_EQ(marks.cities.size(), 1U);
    EXPECT_EQ(marks.ground_texts.front().text, "Far away");
}

TEST(CellMarks, StandOnAStemInAVolume) {
    const Camera aslant{180, 60};
    const auto marks = MarkedMap({still_cell(0, 0, 55)}, aslant).marks({}, true);
    ASSERT_TRUE(marks[0].top);
    EXPECT_NEAR(marks[0].top->x, marks[0].center.x, 1e-6);
    EXPECT_LT(marks[0].top->y, marks[0].center.y) << "up";
}

// A camera among the cells sees only some cells, and no line has a point behind it.
TEST(CellMarks, EndWhereTheCameraDoesNotSeeThem) {
    Camera inside;
    inside.eye = Eye{0, 0, 3000};
    inside.look_at = Eye{50e3, 0, 3000};
    inside.field_of_view_deg = 60;
    const MarkedMap map({moving_cell(-30e3, 0, 60), moving_cell(30e3, 0, 55)}, inside);
    const auto marks = map.marks({}, true);
    ASSERT_EQ(marks.size(), 1U) << "one cell is behind the camera";
    for (const auto* line : {&marks[0].track, &marks[0].ahead}) {
        for (const Point& p : *line)
            EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y));
    }
}

// Counts pixels of a color near the ring of the cell in the middle.
int count_near_middle(const Image& image, Rgba8 color) {
    int count = 0;
    for (int y = 140; y < 160; ++y) {
        for (int x = 140; x < 160; ++x) {
            const Rgba8 at = image.at(x, y);
            int difference = 0;
            for (std::size_t i = 0; i < 3; ++i)
                difference = std::max(difference, std::abs(at[i] - color[i]));
            count += difference < 40 ? 1 : 0;
        }
    }
    return count;
}

// Each ring has a line in the color of text and a halo in the opposite color, so one of the two
// contrasts with any echo.
TEST(CellMarks, AreLegibleOnDarkAndLightEcho) {
    const MarkedMap map({moving_cell(0, 0, 60)});
    for (const Shades* const page : {&shades::dark, &shades::light}) {
        for (const Rgba8 echo : {Rgba8{0, 0, 0, 255}, Rgba8{255, 255, 255, 255}}) {
            MapLines lines = map.lines();
            lines.shades = page;
            Canvas canvas(300, 300, echo);
            draw_cell_marks(canvas, map.marks(), lines);
            const Image image = canvas.image();
            EXPECT_GT(count_near_middle(image, page->text), 15);
            EXPECT_GT(count_near_middle(image, page->halo), 15);
        }
    }
}

// The forecast at zoom 1000 is a line of 100,000 pixels.
TEST(CellMarks, DrawLongLinesInShortTime) {
    Camera near{180, 0};
    near.zoom = 1000;
    const MarkedMap map({moving_cell(0, 0, 60)}, near);
    Canvas canvas(300, 300, {0, 0, 0, 255});
    draw_cell_marks(canvas, map.marks(), map.lines());
    EXPECT_GT(count_near_middle(canvas.image(), shades::dark.text), 15);
}

TEST(CellMarks, LegendAndMetadataSayHowTheCellsWereFound) {
    CellOverlay overlay;
    overlay.scan.time = start;
    overlay.scan.cells = {still_cell(0, 0, 50)};
    EXPECT_THAT(cell_notes(overlay), ElementsAre("1 storm cell,", "peaks from 41 dBZ;",
                                                 "1 volume: no motion,", "no forecast"));
    EXPECT_THAT(cells_sentence(overlay), HasSubstr("without motion and forecast"));
    overlay.volumes = 5;
    overlay.scan.freezing = retrieve::FreezingLevels{3900, 7000};
    EXPECT_THAT(cell_notes(overlay),
                ElementsAre("1 storm cell,", "peaks from 41 dBZ", "over 5 volumes;",
                            "ticks: 15 to 60 min,", "circles: error"));
    EXPECT_THAT(cells_sentence(overlay), HasSubstr("followed through 5 volumes"));
    EXPECT_THAT(cells_sentence(overlay), HasSubstr("0 C at 3900 m, -20 C at 7000 m"));
}

// A wide picture has the sentence below its legend; a square picture has the sentence beside its
// product.
TEST(CellMarks, EachShapeOfPictureSaysHowTheCellsWereFound) {
    const FrameFacts facts{"KTLX", level2::Moment::ref, start, {}};
    const Fonts fonts = Fonts::load().value();
    for (const int height : {500, 800, 1400}) {
        Scene scene;
        scene.width = 800;
        scene.height = height;
        DrawnFacts texts{legend_of(scene), 50e3, std::nullopt};
        texts.marks = {"1 storm cell,", "peaks from 41 dBZ"};
        const auto layout = lay_out_labels(fonts, scene, facts, texts);
        ASSERT_TRUE(layout);
        const bool says_it = std::ranges::any_of(layout->texts, [](const LabelText& text) {
            return text.text.find("peaks from 41 dBZ") != std::string::npos;
        });
        EXPECT_TRUE(says_it) << height;
    }
}

// A picture without labels has the marks, but no letters.
TEST(CellMarks, AreDrawnWithoutLabels) {
    const MarkedMap map({still_cell(0, 0, 60)});
    const grid::BrickGrid bricks =
        bricks_of(make_grid_of(map.spec, [](int, int, int) { return Cell{}; }));
    Scene scene;
    scene.product = Product::composite;
    scene.width = scene.height = 300;
    scene.labels = false;
    const FrameFacts facts{"KTLX", level2::Moment::ref, start, {}};
    const Image without = render_frame(bricks.view(), facts, scene, 1).value();
    const Image with =
        render_frame(bricks.view(), facts, scene, 1, nullptr, {.cells = &map.overlay}).value();
    EXPECT_GT(count_near_middle(with, shades::dark.text), 15);
    EXPECT_EQ(count_near_middle(without, shades::dark.text), 0);
    for (int y = 0; y < 300; ++y) {
        for (int x = 0; x < 300; ++x) {
            if (std::hypot(x - 150, y - 150) < 12) continue;
            EXPECT_EQ(with.at(x, y), without.at(x, y)) << x << ", " << y;
        }
    }
}

}  // namespace
}  // namespace stormcellar::render
