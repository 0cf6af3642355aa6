#include "render/map/labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/image/shades.h"
#include "stormcellar/render/color_table.h"

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
    if (layout.inset) boxes.emplace_back(*layout.inset, "the small map");
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

DrawnFacts picture_of(Scene scene, level2::Moment moment, const ColorTable& table) {
    scene.moment = moment;
    // Classes have names in place of a bar, and only a ppi shows classes.
    const bool has_classes = level2::facts_of(moment).is_categorical;
    if (has_classes) scene.product = Product::ppi;
    Legend legend = legend_of(scene);
    if (!has_classes) legend.table = &table;
    legend.bar_heading = table.unit;
    return {legend, 50e3, Coverage{0.9958, 0.4}};
}

// Returns facts with long texts.
FrameFacts troubled(int sites) {
    FrameFacts facts = facts_for(std::string(64, 'W'), sites, true);
    facts.local_time = "2026-11-22 18:56:21 America/Argentina/ComodRivadavia";
    facts.antenna_to_picture = std::chrono::seconds(3599);
    for (int i = 0; i < 40; ++i)
        facts.radar_troubles.emplace_back("KTLX: standby, maintenance mandatory, alarm 452");
    return facts;
}

// Returns a table of uneven classes with long numbers, without a unit.
ColorTable uneven_table() {
    ColorTable table = nws_reflectivity();
    table.unit = "";
    table.stops = {{-0.0625F, {1, 2, 3, 255}, {1, 2, 3, 255}},
                   {0.125F, {9, 2, 3, 255}, {9, 2, 3, 255}},
                   {0.13F, {9, 99, 3, 255}, {9, 99, 3, 255}},
                   {1234.5F, {9, 2, 99, 255}, {9, 2, 99, 255}}};
    table.end = 2000;
    return table;
}

ColorTable smooth_labels_table() {
    ColorTable table = nws_reflectivity();
    table.unit = "degrees a kilometre";
    table.stops = {{-64.25F, {0, 0, 200, 255}, {200, 200, 200, 255}},
                   {0, {200, 200, 200, 255}, {200, 0, 0, 255}}};
    table.end = 63.75F;
    return table;
}

constexpr std::pair<int, int> sizes[] = {
    {400, 300},   {640, 480},   {796, 532},   {800, 300},   {800, 600},  {1024, 768}, {1280, 720},
    {1920, 1080}, {2560, 1440}, {3840, 2160}, {8192, 300},  {400, 1000}, {480, 640},  {1080, 1920},
    {2160, 3840}, {1000, 1000}, {1080, 1350}, {8192, 8192}, {400, 8192}, {1200, 1001}};

void expect_tidy(const Fonts& fonts, const Scene& scene, const FrameFacts& facts) {
    const ColorTable tables[] = {nws_reflectivity(), uneven_table(), smooth_labels_table()};
    std::vector<DrawnFacts> pictures;
    for (const ColorTable& table : tables)
        pictures.push_back(picture_of(scene, level2::Moment::ref, table));
    for (const level2::Moment moment : level2::all_moments) {
        // No section shows classes, whose many names would cover its small map.
        if (level2::facts_of(moment).is_categorical && scene.section) continue;
        pictures.push_back(picture_of(scene, moment, tables[0]));
    }
    for (const DrawnFacts& picture : pictures) {
        const auto layout = lay_out_labels(fonts, scene, facts, picture);
        ASSERT_TRUE(layout);
        expect_tidy(*layout, scene.width, scene.height);
        EXPECT_GT(layout->width, scene.width / 2);
        EXPECT_GT(layout->height, scene.height / 2);
    }
}

TEST(Labels, NothingOverlapsAtAnySize) {
    const Fonts fonts = Fonts::load().value();
    for (const auto& [width, height] : sizes) {
        for (const Product product :
             {Product::volume, Product::composite, Product::section, Product::echo_top}) {
            for (const auto& facts : {facts_for("KTLX", 1, false), facts_for("plains", 7, true),
                                      troubled(1), troubled(160), facts_for("x", 0, false)}) {
                SCOPED_TRACE(::testing::Message() << width << "x" << height << " " << facts.domain);
                Scene scene;
                scene.width = width;
                scene.height = height;
                scene.product = product;
                scene.camera.azimuth_deg = 157.5;
                scene.camera.tilt_deg = 52.125;
                if (product == Product::section) scene.section = SectionLine{{35, -98}, {36, -97}};
                expect_tidy(fonts, scene, facts);
            }
        }
    }
}

TEST(Labels, WhatHasNoRoomEndsInAnEllipsis) {
    const Fonts fonts = Fonts::load().value();
    Scene scene;
    scene.width = 640;
    scene.height = 480;
    const auto layout = lay_out_labels(fonts, scene, troubled(1),
                                       picture_of(scene, level2::Moment::ref, nws_reflectivity()));
    ASSERT_TRUE(layout);
    int cut = 0;
    for (const LabelText& text : layout->texts) {
        EXPECT_LE(fonts.width(text.text, text.size, text.bold), text.box.width + 0.01);
        cut += text.text.ends_with("\u2026") ? 1 : 0;
    }
    EXPECT_GE(cut, 2) << "the title and the warnings are cut";
}

TEST(Labels, WarningsStandBesideTheProductAndMoveNothing) {
    const Fonts fonts = Fonts::load().value();
    const Scene scene;
    FrameFacts facts = facts_for("KTLX", 1, false);
    const auto picture = picture_of(scene, level2::Moment::ref, nws_reflectivity());
    const auto quiet = lay_out_labels(fonts, scene, facts, picture);
    facts.partial = true;
    facts.left_out = {"north (KFWS): nothing since 22:05"};
    facts.radar_troubles = {"KTLX: standby"};
    const auto layout = lay_out_labels(fonts, scene, facts, picture);
    EXPECT_EQ(layout->top, quiet->top);
    EXPECT_EQ(layout->height, quiet->height);
    EXPECT_EQ(layout->width, quiet->width);
    bool found = false;
    for (const LabelText& text : layout->texts) {
        if (text.text !=
            "partial volume  \u00B7  without north (KFWS): nothing since 22:05  \u00B7  KTLX: "
            "standby")
            continue;
        found = true;
        EXPECT_EQ(text.color, shades::dark.warning_text);
    }
    EXPECT_TRUE(found);
}

std::vector<std::string> texts_of(const Scene& scene, const FrameFacts& facts) {
    std::vector<std::string> texts;
    const auto layout = lay_out_labels(Fonts::load().value(), scene, facts,
                                       picture_of(scene, facts.moment, nws_reflectivity()));
    for (const LabelText& text : layout->texts)
        texts.push_back(text.text);
    return texts;
}

// 2026-11-30: a short warning took four tenths of the line, and the product was cut.
TEST(Labels, AShortWarningLeavesTheRestOfTheLineToTheProduct) {
    Scene scene;
    scene.product = Product::composite;
    FrameFacts facts = facts_for("KDMX", 1, true);
    facts.quality =
        "probability of weather at least 0.5; 12.3 % of the echo left out: birds and insects 8.1 "
        "%, ground clutter 3.0 %";
    const std::vector<std::string> texts = texts_of(scene, facts);
    EXPECT_THAT(texts, ::testing::Contains(product_line(scene, facts)));
    EXPECT_THAT(texts, ::testing::Contains("partial volume"));
}

TEST(Labels, AFrameBetweenVolumesSaysSoBelowItsTime) {
    const Fonts fonts = Fonts::load().value();
    const Scene scene;
    const auto picture = picture_of(scene, level2::Moment::ref, nws_reflectivity());
    const auto texts = [&](const FrameFacts& facts) {
        std::vector<std::string> all;
        const auto layout = lay_out_labels(fonts, scene, facts, picture);
        EXPECT_TRUE(layout);
        for (const LabelText& text : layout->texts)
            all.push_back(text.text);
        return all;
    };
    FrameFacts facts = facts_for("KTLX", 1, false);
    EXPECT_THAT(texts(facts), ::testing::Not(::testing::Contains("interpolated")));
    facts.interpolated = true;
    EXPECT_THAT(texts(facts), ::testing::Contains("interpolated"));
    facts.local_time = "1999-05-03 18:56:21 CDT";
    EXPECT_THAT(texts(facts), ::testing::Contains("1999-05-03 18:56:21 CDT  \u00B7  interpolated"));
}

TEST(Labels, SayWhatWasDone) {
    using ::testing::Contains;
    using ::testing::HasSubstr;
    Scene scene;
    scene.vertical_exaggeration = 8;
    FrameFacts facts = facts_for("KTLX", 1, true);
    facts.local_time = "1999-05-03 18:56:21 CDT";
    facts.antenna_to_picture = std::chrono::seconds(192);
    const auto texts = texts_of(scene, facts);
    EXPECT_THAT(texts, Contains("1999-05-03 18:56:21 CDT"));
    EXPECT_THAT(texts, Contains("3 min 12 s from antenna to picture"));
    EXPECT_THAT(texts, Contains("KTLX  Oklahoma City, OK"));
    EXPECT_THAT(texts, Contains("1999-05-03 23:56:21 UTC"));
    EXPECT_THAT(texts, Contains("partial volume"));
    EXPECT_THAT(texts, Contains("Seen: > 99 % of the columns, 40 % below 3 km"));
    EXPECT_THAT(texts, Contains(HasSubstr("Census")));
    EXPECT_THAT(texts, Contains("dBZ"));
    EXPECT_THAT(texts, Contains("not seen"));
    EXPECT_THAT(texts, Contains(HasSubstr("vertical \u00D78")));
    EXPECT_THAT(texts, Contains(HasSubstr("Seen from S, 55\u00B0")));
    EXPECT_THAT(texts, Contains(HasSubstr("every 50 km")));
    for (int dbz = 5; dbz <= 75; dbz += 5)
        EXPECT_THAT(texts, Contains(std::to_string(dbz)));
}

TEST(Labels, SayTheMotionOfTheStormInTheUnitOfSpeeds) {
    using ::testing::Contains;
    Scene scene;
    scene.product = Product::composite;
    scene.moment = level2::Moment::srv;
    FrameFacts facts = facts_for("KTLX", 1, false);
    facts.storm_motion = retrieve::parse_motion("240/15").value();
    const std::string title = "Composite storm-relative velocity (column maximum)";
    EXPECT_THAT(texts_of(scene, facts), Contains(title + ", motion from 240 degrees at 15 m/s"));
    scene.units.speed = Unit::knots;
    EXPECT_THAT(texts_of(scene, facts), Contains(title + ", motion from 240 degrees at 29.2 kt"));
    facts.storm_motion.reset();
    EXPECT_THAT(texts_of(scene, facts), Contains(title));
}

TEST(Labels, SayHowVelocitiesWereDealiasedAndSinceWhen) {
    Scene scene;
    scene.product = Product::rotation_tracks;
    scene.moment = level2::Moment::azsh;
    FrameFacts facts = facts_for("KTLX", 1, false);
    facts.dealiasing = "anchored";
    facts.since = UtcTime{std::chrono::seconds{925'774'860}};
    EXPECT_EQ(product_line(scene, facts),
              "Rotation tracks, largest azimuthal shear 0 to 2 km above the radar, dealiasing "
              "anchored, since 1999-05-03 23:41 UTC");
}

TEST(Labels, WhatOneSiteSeesOfADomainIsTheSitesPicture) {
    EXPECT_THAT(texts_of(Scene{}, facts_for("moore.KTLX", 1, false)),
                ::testing::Contains("KTLX  Oklahoma City, OK  (moore)"));
    EXPECT_THAT(texts_of(Scene{}, facts_for("moore", 1, false)),
                ::testing::Contains("moore  (KTLX  Oklahoma City, OK)"));
}

// The title of a picture of seven files was "KBGM+KCCX+KDIX+KDOX+KENX+KOKX+KTYX" (2026-11-26).
TEST(Labels, ManySitesAreCountedInTheTitle) {
    using ::testing::Contains;
    EXPECT_THAT(texts_of(Scene{}, facts_for("KBGM+KCCX+KDIX+KDOX", 4, false)),
                Contains("Mosaic of 4 sites"));
    EXPECT_THAT(texts_of(Scene{}, facts_for("KBGM+KCCX", 2, false)),
                Contains("KBGM+KCCX  (2 sites)"));
    EXPECT_THAT(texts_of(Scene{}, facts_for("northeast", 4, false)),
                Contains("northeast  (4 sites)"));
    Scene lit;
    ASSERT_TRUE(set_light("gradient,shadow", lit.light));
    EXPECT_THAT(texts_of(lit, facts_for("KTLX", 1, false)),
                Contains(::testing::HasSubstr("lit (gradient, shadow)")));
}

TEST(Labels, WholeVolumesAreNotCalledPartialAndMapsSayNoExaggeration) {
    Scene scene;
    scene.product = Product::composite;
    const auto texts = texts_of(scene, facts_for("KTLX", 1, false));
    EXPECT_THAT(texts, ::testing::Not(::testing::Contains("partial volume")));
    EXPECT_THAT(texts, ::testing::Contains("range folded"));
    EXPECT_THAT(texts, ::testing::Not(::testing::Contains(::testing::HasSubstr("vertical"))));
}

TEST(Labels, WhatIsNotKnownIsNotSaid) {
    const auto texts = texts_of(Scene{}, facts_for("KTLX", 1, false));
    for (const char* words : {"antenna to picture", "partial", "maintenance"})
        EXPECT_THAT(texts, ::testing::Not(::testing::Contains(::testing::HasSubstr(words))));
}

TEST(DurationText, SaysMinutesAndSeconds) {
    EXPECT_EQ(duration_text(std::chrono::seconds(0)), "0 s");
    EXPECT_EQ(duration_text(std::chrono::seconds(59)), "59 s");
    EXPECT_EQ(duration_text(std::chrono::seconds(60)), "1 min 0 s");
    EXPECT_EQ(duration_text(std::chrono::seconds(192)), "3 min 12 s");
}

TEST(Labels, ATooSmallPictureIsRefused) {
    Scene scene;
    scene.width = 399;
    const auto layout =
        lay_out_labels(Fonts::load().value(), scene, facts_for("KTLX", 1, false), {});
    ASSERT_FALSE(layout);
    EXPECT_EQ(layout.error().code, ErrorCode::bad_argument);
    EXPECT_THAT(layout.error().message, ::testing::HasSubstr("400 by 300"));
}

}  // namespace
}  // namespace stormcellar::render
