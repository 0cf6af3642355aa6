#include "stormcellar/render/panels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/image/shades.h"
#include "render/map/panel_layout.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

constexpr level2::Moment four[] = {level2::Moment::ref, level2::Moment::vel, level2::Moment::rho,
                                   level2::Moment::zdr};

bool touch(const Rect& a, const Rect& b) {
    return a.x < b.right() - 0.01 && b.x < a.right() - 0.01 && a.y < b.bottom() - 0.01 &&
           b.y < a.bottom() - 0.01;
}

FrameFacts facts_for(const std::string& domain) {
    FrameFacts facts;
    facts.domain = domain;
    facts.time = parse_compact("19990503_235621").value();
    facts.sites = {{"KTLX", 35.3, -97.3, 384}};
    facts.partial = true;
    return facts;
}

TEST(PanelLayout, NothingOverlapsAtAnySize) {
    const Fonts fonts = Fonts::load().value();
    for (const auto& [width, height] : {std::pair{640, 480},
                                        {796, 532},
                                        {1280, 720},
                                        {1280, 960},
                                        {1920, 1080},
                                        {3840, 2160},
                                        {1000, 1000},
                                        {1080, 1920},
                                        {2160, 3840}}) {
        for (const Product product : {Product::composite, Product::volume}) {
            for (int count = 1; count <= 4; ++count) {
                SCOPED_TRACE(::testing::Message() << width << "x" << height << ", " << count);
                Scene scene;
                scene.width = width;
                scene.height = height;
                scene.product = product;
                std::vector<Legend> legends;
                for (int i = 0; i < count; ++i) {
                    scene.moment = four[i];
                    legends.push_back(legend_of(scene));
                }
                scene.moment = four[0];
                const auto layout = lay_out_panels(fonts, scene, facts_for("KTLX"),
                                                   {legends[0], 50e3, Coverage{0.9, 0.5}}, legends);
                ASSERT_TRUE(layout) << layout.error().message;
                std::vector<std::pair<Rect, std::string>> boxes;
                for (const Rect& picture : layout->pictures)
                    boxes.emplace_back(picture, "a picture");
                for (const LabelText& text : layout->labels.texts)
                    boxes.emplace_back(text.box, text.text);
                for (const LabelBlock& block : layout->labels.blocks)
                    boxes.emplace_back(block.box, "block");
                for (std::size_t i = 0; i < boxes.size(); ++i) {
                    EXPECT_GE(boxes[i].first.x, 0);
                    EXPECT_GE(boxes[i].first.y, 0);
                    EXPECT_LE(boxes[i].first.right(), width) << boxes[i].second;
                    EXPECT_LE(boxes[i].first.bottom(), height) << boxes[i].second;
                    for (std::size_t j = 0; j < i; ++j) {
                        EXPECT_FALSE(touch(boxes[i].first, boxes[j].first))
                            << boxes[i].second << " and " << boxes[j].second;
                    }
                }
                double shown = 0;
                for (const Rect& picture : layout->pictures) {
                    EXPECT_EQ(picture.width, std::round(picture.width));
                    shown += picture.width * picture.height;
                }
                // With three panels, the place of a fourth is empty.
                EXPECT_GT(shown / width / height, count == 3 ? 0.4 : 0.5);
            }
        }
    }
}

TEST(PanelLayout, PanelsAreNearlySquare) {
    EXPECT_EQ(panels_in_a_row(4, 1280, 900), 2);
    EXPECT_EQ(panels_in_a_row(4, 1080, 1700), 2);
    EXPECT_EQ(panels_in_a_row(4, 3000, 600), 4);
    EXPECT_EQ(panels_in_a_row(2, 1280, 700), 2);
    EXPECT_EQ(panels_in_a_row(2, 1080, 1700), 1);
    EXPECT_EQ(panels_in_a_row(1, 1080, 1700), 1);
}

TEST(Panels, EachHasItsGridAndItsColors) {
    const grid::GridSpec spec = small_spec(100, 8);
    const auto strong = bricks_of(make_grid_of(spec, [](int, int, int) { return valued(52); }));
    const auto weak = bricks_of(make_grid_of(spec, [](int, int, int) { return valued(22); }));
    const auto facts = facts_of(make_grid_of(spec, [](int, int, int) { return Cell{}; }));
    Scene scene;
    scene.product = Product::composite;
    scene.width = 1280;
    scene.height = 960;
    const std::vector<Panel> panels = {{strong.view(), facts, scene},
                                       {weak.view(), facts, scene},
                                       {weak.view(), facts, scene},
                                       {strong.view(), facts, scene}};
    const auto picture = render_panels(panels, 2);
    ASSERT_TRUE(picture) << picture.error().message;
    EXPECT_EQ(picture->width, 1280);
    EXPECT_EQ(picture->height, 960);
    // Reads a pixel beside the middle of a panel, where the mark of the site and the rings are not.
    const auto at = [&](int column, int row) {
        return picture->at(320 + 640 * column + 37, 300 + 430 * row - 31);
    };
    EXPECT_EQ(at(0, 0), (Rgba8{0xFD, 0, 0, 255}));
    EXPECT_EQ(at(1, 0), at(0, 1));
    EXPECT_EQ(at(1, 1), at(0, 0));
    EXPECT_NE(at(1, 0), at(0, 0));
    EXPECT_EQ(render_panels(panels, 5)->rgba, picture->rgba)
        << "the number of threads does not matter";
}

TEST(Panels, WhatCannotBeDrawnIsRefused) {
    const auto grid = make_grid_of(small_spec(20, 4), [](int, int, int) { return valued(30); });
    const auto bricks = bricks_of(grid);
    const Scene scene;
    EXPECT_FALSE(render_panels({}, 1));
    Panel panel{bricks.view(), facts_of(grid), scene};
    EXPECT_FALSE(render_panels(std::vector<Panel>(10, panel), 1));
    panel.scene.width = 400;
    panel.scene.height = 300;
    const auto small = render_panels(std::vector<Panel>(4, panel), 1);
    ASSERT_FALSE(small);
    EXPECT_THAT(small.error().message, ::testing::HasSubstr("need a larger picture"));
    panel.scene.moment = level2::Moment::vel;
    EXPECT_FALSE(render_panels({&panel, 1}, 1)) << "the grid is of another moment";
    panel.scene = scene;
    panel.scene.product = Product::section;
    panel.scene.section = SectionLine{{35, -98}, {36, -97}};
    EXPECT_FALSE(render_panels({&panel, 1}, 1));
}

}  // namespace
}  // namespace stormcellar::render
