#include "render/map/labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stormcellar::render {
namespace {

FrameFacts facts_for(const std::string& domain, int sites, bool partial) {
    FrameFacts facts;
    facts.domain = domain;
    facts.time = parse_compact("19990503_235621").value();
    facts.partial = partial;
    for (int i = 0; i < sites; ++i)
        facts.sites.push_back({"KTLX", 35.3, -97.3, 384});
    return facts;
}

bool overlap(const Rect& a, const Rect& b) {
    return a.x < b.right() - 0.01 && b.x < a.right() - 0.01 && a.y < b.bottom() - 0.01 &&
           b.y < a.bottom() - 0.01;
}

void expect_tidy(const LabelLayout& layout, int width, int height) {
    std::vector<std::pair<Rect, std::string>> boxes;
    for (const LabelText& text : layout.texts)
        boxes.emplace_back(text.box, text.text);
    for (const LabelBlock& block : layout.blocks)
        boxes.emplace_back(block.box, "block");
    const Rect picture{static_cast<double>(layout.left), static_cast<double>(layout.top),
                       static_cast<double>(layout.width), static_cast<double>(layout.height)};
    boxes.emplace_back(picture, "the picture");
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Rect& box = boxes[i].first;
        EXPECT_GE(box.x, 0) << boxes[i].second;
        EXPECT_GE(box.y, 0) << boxes[i].second;
        EXPECT_LE(box.right(), width) << boxes[i].second;
        EXPECT_LE(box.bottom(), height) << boxes[i].second;
        for (std::size_t j = 0; j < i; ++j) {
            EXPECT_FALSE(overlap(box, boxes[j].first))
                << boxes[i].second << " and " << boxes[j].second;
        }
    }
}

TEST(Labels, NothingOverlapsAtAnySize) {
    const Fonts fonts = Fonts::load().value();
    const std::string long_name(64, 'W');
    const std::pair<int, int> sizes[] = {{400, 300},  {640, 480},  {796, 532},   {800, 300},
                                         {400, 1000}, {1280, 720}, {1920, 1080}, {3840, 2160},
                                         {8192, 300}, {1080, 1920}};
    for (const auto& [width, height] : sizes) {
        for (const Product product :
             {Product::volume, Product::composite, Product::section, Product::echo_top}) {
            for (const auto& facts : {facts_for("KTLX", 1, false), facts_for(long_name, 1, true),
                                      facts_for("plains", 7, true), facts_for("x", 0, false)}) {
                SCOPED_TRACE(testing::Message() << width << "x" << height << " " << facts.domain);
                Scene scene;
                scene.width = width;
                scene.height = height;
                scene.product = product;
                scene.camera.azimuth_deg = 157.5;
                scene.camera.tilt_deg = 52.125;
                const auto layout = lay_out_labels(fonts, scene, facts, 50e3);
                ASSERT_TRUE(layout);
                expect_tidy(*layout, width, height);
                EXPECT_GT(layout->width, width / 2);
                EXPECT_GT(layout->height, height / 2);
            }
        }
    }
}

std::vector<std::string> texts_of(const Scene& scene, const FrameFacts& facts) {
    std::vector<std::string> texts;
    const auto layout = lay_out_labels(Fonts::load().value(), scene, facts, 50e3);
    for (const LabelText& text : layout->texts)
        texts.push_back(text.text);
    return texts;
}

TEST(Labels, SayWhatWasDone) {
    using testing::Contains;
    using testing::HasSubstr;
    Scene scene;
    scene.vertical_exaggeration = 8;
    const auto texts = texts_of(scene, facts_for("KTLX", 1, true));
    EXPECT_THAT(texts, Contains("KTLX  Oklahoma City, OK"));
    EXPECT_THAT(texts, Contains("1999-05-03 23:56:21 UTC"));
    EXPECT_THAT(texts, Contains("partial volume"));
    EXPECT_THAT(texts, Contains("dBZ"));
    EXPECT_THAT(texts, Contains("not seen"));
    EXPECT_THAT(texts, Contains(HasSubstr("vertical \u00D78")));
    EXPECT_THAT(texts, Contains(HasSubstr("Seen from S, 55\u00B0")));
    EXPECT_THAT(texts, Contains(HasSubstr("every 50 km")));
    for (int dbz = 5; dbz <= 75; dbz += 5)
        EXPECT_THAT(texts, Contains(std::to_string(dbz)));
}

TEST(Labels, WholeVolumesAreNotCalledPartialAndMapsSayNoExaggeration) {
    Scene scene;
    scene.product = Product::composite;
    const auto texts = texts_of(scene, facts_for("KTLX", 1, false));
    EXPECT_THAT(texts, testing::Not(testing::Contains("partial volume")));
    EXPECT_THAT(texts, testing::Contains("range folded"));
    EXPECT_THAT(texts, testing::Not(testing::Contains(testing::HasSubstr("vertical"))));
}

TEST(Labels, ATooSmallPictureIsRefused) {
    Scene scene;
    scene.width = 399;
    const auto layout =
        lay_out_labels(Fonts::load().value(), scene, facts_for("KTLX", 1, false), 50e3);
    ASSERT_FALSE(layout);
    EXPECT_EQ(layout.error().code, ErrorCode::bad_argument);
    EXPECT_THAT(layout.error().message, testing::HasSubstr("400 by 300"));
}

}  // namespace
}  // namespace stormcellar::render
