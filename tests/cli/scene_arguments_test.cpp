#include "cli/picture/scene_arguments.h"

#include <sstream>
#include <tuple>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stormcellar::cli {
namespace {

SceneOptions parse(const std::string& arguments) {
    SceneOptions options;
    CLI::App app;
    add_scene_options(app, options);
    app.parse(arguments);
    return options;
}

TEST(SceneOptions, NothingGivenIsTheDefaultScene) {
    const auto scene = scene_of(parse(""));
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->width, render::Scene{}.width);
    EXPECT_EQ(scene->product, render::Product::volume);
    EXPECT_EQ(scene->range_ring_spacing_m, render::Scene{}.range_ring_spacing_m);
    EXPECT_TRUE(scene->labels);
}

TEST(SceneOptions, EveryOptionReachesTheScene) {
    const auto scene = scene_of(parse(
        "--product volume --moment VEL --width 640 --height 480 --azimuth 135 --tilt 20 --zoom 2.5 "
        "--slices 64 --exaggeration 4 --opacity 0.5 --ring-spacing-km 25 --no-labels"));
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->product, render::Product::volume);
    EXPECT_EQ(scene->moment, level2::Moment::vel);
    EXPECT_EQ(scene->width, 640);
    EXPECT_EQ(scene->height, 480);
    EXPECT_EQ(scene->camera.azimuth_deg, 135);
    EXPECT_EQ(scene->camera.tilt_deg, 20);
    EXPECT_EQ(scene->camera.zoom, 2.5);
    EXPECT_EQ(scene->slices, 64);
    EXPECT_EQ(scene->vertical_exaggeration, 4);
    EXPECT_EQ(scene->opacity, 0.5);
    EXPECT_EQ(scene->range_ring_spacing_m, 25e3);
    EXPECT_FALSE(scene->labels);
}

TEST(SceneOptions, ProductsHaveOptionsOfTheirOwn) {
    const auto scene = scene_of(
        parse("--product section --section 35,-98.5,36,-97 --moment RHO --colours safe-rho"));
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->product, render::Product::section);
    EXPECT_EQ(scene->moment, level2::Moment::rho);
    EXPECT_EQ(scene->colors->name, "safe-rho");
    EXPECT_EQ(scene->section->from.longitude_deg, -98.5);
    EXPECT_EQ(scene->section->to.latitude_deg, 36);
    EXPECT_EQ(scene_of(parse("--product cappi --height-km 4.5"))->cappi_height_m, 4500);
    EXPECT_EQ(scene_of(parse("--product echotop --echo-top-dbz 30"))->echo_top_dbz, 30);
    EXPECT_EQ(scene_of(parse("--product mesh --freezing-levels 3900,7000"))->freezing_levels,
              (retrieve::FreezingLevels{3900, 7000}));
    EXPECT_EQ(scene_of(parse("--product composite --zoom 2"))->camera.zoom, 2);
}

TEST(SceneOptions, AnOlderSpellingIsTakenAndNotShown) {
    for (const char* spelling : {"--colors", "--colours"}) {
        const auto scene = scene_of(parse(fmt::format("{} safe-reflectivity", spelling)));
        ASSERT_TRUE(scene) << scene.error().message;
        EXPECT_EQ(scene->colors->name, "safe-reflectivity");
        EXPECT_THAT(scene_of(parse(fmt::format("{} none-such", spelling))).error().message,
                    ::testing::StartsWith(fmt::format("{}: there is no color table", spelling)));
    }
    EXPECT_EQ(scene_of(parse("--colours phi --colors cfp")).error().message,
              "--colours: is the older name of --colors; give only one of them");
    SceneOptions options;
    CLI::App app;
    add_scene_options(app, options);
    EXPECT_THAT(app.help(), ::testing::HasSubstr("--colors"));
    EXPECT_THAT(app.help(), ::testing::Not(::testing::HasSubstr("--colours")));
}

// The help has the ranges and the allowed words from the table, so a changed row changes the help.
TEST(SceneOptions, HelpSaysTheRangesOfTheTable) {
    for (const PictureOption& row : render::picture_options())
        EXPECT_THAT(help_of(row), ::testing::Not(::testing::HasSubstr("{"))) << row.option;
    EXPECT_EQ(help_of(render::slices_option()), "Number of slices through the volume, 8 to 4096");
    SceneOptions options;
    CLI::App app;
    add_scene_options(app, options);
    EXPECT_THAT(app.help(),
                ::testing::HasSubstr("REF, VEL, SW, ZDR, PHI, RHO, CFP, VELD, SRV, AZSH, "
                                     "DIVG, POW, KDP, RATE or HCA"));
}

TEST(SceneOptions, AProductOfOneMomentChoosesIt) {
    EXPECT_EQ(scene_of(parse("--product rotation"))->moment, level2::Moment::azsh);
    EXPECT_EQ(scene_of(parse("--product vil"))->moment, level2::Moment::ref);
    EXPECT_EQ(scene_of(parse("--product rotation --moment REF")).error().message,
              "rotation is made from AZSH, not from REF");
}

// 2026-11-22: `--light shadow` with a composite was ignored without a message.
TEST(SceneOptions, WhatAProductDoesNotUseIsRefused) {
    const std::string all = "volume composite cappi section echotop vil lowest-seen highest-seen";
    const std::string flat = " composite cappi section echotop vil lowest-seen highest-seen";
    const std::string but_cappi = " volume composite section echotop vil lowest-seen highest-seen";
    const std::string but_section = " volume composite cappi echotop vil lowest-seen highest-seen";
    const std::string but_tops = " volume composite cappi section vil lowest-seen highest-seen";
    for (const auto& [option, value, refused_by] :
         {std::tuple{"--height-km", " 4", but_cappi},
          {"--section", " 35,-98.5,36,-97", but_section},
          {"--echo-top-dbz", " 30", but_tops},
          {"--freezing-levels", " 3900,7000", " " + all},
          {"--glyphs", "", " " + all},
          {"--azimuth", " 180", flat},
          {"--tilt", " 50", flat},
          {"--zoom", " 2", std::string(" section")},
          {"--field-of-view", " 35", flat},
          {"--camera-km", " 1,2,3", flat},
          {"--light", " none", flat},
          {"--sun", " 120,30", flat},
          {"--haze", "", flat},
          {"--curved-earth", "=false", flat},
          {"--slices", " 64", flat},
          {"--exaggeration", " 4", flat},
          {"--opacity", " 2", flat},
          {"--ring-spacing-km", " 25", std::string(" section")},
          {"--width", " 500", std::string()},
          {"--moment", " REF", std::string()},
          {"--no-labels", "", std::string()}}) {
        std::istringstream products(all);
        for (std::string product; products >> product;) {
            std::string line = "--product " + product + " " + option + value;
            if (product == "section" && std::string(option) != "--section") {
                line += " --section 35,-98.5,36,-97";
            }
            const auto scene = scene_of(parse(line));
            const bool is_refused = refused_by.find(" " + product) != std::string::npos;
            ASSERT_EQ(!scene, is_refused) << line;
            if (!is_refused) continue;
            EXPECT_EQ(scene.error().code, ErrorCode::bad_argument);
            EXPECT_THAT(scene.error().message, ::testing::StartsWith(option));
            EXPECT_THAT(scene.error().message, ::testing::EndsWith(product + " does not use it"));
        }
    }
    EXPECT_EQ(scene_of(parse("--product composite --slices 64")).error().message,
              "--slices is for volume; composite does not use it");
}

TEST(SceneOptions, ACameraMayStandAnywhere) {
    const auto scene = scene_of(parse("--camera-km -20,5.5,3 --tilt 120 --curved-earth"));
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_TRUE(scene->camera.eye);
    EXPECT_EQ(scene->camera.eye->x_m, -20e3);
    EXPECT_EQ(scene->camera.eye->y_m, 5500);
    EXPECT_EQ(scene->camera.eye->height_m, 3000);
    EXPECT_EQ(scene->camera.field_of_view_deg, 60)
        << "a camera with a position needs a field of view";
    EXPECT_TRUE(scene->curved_earth);
    EXPECT_EQ(scene_of(parse("--camera-km 1,2,3 --field-of-view 35"))->camera.field_of_view_deg,
              35);
    EXPECT_FALSE(scene_of(parse("--camera-km 1,2")));
    EXPECT_FALSE(scene_of(parse("--field-of-view 170")));
    EXPECT_FALSE(scene_of(parse("--tilt 120"))) << "the camera has no position, so --tilt is used";
    EXPECT_FALSE(scene_of(parse("--time-zone Nowhere/Land")));
}

TEST(SceneOptions, LightIsOffUnlessAskedFor) {
    EXPECT_FALSE(scene_of(parse(""))->light.any());
    const auto scene = scene_of(parse("--light shadow,gradient --sun 120,30"));
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_TRUE(scene->light.shadow && scene->light.gradient && !scene->light.scattering);
    EXPECT_EQ(scene->light.sun_azimuth_deg, 120);
    EXPECT_EQ(scene->light.sun_elevation_deg, 30);
    EXPECT_FALSE(scene_of(parse("--light dim")));
    EXPECT_FALSE(scene_of(parse("--sun 120,2")));
    EXPECT_FALSE(scene_of(parse("--sun 120")));
}

TEST(SceneOptions, NonsenseIsBadArgument) {
    for (const char* arguments :
         {"--product x", "--tilt 91", "--width 1", "--threads -1", "--moment refl", "--colours x",
          "--product section --section 1,2,3", "--product cappi --height-km 99"}) {
        const auto scene = scene_of(parse(arguments));
        ASSERT_FALSE(scene) << arguments;
        EXPECT_EQ(scene.error().code, ErrorCode::bad_argument);
    }
}

TEST(SceneOptions, AMomentMayBeInLowerCase) {
    const auto scene = scene_of(parse("--moment vel"));
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->moment, level2::Moment::vel);
}

TEST(SceneOptions, AStormMotionIsForTheStormRelativeVelocity) {
    const SceneOptions options = parse("--moment SRV --storm-motion 240/15");
    const auto scene = scene_of(options);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->moment, level2::Moment::srv);
    EXPECT_EQ(options.storm_motion, "240/15");
    EXPECT_EQ(scene_of(parse("--moment SRV --dealias region"))->moment, level2::Moment::srv);
    EXPECT_TRUE(scene_of(parse("--storm-motion auto")));
    EXPECT_EQ(scene_of(parse("--moment VEL --storm-motion left")).error().message,
              "--storm-motion is for the storm-relative velocity, SRV; the moment is VEL");
    EXPECT_THAT(scene_of(parse("--moment SRV --storm-motion fast")).error().message,
                ::testing::HasSubstr("'fast' is no storm motion; it must be auto, right, left"));
}

TEST(SceneOptions, FreezingLevelsAreForHailAndForClassesOfHydrometeors) {
    const auto scene = scene_of(parse("--product ppi --moment HCA --freezing-levels 3000,6000"));
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->freezing_levels.zero_c_m, 3000);
    EXPECT_THAT(scene_of(parse("--product ppi --freezing-levels 3000,6000")).error().message,
                ::testing::EndsWith(", for the moment HCA and beside an overlay of cells; ppi does "
                                    "not use it"));
    // Kept grids have their classes already, but a ppi is made from a raw file.
    SceneOptions kept = parse("--product ppi --moment HCA --freezing-levels 3000,6000");
    EXPECT_TRUE(check_stored_derivation(kept, render::Product::ppi));
    EXPECT_THAT(check_stored_derivation(kept, render::Product::composite).error().message,
                ::testing::HasSubstr("--freezing-levels of HCA is for frames of files"));
}

TEST(SceneOptions, DealiasDrawsTheDealiasedVelocity) {
    using level2::Moment;
    EXPECT_EQ(scene_of(parse("--moment VEL"))->moment, Moment::vel);
    EXPECT_EQ(scene_of(parse("--moment VEL --dealias off"))->moment, Moment::vel);
    EXPECT_EQ(scene_of(parse("--moment REF --dealias off"))->moment, Moment::ref);
    EXPECT_EQ(scene_of(parse("--moment VELD"))->moment, Moment::veld);
    for (const char* rung : {"auto", "profile", "region", "anchored"}) {
        const std::string dealias = std::string(" --dealias ") + rung;
        EXPECT_EQ(scene_of(parse("--moment VEL" + dealias))->moment, Moment::veld);
        EXPECT_EQ(scene_of(parse("--moment VELD" + dealias))->moment, Moment::veld);
        const auto refused = scene_of(parse("--moment REF" + dealias));
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
        EXPECT_EQ(refused.error().message, "--dealias is for velocity; the moment is REF");
    }
    const auto unknown = scene_of(parse("--moment VEL --dealias strong"));
    ASSERT_FALSE(unknown);
    EXPECT_THAT(unknown.error().message,
                ::testing::HasSubstr("'strong' is no way to dealias; it must be off, auto, "
                                     "profile, region or anchored"));
}

// 2026-11-25: a message about a number did not name the option of the number.
TEST(SceneOptions, AnOptionOutOfItsRangeIsNamed) {
    const std::vector<std::pair<const char*, const char*>> said = {
        {"--tilt 120", "--tilt must be 0 to 90, not 120"},
        {"--camera-km 0,0,5 --tilt 181", "--tilt must be 0 to 180, not 181"},
        {"--width 1", "--width must be 16 to 8192, not 1"},
        {"--threads -1", "--threads must be 0 to 1024, not -1"},
        {"--field-of-view 0.5", "--field-of-view must be 1 to 150, or 0, not 0.5"},
        {"--ring-spacing-km 0.1", "--ring-spacing-km must be 1 to 1000, not 0.1"},
        {"--sun 120,2", "--sun: elevation must be 5 to 90, not 2"},
        {"--product section --section 95,1,2,3", "--section: latitude must be -90 to 90, not 95"},
    };
    for (const auto& [arguments, message] : said) {
        const auto scene = scene_of(parse(arguments));
        ASSERT_FALSE(scene) << arguments;
        EXPECT_EQ(scene.error().message, message);
        EXPECT_EQ(scene.error().code, ErrorCode::bad_argument);
    }
}

cache::GridDescription description() {
    cache::GridDescription grid;
    grid.time = parse_compact("19990503_235621").value();
    grid.end_time = grid.time + std::chrono::minutes(5);
    grid.sites = {{"KTLX", 35.3, -97.3, 389}};
    grid.provenance.partial = true;
    grid.provenance.radar_troubles = {"KTLX: on auxiliary power"};
    grid.provenance.left_out = {"north (KFWS): nothing since 22:05"};
    return grid;
}

TEST(FactsOf, SaysWhatTheGridSays) {
    const auto facts = frame_facts_of("plains", description(), "America/Chicago");
    EXPECT_EQ(facts.domain, "plains");
    EXPECT_EQ(facts.sites.at(0).icao, "KTLX");
    EXPECT_TRUE(facts.partial);
    EXPECT_EQ(facts.local_time, "1999-05-03 18:56:21 CDT");
    EXPECT_THAT(facts.radar_troubles, ::testing::ElementsAre("KTLX: on auxiliary power"));
    EXPECT_EQ(facts.left_out, description().provenance.left_out);
    EXPECT_FALSE(facts.antenna_to_picture) << "the volume is old";
}

TEST(FactsOf, TheStormMotionIsThatOfTheGridsNotes) {
    cache::GridDescription grid = description();
    grid.provenance.notes = {"KTLX: storm motion 240/15, right mover of the wind profile"};
    EXPECT_FALSE(frame_facts_of("plains", grid, "UTC").storm_motion) << "the moment is REF";
    grid.moment = level2::Moment::srv;
    const auto motion = frame_facts_of("plains", grid, "UTC").storm_motion;
    ASSERT_TRUE(motion);
    EXPECT_EQ(retrieve::format_motion(*motion), "240/15");
}

TEST(FactsOf, UtcIsSaidOnceAndANameThatIsNoZoneNotAtAll) {
    EXPECT_EQ(frame_facts_of("plains", description(), "Etc/UTC").local_time, "");
    EXPECT_EQ(frame_facts_of("plains", description(), "Nowhere/Land").local_time, "");
}

TEST(FactsOf, TheAgeOfTheNewestRadialWhileItIsNews) {
    const auto age_at = [](std::chrono::milliseconds later) {
        const auto grid = description();
        return frame_facts_of("plains", grid, "UTC", grid.end_time + later).antenna_to_picture;
    };
    EXPECT_EQ(age_at(std::chrono::milliseconds(192'999)), std::chrono::seconds(192));
    EXPECT_EQ(age_at(std::chrono::milliseconds(0)), std::chrono::seconds(0));
    EXPECT_EQ(age_at(std::chrono::milliseconds(3'599'999)), std::chrono::seconds(3599));
    EXPECT_FALSE(age_at(std::chrono::hours(1)));
    EXPECT_FALSE(age_at(std::chrono::milliseconds(-1)))
        << "a negative age, from a clock that is late";
}

TEST(SceneOptions, ThreadsDefaultToTheMachines) {
    EXPECT_GE(thread_count(parse("")), 1);
    EXPECT_EQ(thread_count(parse("--threads 3")), 3);
}

}  // namespace
}  // namespace stormcellar::cli
