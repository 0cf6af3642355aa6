#include "cli/picture/scene_file.h"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "synth/synth_scene.h"
#include "tests/cli/scene_file_fixture.h"
#include "tests/testing/data.h"

namespace stormcellar::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST_F(SceneFileTest, AnEmptyFileChangesNothing) {
    ASSERT_TRUE(read(""));
    const auto scene = scene_of(settings_.scene);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->width, render::Scene{}.width);
    EXPECT_EQ(scene->product, render::Product::volume);
    EXPECT_FALSE(settings_.plan.asked());
    EXPECT_EQ(settings_.loop.last, 0);
}

TEST_F(SceneFileTest, EveryKeyOfAPictureReachesTheScene) {
    const Status status = read(
        "[picture]\nproduct = \"volume\"\nmoment = \"RHO\"\ncolours = \"safe-rho\"\n"
        "width = 640\nheight = 480\n"
        "[camera]\nazimuth_deg = 135\ntilt_deg = 120\nzoom = 2.5\nfield_of_view_deg = 35\n"
        "at_km = [-20, 5.5, 3]\n"
        "[light]\nkinds = [\"shadow\", \"gradient\"]\nsun_deg = [120, 30]\n"
        "[volume]\nslices = 64\nexaggeration = 4\nopacity = 0.5\ncurved_earth = true\nhaze = true\n"
        "[labels]\nshow = false\nring_spacing_km = 25\ntime_zone = \"America/Chicago\"\n"
        "units = [\"knots\", \"miles\", \"kft\"]\n");
    ASSERT_TRUE(status) << status.error().message;
    const auto scene = scene_of(settings_.scene);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->product, render::Product::volume);
    EXPECT_EQ(scene->moment, level2::Moment::rho);
    EXPECT_EQ(scene->colors->name, "safe-rho");
    EXPECT_EQ(scene->width, 640);
    EXPECT_EQ(scene->height, 480);
    EXPECT_EQ(scene->camera.azimuth_deg, 135);
    EXPECT_EQ(scene->camera.tilt_deg, 120);
    EXPECT_EQ(scene->camera.zoom, 2.5);
    EXPECT_EQ(scene->camera.field_of_view_deg, 35);
    EXPECT_EQ(scene->camera.eye->x_m, -20e3);
    EXPECT_EQ(scene->camera.eye->y_m, 5500);
    EXPECT_EQ(scene->camera.eye->height_m, 3000);
    EXPECT_TRUE(scene->light.gradient && scene->light.shadow && !scene->light.scattering);
    EXPECT_EQ(scene->light.sun_azimuth_deg, 120);
    EXPECT_EQ(scene->light.sun_elevation_deg, 30);
    EXPECT_EQ(scene->slices, 64);
    EXPECT_EQ(scene->vertical_exaggeration, 4);
    EXPECT_EQ(scene->opacity, 0.5);
    EXPECT_TRUE(scene->curved_earth);
    EXPECT_TRUE(scene->haze);
    EXPECT_EQ(render::unit_names(scene->units), "knots,miles,kft");
    EXPECT_FALSE(scene->labels);
    EXPECT_EQ(scene->range_ring_spacing_m, 25e3);
    EXPECT_EQ(settings_.scene.time_zone, "America/Chicago");
}

TEST_F(SceneFileTest, EveryKeyOfAFlatPictureReachesTheScene) {
    ASSERT_TRUE(read("[picture]\nproduct = \"section\"\nsection = [35, -98.5, 36.25, -97]\n"));
    const auto section = scene_of(settings_.scene);
    ASSERT_TRUE(section) << section.error().message;
    EXPECT_EQ(section->product, render::Product::section);
    EXPECT_EQ(section->section->from.longitude_deg, -98.5);
    EXPECT_EQ(section->section->to.latitude_deg, 36.25);
    settings_ = {};
    ASSERT_TRUE(read("[picture]\nproduct = \"cappi\"\nheight_km = 4.5\n[camera]\nzoom = 2\n"));
    const auto cappi = scene_of(settings_.scene);
    ASSERT_TRUE(cappi) << cappi.error().message;
    EXPECT_EQ(cappi->cappi_height_m, 4500);
    EXPECT_EQ(cappi->camera.zoom, 2);
    settings_ = {};
    ASSERT_TRUE(read("[picture]\nproduct = \"ppi\"\nmoment = \"VELD\"\nglyphs = true\n"));
    const auto sweep = scene_of(settings_.scene);
    ASSERT_TRUE(sweep) << sweep.error().message;
    EXPECT_TRUE(sweep->glyphs);
    settings_ = {};
    ASSERT_TRUE(read("[picture]\nproduct = \"echotop\"\necho_top_dbz = 30\n"));
    const auto tops = scene_of(settings_.scene);
    ASSERT_TRUE(tops) << tops.error().message;
    EXPECT_EQ(tops->echo_top_dbz, 30);
    settings_ = {};
    ASSERT_TRUE(read("[picture]\nproduct = \"posh\"\nfreezing_levels_m = [3900, 7000]\n"));
    const auto hail = scene_of(settings_.scene);
    ASSERT_TRUE(hail) << hail.error().message;
    EXPECT_EQ(hail->freezing_levels, (retrieve::FreezingLevels{3900, 7000}));
}

TEST_F(SceneFileTest, TheKeyDealiasDrawsTheDealiasedVelocity) {
    ASSERT_TRUE(read("[picture]\nmoment = \"VEL\"\ndealias = \"region\"\n"));
    EXPECT_EQ(settings_.scene.dealias, "region");
    const auto scene = scene_of(settings_.scene);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->moment, level2::Moment::veld);
    EXPECT_THAT(complaint("[picture]\nmoment = \"VEL\"\ndealias = \"strong\"\n"),
                HasSubstr("it must be off, auto, profile, region or anchored"));
}

TEST_F(SceneFileTest, EveryKeyOfPlanAndLoopIsTaken) {
    const Status status = read(
        "[plan]\ntolerance = \"dE 2\"\n[plan.effects]\nvalue_span = \"on\"\n"
        "[loop]\ndomain = \"northeast\"\nfrom = \"-3h\"\nto = \"now\"\nlast = 12\nframes = 90\nfps "
        "= 10\n"
        "dwell_s = 2\norbit_deg = 360\nping_pong = true\noutputs = [\"a.webp\", \"/b/c/\"]\n");
    ASSERT_TRUE(status) << status.error().message;
    EXPECT_EQ(settings_.plan.tolerance, "dE 2");
    EXPECT_THAT(settings_.plan.effects, ElementsAre("value_span=on"));
    const LoopSettings& loop = settings_.loop;
    EXPECT_EQ(loop.domain, "northeast");
    EXPECT_EQ(loop.range.from, "-3h");
    EXPECT_EQ(loop.range.to, "now");
    EXPECT_EQ(loop.last, 12);
    EXPECT_EQ(loop.frames, 90);
    EXPECT_EQ(loop.animation.frames_per_second, 10);
    EXPECT_EQ(loop.animation.last_frame_dwell_s, 2);
    EXPECT_EQ(loop.orbit_deg, 360);
    EXPECT_TRUE(loop.ping_pong);
    EXPECT_THAT(loop.outputs, ElementsAre(at("a.webp"), "/b/c/"));
}

TEST_F(SceneFileTest, ComplaintsNameFileLineAndKey) {
    EXPECT_EQ(complaint("[picture]\nprodukt = \"volume\"\n"),
              "s.toml:2: unknown key [picture] produkt");
    EXPECT_EQ(complaint("\n[pictures]\n"), "s.toml:2: unknown section [pictures]");
    EXPECT_EQ(complaint("[picture]\n\nwidth = \"wide\"\n"),
              "s.toml:3: [picture] width: must be a whole number, is text");
    EXPECT_EQ(complaint("[picture]\nwidth = 12\n"),
              "s.toml:2: [picture] width: 12 is out of range, must be 16 to 8192");
    EXPECT_EQ(complaint("[plan.effects]\nrays = \"on\"\nnone-such = \"on\"\n").substr(0, 9),
              "s.toml:2:");
    EXPECT_EQ(complaint("[loop\n").substr(0, 28), "s.toml:1: not valid TOML: Er");
}

TEST_F(SceneFileTest, EveryImpossibleValueIsRefusedOnItsLine) {
    const std::vector<std::pair<std::string, std::string>> wrong{
        {"picture", "product = \"hologram\""},
        {"picture", "product = 3"},
        {"picture", "product = \"\""},
        {"picture", "moment = \"DBZ\""},
        {"picture", "dealias = \"strong\""},
        {"picture", "dealias = true"},
        {"picture", "colours = \"none-such\""},
        {"picture", "colours = \"none-such.pal\""},
        {"picture", "height_km = 61"},
        {"picture", "section = [35, -98]"},
        {"picture", "section = [95, -98, 36, -97]"},
        {"picture", "section = \"35,-98,36,-97\""},
        {"picture", "echo_top_dbz = 81"},
        {"picture", "freezing_levels_m = [4200]"},
        {"picture", "freezing_levels_m = [4200, 99000]"},
        {"picture", "height = 8193"},
        {"camera", "azimuth_deg = inf"},
        {"camera", "tilt_deg = 181"},
        {"camera", "zoom = 0"},
        {"camera", "field_of_view_deg = 0.5"},
        {"camera", "field_of_view_deg = 151"},
        {"camera", "at_km = [1, 2]"},
        {"camera", "at_km = [1, 2, nan]"},
        {"camera", "look_at_km = [1, 2]"},
        {"light", "kinds = \"shadow\""},
        {"light", "kinds = [\"moonshine\"]"},
        {"light", "sun_deg = [225, 3]"},
        {"volume", "slices = 7"},
        {"volume", "slices = 64.5"},
        {"volume", "exaggeration = 0"},
        {"volume", "opacity = 1001"},
        {"volume", "curved_earth = \"yes\""},
        {"labels", "show = 1"},
        {"labels", "ring_spacing_km = 0.5"},
        {"labels", "units = [\"knot\"]"},
        {"labels", "units = \"knots\""},
        {"labels", "time_zone = \"Nowhere/Land\""},
        {"plan", "tolerance = \"much\""},
        {"plan", "effects = [\"value_span=on\"]"},
        {"plan.effects", "value_span = \"maybe\""},
        {"plan.effects", "value_span = true"},
        {"loop", "domain = \"a/b\""},
        {"loop", "from = \"yesterday\""},
        {"loop", "to = \"\""},
        {"loop", "last = 0"},
        {"loop", "frames = 0"},
        {"loop", "fps = 61"},
        {"loop", "dwell_s = -1"},
        {"loop", "orbit_deg = 3601"},
        {"loop", "ping_pong = \"on\""},
        {"loop", "outputs = \"a.webp\""},
        {"loop", "outputs = [\"\"]"},
        {"loop", "outputs = [\"a.webp\", \"a.xyz\"]"},
        {"loop", "outputs = [\"frames\"]"},
    };
    for (const auto& [section, line] : wrong) {
        const std::string key = line.substr(0, line.find(' '));
        EXPECT_THAT(complaint(fmt::format("[{}]\n{}\n", section, line)),
                    ::testing::StartsWith(fmt::format("s.toml:2: [{}] {}: ", section, key)))
            << line;
    }
    EXPECT_EQ(settings_.scene.scene.slices, render::Scene{}.slices)
        << "no setting of a wrong file is used";
    EXPECT_THAT(complaint("[loop]\noutputs = [\"a.xyz\"]\n"),
                HasSubstr("/a.xyz: the ending '.xyz' is not known; this build writes .webp, "));
}

TEST_F(SceneFileTest, PathsStartAtTheFile) {
    write(
        "unit = \"dBZ\"\n[[point]]\nvalue = 0\ncolour = \"#000000\"\n[[point]]\nvalue = 50\n"
        "colour = \"#ffffff\"\n",
        "mine.toml");
    ASSERT_TRUE(read("[picture]\ncolours = \"mine.toml\"\n"));
    EXPECT_EQ(settings_.scene.colors, at("mine.toml"));
    const auto scene = scene_of(settings_.scene);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->colors->name, "mine");
}

TEST_F(SceneFileTest, AnOlderKeyIsTakenToo) {
    for (const char* key : {"colors", "colours"}) {
        settings_ = {};
        ASSERT_TRUE(read(fmt::format("[picture]\n{} = \"safe-rho\"\nmoment = \"RHO\"\n", key)));
        EXPECT_EQ(scene_of(settings_.scene)->colors->name, "safe-rho");
        EXPECT_THAT(complaint(fmt::format("[picture]\n{} = \"none-such\"\n", key)),
                    HasSubstr(fmt::format("s.toml:2: [picture] {}: there is no color table", key)));
    }
    EXPECT_EQ(complaint("[picture]\ncolors = \"phi\"\ncolours = \"cfp\"\n"),
              "s.toml:3: [picture] colours: is the older name of colors; give only one of them");
}

// 2026-11-25: numbers of a file were printed and parsed again, which changed their last bits.
TEST_F(SceneFileTest, NumbersReachTheSceneToTheLastBit) {
    ASSERT_TRUE(
        read("[light]\nsun_deg = [0.1, 40.00000000000001]\n"
             "[camera]\nat_km = [1e-9, -0.30000000000000004, 3]\n"));
    const auto scene = scene_of(settings_.scene);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->light.sun_azimuth_deg, 0.1);
    EXPECT_EQ(scene->light.sun_elevation_deg, 40.00000000000001);
    EXPECT_EQ(scene->camera.eye->x_m, 1e-9 * 1e3);
    EXPECT_EQ(scene->camera.eye->y_m, -0.30000000000000004 * 1e3);
}

TEST_F(SceneFileTest, TheCommandLineWins) {
    const auto file = write(
        "[picture]\nwidth = 640\nheight = 480\n[camera]\nazimuth_deg = 90\n"
        "[volume]\ncurved_earth = true\n[loop]\nlast = 3\n");
    for (const char* order : {"--width 700 --curved-earth=false --scene {} --azimuth 180",
                              "--scene {} --azimuth 180 --curved-earth=false --width 700"}) {
        CLI::App app;
        SceneFile scene_file;
        AllSettings all;
        add_scene_file(app, scene_file, all.scene, all.plan, &all.loop);
        add_scene_options(app, all.scene);
        app.parse(fmt::format(fmt::runtime(order), file.string()));
        EXPECT_FALSE(scene_file.error);
        EXPECT_EQ(all.scene.scene.width, 700) << order;
        EXPECT_EQ(all.scene.scene.height, 480) << order;
        EXPECT_EQ(all.scene.scene.camera.azimuth_deg, 180)
            << "a typed value counts, even if it is the default";
        EXPECT_FALSE(all.scene.scene.curved_earth);
        EXPECT_EQ(all.loop.last, 3);
    }
}

TEST_F(SceneFileTest, FrameAndLoopDrawWhatItSays) {
    commit();
    const auto file =
        write(fmt::format("[picture]\nproduct = \"composite\"\nwidth = 500\n[loop]\n"
                          "domain = \"KBGM\"\noutputs = [\"a.webp\"]\n"));
    const auto frame = run(fmt::format("frame KBGM --cache {} --scene {} -o {} --json", cache(),
                                       file.string(), at("a.png")));
    EXPECT_EQ(frame.status, exit_done) << frame.err;
    EXPECT_THAT(frame.out, HasSubstr("\"product\": \"composite\""));
    EXPECT_THAT(frame.out, HasSubstr("\"width\": 500"));
    const auto loop =
        run(fmt::format("loop --cache {} --scene {} --width 450 --json", cache(), file.string()));
    EXPECT_EQ(loop.status, exit_done) << loop.err;
    EXPECT_THAT(loop.out, HasSubstr("\"product\": \"composite\""));
    EXPECT_THAT(loop.out, HasSubstr("\"width\": 450"));
    EXPECT_TRUE(fs::exists(directory_ / "a.webp")) << "the output that the file names";
}

TEST_F(SceneFileTest, TheOtherKindOfSceneIsNamed) {
    const fs::path scenes = testing::source_directory() / "scenes";
    const Status storms = read_scene_file(scenes / "small-storm.toml", settings_.scene,
                                          settings_.plan, settings_.loop);
    ASSERT_FALSE(storms);
    EXPECT_THAT(storms.error().message, HasSubstr("this is a simulated scene for stormcellar"));
    EXPECT_THAT(complaint("[[point]]\nvalue = 1\n"),
                HasSubstr("s.toml: this is a color table, which"));
    EXPECT_THAT(
        complaint("[paths]\ndrop = \"/d\"\n[[loop]]\nname = \"a\"\n"),
        HasSubstr(
            "s.toml: this is a configuration of stormcellard; a picture scene has [picture]"));
    const auto picture = synth::read_scene(scenes / "picture-section.toml");
    ASSERT_FALSE(picture);
    EXPECT_THAT(picture.error().message, HasSubstr("this is a picture scene ([picture])"));
}

TEST_F(SceneFileTest, KeysOfTheCameraReachTheLoop) {
    const Status status = read(
        "[[loop.camera]]\ntime_s = 0\nazimuth_deg = 180\nzoom = 2\n"
        "[[loop.camera]]\ntime_s = 2.5\nazimuth_deg = 90\ntilt_deg = 70\nturns = 1\n");
    ASSERT_TRUE(status) << status.error().message;
    const auto& keys = settings_.loop.camera;
    ASSERT_EQ(keys.size(), 2U);
    EXPECT_EQ(keys[0].zoom, 2);
    EXPECT_EQ(keys[1].time_s, 2.5);
    EXPECT_EQ(keys[1].azimuth_deg, 90);
    EXPECT_EQ(keys[1].tilt_deg, 70);
    EXPECT_EQ(keys[1].turns, 1);
    EXPECT_FALSE(keys[1].eye);
    ASSERT_TRUE(
        read("[[loop.camera]]\ntime_s = 0\nat_km = [1, 2, 3]\n"
             "[[loop.camera]]\ntime_s = 1\nat_km = [-1, 2, 3]\n"));
    EXPECT_EQ(settings_.loop.camera[1].eye->x_m, -1000);
}

TEST_F(SceneFileTest, KeysOfTheCameraThatMakeNoSenseAreRefused) {
    EXPECT_THAT(complaint("[[loop.camera]]\ntime_s = 0\n"), HasSubstr("two keys"));
    EXPECT_THAT(complaint("[[loop.camera]]\ntime_s = 0\n[[loop.camera]]\nzoom = 2\n"),
                HasSubstr("time_s: is missing"));
    EXPECT_THAT(complaint("[[loop.camera]]\ntime_s = 0\n[[loop.camera]]\ntime_s = 0\n"),
                HasSubstr("key 2"));
    EXPECT_THAT(complaint("[[loop.camera]]\ntime_s = 0\nzom = 3\n[[loop.camera]]\ntime_s = 1\n"),
                HasSubstr("zom"));
    EXPECT_THAT(complaint("[[loop.camera]]\ntime_s = 0\nat_km = [1, 2]\n"),
                HasSubstr("[loop.camera] at_km: must be [east, north, up]"));
}

TEST_F(SceneFileTest, TheShippedFlightDraws) {
    commit();
    const fs::path scene = testing::source_directory() / "scenes" / "fly-supercell.toml";
    const auto ran = run(fmt::format(
        "loop KBGM --cache {} --scene {} --frames 3 --width 400 --height 300 --slices 16 -o {}",
        cache(), scene.string(), at("fly/")));
    EXPECT_EQ(ran.status, exit_done) << ran.err;
    EXPECT_TRUE(fs::exists(directory_ / "fly" / "frame_0002.png"));
}

TEST_F(SceneFileTest, ShippedScenesDraw) {
    commit();
    const fs::path scenes = testing::source_directory() / "scenes";
    std::size_t found = 0;
    for (const auto& entry : fs::directory_iterator(scenes)) {
        const std::string name = entry.path().filename();
        if (!name.starts_with("picture-")) continue;
        ++found;
        // The section of the shipped file is in Oklahoma.
        const std::string where =
            name == "picture-section.toml" ? " --section 42,-76.1,42.3,-75.8" : "";
        const auto ran = run(fmt::format("frame KBGM --cache {} --scene {} -o {}{}", cache(),
                                         entry.path().string(), at(name + ".png"), where));
        EXPECT_EQ(ran.status, exit_done) << name << ": " << ran.err;
        EXPECT_GT(fs::file_size(directory_ / (name + ".png")), 20'000U) << name;
    }
    EXPECT_EQ(found, 4U);
}

}  // namespace
}  // namespace stormcellar::cli
