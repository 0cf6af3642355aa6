// Tests pictures of real domains in common sizes: no text is cut, shortened or on top of anything,
// and the map fills its frame.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/image/shades.h"
#include "render/map/labels.h"
#include "render/map/map_marks.h"
#include "render/map/panel_layout.h"
#include "render/products/section.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/render/product.h"
#include "stormcellar/render/render.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {
namespace {

using level2::Moment;

constexpr std::pair<int, int> shared_sizes[] = {
    {640, 480}, {796, 532}, {1920, 1080}, {3840, 2160}, {1080, 1920}};

struct Domain {
    std::string name;
    std::vector<grid::SitePosition> sites;
    grid::GridSpec spec;
};

Domain domain_of(std::string name, std::initializer_list<const char*> stations) {
    Domain domain{std::move(name), {}, {}};
    double south = 90, north = -90, west = 180, east = -180;
    for (const char* icao : stations) {
        const auto station = find_station(icao).value();
        domain.sites.push_back(
            {icao, station.latitude_deg, station.longitude_deg, station.antenna_altitude_m});
        south = std::min(south, station.latitude_deg);
        north = std::max(north, station.latitude_deg);
        west = std::min(west, station.longitude_deg);
        east = std::max(east, station.longitude_deg);
    }
    domain.spec = grid::default_spec((south + north) / 2, (west + east) / 2);
    const double wider_km = (east - west) * 85;
    const double higher_km = (north - south) * 111;
    domain.spec.nx = static_cast<int>(460 + wider_km);
    domain.spec.ny = static_cast<int>(460 + higher_km);
    return domain;
}

// Returns a site in the plains, two sites at coasts, a TDWR (their names are long), and the crowded
// northeast with seven radars and with all of its radars.
std::vector<Domain> domains() {
    return {domain_of("KTLX", {"KTLX"}),
            domain_of("KLIX", {"KLIX"}),
            domain_of("KOKX", {"KOKX"}),
            domain_of("TSTL", {"TSTL"}),
            domain_of("northeast", {"KBGM", "KCCX", "KDIX", "KDOX", "KENX", "KOKX", "KTYX"}),
            domain_of("northeast-all",
                      {"KBGM", "KBOX", "KBUF", "KCCX", "KCXX", "KDIX", "KDOX", "KENX", "KGYX",
                       "KLWX", "KOKX", "KTYX", "TBOS", "TBWI", "TEWR", "TJFK", "TPHL", "TDCA"})};
}

std::vector<Units> unit_choices() {
    return {Units{}, units_from_names("knots,miles,kft").value(),
            units_from_names("km/h,nautical-miles,feet").value()};
}

FrameFacts facts_for(const Domain& domain) {
    FrameFacts facts;
    facts.domain = domain.name;
    facts.sites = domain.sites;
    facts.time = parse_compact("20100911_012056").value();
    facts.local_time = "2010-09-10 21:20:56 EDT";
    return facts;
}

Scene scene_for(Product product, const Domain& domain, int width, int height) {
    Scene scene;
    scene.product = product;
    scene.width = width;
    scene.height = height;
    if (product == Product::ppi) scene.elevation_deg = 0.5;
    if (view_of(product) == View::volume) {
        scene.camera = Camera{.azimuth_deg = 202.5, .tilt_deg = 61, .field_of_view_deg = 40};
        scene.vertical_exaggeration = 3;
        scene.light.gradient = scene.light.shadow = true;
    }
    if (product == Product::section) {
        const grid::GeoPoint middle{domain.spec.center_latitude_deg,
                                    domain.spec.center_longitude_deg};
        scene.section = SectionLine{{middle.latitude_deg - 0.4, middle.longitude_deg - 1.2},
                                    {middle.latitude_deg + 0.4, middle.longitude_deg + 1.2}};
    }
    return scene;
}

struct Box {
    Rect rect;
    std::string text;
};

void expect_apart(const std::vector<Box>& boxes, double width, double height) {
    const auto overlap = [](const Rect& a, const Rect& b) {
        return a.x < b.right() - 0.01 && b.x < a.right() - 0.01 && a.y < b.bottom() - 0.01 &&
               b.y < a.bottom() - 0.01;
    };
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Rect& box = boxes[i].rect;
        EXPECT_TRUE(box.x >= 0 && box.y >= 0 && box.right() <= width && box.bottom() <= height)
            << boxes[i].text << " is cut by the edge";
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_FALSE(overlap(box, boxes[j].rect)) << boxes[i].text << " on " << boxes[j].text;
    }
}

void expect_whole(const LabelLayout& layout) {
    for (const LabelText& text : layout.texts)
        EXPECT_THAT(text.text, ::testing::Not(::testing::HasSubstr("\u2026")));
}

std::vector<Box> boxes_of(const LabelLayout& layout) {
    std::vector<Box> boxes;
    for (const LabelText& text : layout.texts)
        boxes.push_back({text.box, text.text});
    for (const LabelBlock& block : layout.blocks)
        boxes.push_back({block.box, "a block of color"});
    return boxes;
}

class RealLayout : public ::testing::Test {
  protected:
    // Calls check(domain, scene) for each domain, size and choice of units.
    template <class Check>
    void for_all(Product product, Check check) {
        for (const Domain& domain : domains_) {
            for (const auto& [width, height] : shared_sizes) {
                for (const Units& units : unit_choices()) {
                    SCOPED_TRACE(::testing::Message()
                                 << product_name(product) << " of " << domain.name << ", " << width
                                 << "x" << height << ", " << unit_names(units));
                    Scene scene = scene_for(product, domain, width, height);
                    scene.units = units;
                    check(domain, scene);
                }
            }
        }
    }
    [[nodiscard]] LabelLayout labels(const Domain& domain, const Scene& scene) const {
        return lay_out_labels(fonts_, scene, facts_for(domain),
                              {legend_of(scene), drawn_ring_spacing(domain.spec, scene),
                               Coverage{0.9958, 0.4}})
            .value();
    }
    Fonts fonts_ = Fonts::load().value();
    std::vector<Domain> domains_ = domains();
};

TEST_F(RealLayout, LabelsAreWholeAndApart) {
    for (const Product product : {Product::volume, Product::composite, Product::ppi,
                                  Product::section, Product::echo_top, Product::cappi}) {
        for_all(product, [&](const Domain& domain, const Scene& scene) {
            const LabelLayout layout = labels(domain, scene);
            expect_whole(layout);
            std::vector<Box> boxes = boxes_of(layout);
            boxes.push_back(
                {{static_cast<double>(layout.left), static_cast<double>(layout.top),
                  static_cast<double>(layout.width), static_cast<double>(layout.height)},
                 "the map"});
            if (layout.inset) boxes.push_back({*layout.inset, "the small map"});
            expect_apart(boxes, scene.width, scene.height);
        });
    }
}

// The row "no echo or < 18.5 dBZ" was smaller than the other rows (2026-11-25).
TEST_F(RealLayout, RowsOfALegendAreOfOneSize) {
    for_all(Product::echo_top, [&](const Domain& domain, const Scene& scene) {
        double size = 0;
        for (const LabelText& text : labels(domain, scene).texts) {
            const auto rows = legend_of(scene).rows;
            if (std::ranges::find(rows, text.text, &LegendRow::text) == rows.end()) continue;
            if (size > 0) {
                EXPECT_DOUBLE_EQ(text.size, size) << text.text;
            }
            size = text.size;
        }
        EXPECT_GT(size, 0);
    });
}

TEST_F(RealLayout, MarksAreApart) {
    std::size_t names = 0;
    for (const Product product : {Product::composite, Product::volume}) {
        for_all(product, [&](const Domain& domain, const Scene& scene) {
            // Wider pictures are laid out as at 1920, so one choice of units is enough.
            if (scene.width > 1920 && scene.units.distance != Unit::km) return;
            const LabelLayout layout = labels(domain, scene);
            const ViewGeometry geometry =
                picture_geometry(domain.spec, scene, layout.width, layout.height);
            const auto map =
                prepare_map(BaseMap::built_in().value(), domain.spec, geometry, layout.scale)
                    .value();
            MapLines lines{.geometry = &geometry,
                           .spec = &domain.spec,
                           .sites = &domain.sites,
                           .map = &map,
                           .ring_spacing_m = drawn_ring_spacing(domain.spec, scene),
                           .units = scene.units,
                           .heights = product == Product::volume,
                           .scale = layout.scale};
            const MapMarks marks = plan_marks(fonts_, lines);
            std::vector<Box> boxes = {{marks.north, "north"}};
            if (marks.scale_bar) boxes.push_back({marks.scale_bar->box, "the scale bar"});
            for (const auto* texts :
                 {&marks.site_texts, &marks.ground_texts, &marks.height_texts}) {
                for (const MarkText& text : *texts) {
                    boxes.push_back({text.box, text.text});
                    // The box contains the drawn text.
                    EXPECT_GE(text.box.width, fonts_.width(text.text, text.size, text.bold));
                }
            }
            expect_apart(boxes, layout.width, layout.height);
            names += marks.ground_texts.size();
        });
    }
    EXPECT_GT(names, 1000U) << "too few names were drawn to test whether they overlap";
}

TEST_F(RealLayout, PanelsAreWholeAndApart) {
    constexpr std::array moments = {Moment::ref, Moment::vel, Moment::rho, Moment::zdr};
    for_all(Product::composite, [&](const Domain& domain, Scene scene) {
        std::vector<Legend> legends;
        for (const Moment moment : moments) {
            scene.moment = moment;
            legends.push_back(legend_of(scene));
        }
        const auto layout =
            lay_out_panels(fonts_, scene, facts_for(domain),
                           {legends[0], drawn_ring_spacing(domain.spec, scene), Coverage{0.9, 0.5}},
                           legends)
                .value();
        expect_whole(layout.labels);
        std::vector<Box> boxes = boxes_of(layout.labels);
        for (const Rect& picture : layout.pictures)
            boxes.push_back({picture, "a panel"});
        expect_apart(boxes, scene.width, scene.height);
    });
}

// Axes are drawn without a plan, so this test reads pixels: nothing may touch the edge of the
// picture.
TEST_F(RealLayout, AxesOfASectionAreNotCut) {
    for_all(Product::section, [&](const Domain& domain, const Scene& scene) {
        if (domain.name != "KTLX" || scene.width > 1920) return;
        const LabelLayout layout = labels(domain, scene);
        const SectionPlace place = section_place(layout.width, layout.height, layout.scale, true);
        Section section;
        section.line = *scene.section;
        section.in_grid.assign(static_cast<std::size_t>(place.width), 0);
        section.bottom_m = 0;
        section.top_m = 16250;
        // At these lengths the last number is at the end of the axis.
        for (const double length_m : {200e3, 120 * 1852.0, 120 * 1609.344, 300e3}) {
            section.length_m = length_m;
            const GroundLook look{&shades::dark, nullptr, layout.scale};
            const Image image = draw_section(section, nws_reflectivity(), place, layout.width,
                                             layout.height, look, scene.units, &fonts_);
            const auto is_page = [&](int x, int y) { return image.at(x, y) == shades::dark.page; };
            for (int y = 0; y < image.height; ++y)
                EXPECT_TRUE(is_page(0, y) && is_page(image.width - 1, y)) << y << " " << length_m;
            for (int x = 0; x < image.width; ++x)
                EXPECT_TRUE(is_page(x, 0) && is_page(x, image.height - 1)) << x;
        }
    });
}

TEST_F(RealLayout, ASquareMapFillsItsFrame) {
    const Domain& square = domains_.front();
    ASSERT_EQ(square.spec.nx, square.spec.ny);
    for (const auto& [width, height] : shared_sizes) {
        const Scene scene = scene_for(Product::composite, square, width, height);
        const LabelLayout layout = labels(square, scene);
        const auto geometry = picture_geometry(square.spec, scene, layout.width, layout.height);
        const double side = square.spec.nx * square.spec.spacing_m / geometry.metres_per_pixel();
        EXPECT_GE(side, 0.7 * std::min(width, height)) << width << "x" << height;
        EXPECT_GE(1.0 * layout.width * layout.height, 0.7 * width * height);
    }
}

}  // namespace
}  // namespace stormcellar::render
