#include "render/map/map_marks.h"

#include <algorithm>
#include <cmath>

#include <GeographicLib/Geodesic.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/image/shades.h"
#include "render/map/draw_marks.h"
#include "render/map/map_ground.h"
#include "render/view/length_text.h"
#include "stormcellar/base/station_table.h"
#include "tests/render/small_map.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

using grid::Projection;

grid::GridSpec spec_of(Projection projection, double latitude_deg, double longitude_deg, int nx,
                       int ny, double spacing_m) {
    grid::GridSpec spec =
        projected_spec(projection, latitude_deg, longitude_deg, nx, ny, spacing_m);
    spec.levels_m = {1000, 15000};
    return spec;
}

// A plan of marks and its input.
struct Planned {
    grid::GridSpec spec;
    ViewGeometry view;
    std::vector<grid::SitePosition> sites;
    MapLayer layer;
    MapLines lines;
    MapMarks marks;

    Planned(const grid::GridSpec& grid, const Camera& camera, int width, int height, double scale,
            std::vector<grid::SitePosition> all_sites)
        : spec(grid),
          view(spec, camera, camera.tilt_deg > 0 ? 5 : 1, width, height),
          sites(std::move(all_sites)),
          layer(prepare_map(BaseMap::built_in().value(), spec, view, scale).value()) {
        lines.geometry = &view;
        lines.spec = &spec;
        lines.sites = &sites;
        lines.map = &layer;
        lines.heights = camera.tilt_deg > 0;
        lines.scale = scale;
        marks = plan_marks(Fonts::load().value(), lines);
    }
    Planned(const Planned&) = delete;
    Planned& operator=(const Planned&) = delete;
};

bool marks_overlap(const Rect& a, const Rect& b) {
    return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
}

void expect_tidy(const Planned& planned) {
    std::vector<std::pair<Rect, std::string>> boxes = {{planned.marks.north, "north"}};
    if (planned.marks.scale_bar) boxes.emplace_back(planned.marks.scale_bar->box, "scale");
    for (const auto* texts :
         {&planned.marks.site_texts, &planned.marks.ground_texts, &planned.marks.height_texts}) {
        for (const MarkText& text : *texts)
            boxes.emplace_back(text.box, text.text);
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        EXPECT_GE(boxes[i].first.x, 0) << boxes[i].second;
        EXPECT_GE(boxes[i].first.y, 0) << boxes[i].second;
        EXPECT_LE(boxes[i].first.right(), planned.view.width()) << boxes[i].second;
        EXPECT_LE(boxes[i].first.bottom(), planned.view.height()) << boxes[i].second;
        for (std::size_t j = 0; j < i; ++j) {
            EXPECT_FALSE(marks_overlap(boxes[i].first, boxes[j].first))
                << boxes[i].second << " and " << boxes[j].second;
        }
        // No name covers a mark, neither its own mark nor any other mark.
        for (const auto* points : {&planned.marks.sites, &planned.marks.cities}) {
            for (const Point& p : *points) {
                EXPECT_FALSE(marks_overlap(boxes[i].first, {p.x - 1, p.y - 1, 2, 2}))
                    << boxes[i].second;
            }
        }
    }
}

std::vector<grid::SitePosition> every_station() {
    std::vector<grid::SitePosition> sites;
    for (const Station& station : all_stations()) {
        sites.push_back({std::string(station.icao), station.latitude_deg, station.longitude_deg,
                         station.antenna_altitude_m});
    }
    return sites;
}

TEST(MapMarks, NothingStandsOnAnythingElse) {
    struct Size {
        int width, height;
        double scale;
    };
    const Size sizes[] = {{530, 410, 0.85}, {672, 462, 1},    {1080, 640, 1.35}, {1668, 920, 2},
                          {3340, 1880, 4},  {950, 1700, 1.3}, {280, 210, 0.85}};
    for (const Size& size : sizes) {
        for (const Camera& camera :
             {Camera{180, 0, 1}, Camera{135, 55, 1}, Camera{20, 90, 1}, Camera{0, 70, 6}}) {
            SCOPED_TRACE(::testing::Message()
                         << size.width << "x" << size.height << " tilt " << camera.tilt_deg);
            expect_tidy(Planned(
                spec_of(Projection::azimuthal_equidistant, 40.9, -72.9, 460, 460, 1000), camera,
                size.width, size.height, size.scale, {{"KOKX", 40.8656, -72.8639, 30}}));
            const Planned states(spec_of(Projection::lambert_conformal, 38.5, -97, 600, 375, 8000),
                                 camera, size.width, size.height, size.scale, every_station());
            expect_tidy(states);
            if (camera.zoom == 1 && camera.tilt_deg < 90 && size.width > 600) {
                EXPECT_GT(states.marks.sites.size(), 120U);
                EXPECT_GT(states.marks.site_texts.size(), 20U);
            }
        }
    }
}

TEST(MapMarks, NamesTheLargestCitiesAndTheDistances) {
    const Planned planned(
        spec_of(Projection::azimuthal_equidistant, 35.3333, -97.2778, 460, 460, 1000),
        Camera{180, 0, 1}, 672, 462, 1, {{"KTLX", 35.3333, -97.2778, 389}});
    std::vector<std::string> texts;
    for (const MarkText& text : planned.marks.ground_texts)
        texts.push_back(text.text);
    for (const char* name : {"Oklahoma City", "Tulsa", "Lawton", "50 km", "100 km", "200 km"})
        EXPECT_THAT(texts, ::testing::Contains(name));
    ASSERT_EQ(planned.marks.site_texts.size(), 1U);
    EXPECT_EQ(planned.marks.site_texts[0].text, "KTLX");
}

// Tulsa is 10 km inside this grid's eastern edge, and its name covers more than 10 km. The name
// must be west of the town, although east of it there is room across the edge.
TEST(MapMarks, NamesOfCitiesDoNotCrossTheGridsEdge) {
    const Planned planned(spec_of(Projection::azimuthal_equidistant, 36.0, -97.05, 220, 230, 1000),
                          Camera{180, 0, 0.8}, 672, 462, 1, {});
    const GroundMap map(planned.spec);
    const GroundPoint town = map.ground({36.13, -95.94});
    ASSERT_GT(town.x_m, 90e3);
    const Pixel at = planned.view.project(town.x_m, town.y_m, planned.view.ground_m());
    int found = 0;
    for (const MarkText& text : planned.marks.ground_texts) {
        if (text.text != "Tulsa") continue;
        ++found;
        EXPECT_LT(text.box.right(), at.x);
    }
    EXPECT_EQ(found, 1);
}

// Seen from above, the map and its towns continue beyond the grid; seen at a slant, the ground
// fades there.
TEST(MapMarks, TownsBeyondTheGridStandInMaps) {
    const grid::GridSpec spec =
        spec_of(Projection::azimuthal_equidistant, 35.3333, -97.2778, 200, 200, 1000);
    const auto count_beyond = [&](const Camera& camera) {
        const Planned planned(spec, camera, 672, 462, 1, {});
        return std::ranges::count_if(planned.marks.cities, [&](const Point& at) {
            const auto ground = planned.view.ground({at.x, at.y});
            return std::abs(ground->x_m) > planned.view.half_x_m();
        });
    };
    EXPECT_GE(count_beyond({180, 0, 1}), 3);
    EXPECT_EQ(count_beyond({180, 40, 0.7}), 0);
}

TEST(MapMarks, TheScaleBarIsAsLongAsItSays) {
    for (const Projection projection :
         {Projection::azimuthal_equidistant, Projection::latitude_longitude,
          Projection::lambert_conformal}) {
        for (const double zoom : {1.0, 30.0, 400.0}) {
            const Planned planned(spec_of(projection, 44, -97, 300, 300, 4000),
                                  Camera{180, 0, zoom}, 672, 462, 1, {});
            ASSERT_TRUE(planned.marks.scale_bar);
            const ScaleBar& bar = *planned.marks.scale_bar;
            const GroundMap map(planned.spec);
            const auto from = map.place(*planned.view.ground({336 - bar.length / 2, 231}));
            const auto to = map.place(*planned.view.ground({336 + bar.length / 2, 231}));
            double metres = 0;
            GeographicLib::Geodesic::WGS84().Inverse(from.latitude_deg, from.longitude_deg,
                                                     to.latitude_deg, to.longitude_deg, metres);
            EXPECT_NEAR(metres / bar.metres, 1, 0.01) << zoom;
            EXPECT_GT(bar.length, 40);
            const double digit = bar.metres / std::pow(10, std::floor(std::log10(bar.metres)));
            EXPECT_THAT(digit, ::testing::AnyOf(::testing::DoubleNear(1, 1e-9),
                                                ::testing::DoubleNear(2, 1e-9),
                                                ::testing::DoubleNear(5, 1e-9)));
        }
    }
}

TEST(MapMarks, AViewAlongTheGroundHasNoScaleBar) {
    const Planned planned(spec_of(Projection::azimuthal_equidistant, 40, -97, 100, 100, 4000),
                          Camera{180, 90, 1}, 672, 462, 1, {});
    EXPECT_FALSE(planned.marks.scale_bar);
    EXPECT_TRUE(planned.marks.heights);
    EXPECT_FALSE(planned.marks.height_texts.empty());
}

// The tip is the only bright part of the arrow away from the middle, so bright pixels show where
// the arrow points.
TEST(MapMarks, TheArrowPointsNorth) {
    for (const double azimuth_deg : {180.0, 90.0, 0.0, 270.0}) {
        const Planned planned(spec_of(Projection::azimuthal_equidistant, 40, -97, 100, 100, 4000),
                              Camera{azimuth_deg, 0, 1}, 672, 462, 2, {});
        Canvas canvas(672, 462, shades::dark.page);
        draw_marks(canvas, Fonts::load().value(), planned.lines, planned.marks);
        const Image image = canvas.image();
        const Rect& box = planned.marks.north;
        const double cx = box.x + box.width / 2;
        const double cy = box.bottom() - 20 - 2 * 17;
        const double turn = (azimuth_deg - 180) * 0.017453292519943295;
        const double dx = -std::sin(turn);
        const double dy = -std::cos(turn);
        const auto bright = [&](double along) {
            int most = 0;
            for (int i = -2; i <= 2; ++i) {
                for (int j = -2; j <= 2; ++j) {
                    most = std::max<int>(most, image.at(static_cast<int>(cx + along * dx) + i,
                                                        static_cast<int>(cy + along * dy) + j)[0]);
                }
            }
            return most;
        };
        EXPECT_GT(bright(20), 180) << azimuth_deg;
        EXPECT_LT(bright(-20), 100) << azimuth_deg;
    }
}

TEST(MapCache, MakesTheMapAgainWhenTheViewIsAnother) {
    const grid::GridSpec spec = spec_of(Projection::azimuthal_equidistant, 40, -97, 100, 100, 4000);
    MapCache keeper;
    const ViewGeometry view(spec, Camera{180, 0, 1}, 1, 300, 300);
    const MapLayer* first = keeper.get(spec, view, 1).value();
    const std::size_t strokes = first->strokes.size();
    EXPECT_GT(strokes, 0U);
    EXPECT_EQ(keeper.get(spec, view, 1).value()->strokes.size(), strokes);
    EXPECT_EQ(keeper.times_made(), 1);
    static_cast<void>(keeper.get(spec, view, 2).value());
    EXPECT_EQ(keeper.times_made(), 2) << "the scale has changed";
    for (const Camera& camera : {Camera{90, 0, 1}, Camera{90, 30, 1}, Camera{90, 30, 2}}) {
        const int before = keeper.times_made();
        static_cast<void>(keeper.get(spec, {spec, camera, 1, 300, 300}, 2).value());
        EXPECT_EQ(keeper.times_made(), before + 1);
    }
    grid::GridSpec other = spec;
    other.center_longitude_deg += 1;
    const int before = keeper.times_made();
    static_cast<void>(keeper.get(other, {other, Camera{90, 30, 2}, 1, 300, 300}, 2).value());
    EXPECT_EQ(keeper.times_made(), before + 1) << "the place has changed";
}

TEST(DistanceText, SaysMetresAndKilometres) {
    EXPECT_EQ(distance_text(500, {}), "500 m");
    EXPECT_EQ(distance_text(1000, {}), "1 km");
    EXPECT_EQ(distance_text(2500, {}), "2.5 km");
}

}  // namespace
}  // namespace stormcellar::render
