#include "cli/scene_file.h"

#include <fstream>
#include <functional>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/file_system.h"
#include "cache/store.h"
#include "cli/commands.h"
#include "grid/brick_grid.h"
#include "synth/scene.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct AllSettings {
    SceneOptions scene;
    PicturePlanOptions plan;
    LoopSettings loop;
};

class SceneFileTest : public ::testing::Test {
  protected:
    fs::path write(const std::string& text, const std::string& name = "s.toml") {
        std::ofstream(directory_ / name) << text;
        return directory_ / name;
    }
    Status read(const std::string& text) {
        return read_scene_file(write(text), settings_.scene, settings_.plan, settings_.loop);
    }
    // The message without the directory, which differs in each run.
    std::string complaint(const std::string& text) {
        const Status status = read(text);
        if (status) return "no complaint";
        EXPECT_EQ(status.error().code, ErrorCode::bad_argument);
        const std::string directory = directory_.path().native() + "/";
        EXPECT_TRUE(status.error().message.starts_with(directory)) << status.error().message;
        return status.error().message.substr(directory.size());
    }
    // A grid of REF about KBGM, and one of a domain of two sites.
    void commit() {
        const auto store =
            cache::Store::open_for_writing(real_file_system(), directory_ / "cache", true);
        ASSERT_TRUE(store) << store.error().message;
        grid::Grid grid;
        grid.spec = grid::default_spec(42.2, -75.98);
        grid.spec.nx = grid.spec.ny = 40;
        grid.time = parse_compact("20050822_024400").value();
        grid.sites = {{"KBGM", 42.2, -75.98, 490}};
        grid.values.assign(grid.spec.cell_count(), 33);
        grid.status.assign(grid.spec.cell_count(), grid::CellStatus::value);
        const auto bricks =
            grid::BrickGrid::from(grid, grid::default_quantization(level2::Moment::ref));
        const auto path = store->commit("KBGM", cache::describe(grid), bricks.view());
        ASSERT_TRUE(path) << path.error().message;
    }
    struct Ran {
        int status = -1;
        std::string out, err;
    };
    Ran run(Command (*add)(CLI::App&), const std::string& arguments) {
        CLI::App app;
        const Command command = add(app);
        app.parse(arguments);
        ::testing::internal::CaptureStderr();
        ::testing::internal::CaptureStdout();
        Ran ran;
        ran.status = command.run();
        ran.out = ::testing::internal::GetCapturedStdout();
        ran.err = ::testing::internal::GetCapturedStderr();
        return ran;
    }
    [[nodiscard]] std::string cache() const { return (directory_ / "cache").string(); }
    [[nodiscard]] std::string at(const std::string& name) const {
        return (directory_ / name).string();
    }

    testing::TemporaryDirectory directory_;
    AllSettings settings_;
};

TEST_F(SceneFileTest, AnEmptyFileChangesNothing) {
    ASSERT_TRUE(read(""));
    const auto scene = scene_of(settings_.scene);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->width, render::Scene{}.width);
    EXPECT_EQ(scene->product, render::Product::volume);
    EXPECT_FALSE(settings_.plan.asked());
    EXPECT_EQ(settings_.loop.last, 0U);
}

TEST_F(SceneFileTest, EveryKeyOfAPictureReachesTheScene) {
    const Status status = read(
        "[picture]\nproduct = \"volume\"\nmoment = \"RHO\"\ncolours = \"safe-rho\"\n"
        "width = 640\nheight = 480\n"
        "[camera]\nazimuth_deg = 135\ntilt_deg = 120\nzoom = 2.5\nfield_of_view_deg = 35\n"
        "at_km = [-20, 5.5, 3]\n"
        "[light]\nkinds = [\"shadow\", \"gradient\"]\nsun_deg = [120, 30]\n"
        "[volume]\nslices = 64\nexaggeration = 4\nopacity = 0.5\ncurved_earth = true\nhaze = true\n"
        "[labels]\nshow = false\nring_spacing_km = 25\ntime_zone = \"America/Chicago\"\n");
    ASSERT_TRUE(status) << status.error().message;
    const auto scene = scene_of(settings_.scene);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->product, render::Product::volume);
    EXPECT_EQ(scene->moment, level2::Moment::rho);
    EXPECT_EQ(scene->colours->name, "safe-rho");
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
    ASSERT_TRUE(read("[picture]\nproduct = \"echotop\"\necho_top_dbz = 30\n"));
    const auto tops = scene_of(settings_.scene);
    ASSERT_TRUE(tops) << tops.error().message;
    EXPECT_EQ(tops->echo_top_dbz, 30);
}

TEST_F(SceneFileTest, EveryKeyOfPlanAndLoopIsTaken) {
    const Status status = read(
        "[plan]\ntolerance = \"dE 2\"\n[plan.effects]\nvalue_span = \"on\"\n"
        "[loop]\ndomain = \"northeast\"\nfrom = \"-3h\"\nto = \"now\"\nlast = 12\nfps = 10\n"
        "dwell_s = 2\norbit_deg = 360\nping_pong = true\noutputs = [\"a.webp\", \"/b/c/\"]\n");
    ASSERT_TRUE(status) << status.error().message;
    EXPECT_EQ(settings_.plan.tolerance, "dE 2");
    EXPECT_THAT(settings_.plan.effects, ElementsAre("value_span=on"));
    const LoopSettings& loop = settings_.loop;
    EXPECT_EQ(loop.domain, "northeast");
    EXPECT_EQ(loop.range.from, "-3h");
    EXPECT_EQ(loop.range.to, "now");
    EXPECT_EQ(loop.last, 12U);
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
        {"picture", "colours = \"none-such\""},
        {"picture", "colours = \"none-such.pal\""},
        {"picture", "height_km = 61"},
        {"picture", "section = [35, -98]"},
        {"picture", "section = [95, -98, 36, -97]"},
        {"picture", "section = \"35,-98,36,-97\""},
        {"picture", "echo_top_dbz = 81"},
        {"picture", "height = 8193"},
        {"camera", "azimuth_deg = inf"},
        {"camera", "tilt_deg = 181"},
        {"camera", "zoom = 0"},
        {"camera", "field_of_view_deg = 0.5"},
        {"camera", "field_of_view_deg = 151"},
        {"camera", "at_km = [1, 2]"},
        {"camera", "at_km = [1, 2, nan]"},
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
        {"labels", "time_zone = \"Nowhere/Land\""},
        {"plan", "tolerance = \"much\""},
        {"plan", "effects = [\"value_span=on\"]"},
        {"plan.effects", "value_span = \"maybe\""},
        {"plan.effects", "value_span = true"},
        {"loop", "domain = \"a/b\""},
        {"loop", "from = \"yesterday\""},
        {"loop", "to = \"\""},
        {"loop", "last = 0"},
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
    EXPECT_EQ(settings_.scene.scene.slices, render::Scene{}.slices) << "nothing was taken";
    EXPECT_THAT(complaint("[loop]\noutputs = [\"a.xyz\"]\n"),
                HasSubstr("/a.xyz: unknown ending '.xyz'; this build writes .webp, "));
}

TEST_F(SceneFileTest, PathsStartAtTheFile) {
    write(
        "unit = \"dBZ\"\n[[point]]\nvalue = 0\ncolour = \"#000000\"\n[[point]]\nvalue = 50\n"
        "colour = \"#ffffff\"\n",
        "mine.toml");
    ASSERT_TRUE(read("[picture]\ncolours = \"mine.toml\"\n"));
    EXPECT_EQ(settings_.scene.colours, at("mine.toml"));
    const auto scene = scene_of(settings_.scene);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->colours->name, "mine");
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
        EXPECT_EQ(all.scene.scene.camera.azimuth_deg, 180) << "given, though it is the default";
        EXPECT_FALSE(all.scene.scene.curved_earth);
        EXPECT_EQ(all.loop.last, 3U);
    }
}

TEST_F(SceneFileTest, FrameAndLoopDrawWhatItSays) {
    commit();
    const auto file =
        write(fmt::format("[picture]\nproduct = \"composite\"\nwidth = 500\n[loop]\n"
                          "domain = \"KBGM\"\noutputs = [\"a.webp\"]\n"));
    const auto frame = run(add_frame, fmt::format("frame KBGM --cache {} --scene {} -o {} --json",
                                                  cache(), file.string(), at("a.png")));
    EXPECT_EQ(frame.status, exit_done) << frame.err;
    EXPECT_THAT(frame.out, HasSubstr("\"product\": \"composite\""));
    EXPECT_THAT(frame.out, HasSubstr("\"width\": 500"));
    const auto loop = run(add_loop, fmt::format("loop --cache {} --scene {} --width 450 --json",
                                                cache(), file.string()));
    EXPECT_EQ(loop.status, exit_done) << loop.err;
    EXPECT_THAT(loop.out, HasSubstr("\"product\": \"composite\""));
    EXPECT_THAT(loop.out, HasSubstr("\"width\": 450"));
    EXPECT_TRUE(fs::exists(directory_ / "a.webp")) << "the output that the file names";
}

TEST_F(SceneFileTest, WhatIsWrongIsSaidBeforeWhatIsMissing) {
    const auto file = write("[loop]\nfps = 100\n");
    for (const auto& [add, name] : {std::pair{&add_frame, "frame"}, std::pair{&add_loop, "loop"}}) {
        const auto ran = run(add, fmt::format("{} --cache x --scene {}", name, file.string()));
        EXPECT_EQ(ran.status, exit_bad_usage);
        EXPECT_THAT(ran.err, HasSubstr("s.toml:2: [loop] fps: 100 is out of range"));
        const auto absent = run(add, fmt::format("{} --cache x --scene {}", name, at("absent")));
        EXPECT_EQ(absent.status, exit_failed);
        EXPECT_THAT(absent.err, HasSubstr("absent: No such file"));
    }
}

TEST_F(SceneFileTest, WhatMakesNoSenseTogetherNamesTheFile) {
    commit();
    const auto said = [&](Command (*add)(CLI::App&), const std::string& arguments) {
        const auto ran = run(
            add, fmt::format("{} KBGM --cache {} --scene {}", arguments, cache(), at("s.toml")));
        EXPECT_EQ(ran.status, exit_bad_usage) << ran.err;
        return ran.err;
    };
    const std::string frame = "frame -o " + at("a.png");
    const std::string loop = "loop -o " + at("a.webp");
    write("[camera]\ntilt_deg = 120\n");
    const std::string tilted = at("s.toml") + ": tilt must be 0 to 90, not 120";
    EXPECT_THAT(said(add_frame, frame), HasSubstr(tilted));
    EXPECT_THAT(said(add_loop, loop), HasSubstr(tilted));
    EXPECT_THAT(said(add_frame, frame + " --width 500"), HasSubstr(tilted));
    EXPECT_THAT(said(add_frame, frame + " --tilt 100"),
                HasSubstr("tilt must be 0 to 90, not 100 (beside --scene " + at("s.toml") + ")"));
    write("[picture]\nproduct = \"section\"\n");
    EXPECT_THAT(said(add_frame, frame), HasSubstr(at("s.toml") + ": a section needs its two ends"));
    const auto mended =
        run(add_frame, fmt::format("{} KBGM --cache {} --scene {} --section 42,-76.1,42.3,-75.8",
                                   frame, cache(), at("s.toml")));
    EXPECT_EQ(mended.status, exit_done) << mended.err;
}

TEST_F(SceneFileTest, APlanIsLeftOutForAProductThatWasTyped) {
    commit();
    const auto draw = [&](const std::string& more) {
        return run(add_frame, fmt::format("frame KBGM --cache {} --scene {} -o {} {}", cache(),
                                          at("s.toml"), at("a.png"), more));
    };
    const std::string plan = "[plan]\ntolerance = \"dE 9\"\n[plan.effects]\nevery_pixel = \"on\"\n";
    write(plan);
    const auto typed = draw("--product composite");
    EXPECT_EQ(typed.status, exit_done) << typed.err;
    for (const char* more : {"--tolerance \"dE 5\"", "--explain", "--effect=every_pixel=off"}) {
        const auto both = draw(std::string("--product composite ") + more);
        EXPECT_EQ(both.status, exit_bad_usage) << more;
        EXPECT_THAT(both.err, HasSubstr("--tolerance, --effect and --explain are for volumes"));
    }
    write("[picture]\nproduct = \"composite\"\n" + plan);
    const auto within = draw("");
    EXPECT_EQ(within.status, exit_bad_usage);
    EXPECT_THAT(within.err,
                HasSubstr(at("s.toml") + ": [plan] is for volumes: composite is drawn"));
    EXPECT_EQ(draw("--product volume").status, exit_done) << "now the plan has something to say";
}

// 2026-11-22: keys that the picture did not use were dropped without a word.
TEST_F(SceneFileTest, KeysAreLeftOutForAProductThatWasTyped) {
    commit();
    const auto draw = [&](const std::string& more) {
        return run(add_frame, fmt::format("frame KBGM --cache {} --scene {} -o {} {}", cache(),
                                          at("s.toml"), at("a.png"), more));
    };
    const std::string keys =
        "[camera]\ntilt_deg = 40\n[light]\nkinds = [\"shadow\"]\n[volume]\nslices = 16\n"
        "[labels]\nring_spacing_km = 20\n[loop]\norbit_deg = 90\n";
    write(keys);
    for (const char* product : {"composite", "vil", "section --section 42,-76.1,42.3,-75.8"}) {
        const auto typed = draw(fmt::format("--product {}", product));
        EXPECT_EQ(typed.status, exit_done) << typed.err;
    }
    const auto both = draw("--product composite --opacity 2");
    EXPECT_EQ(both.status, exit_bad_usage);
    EXPECT_THAT(both.err, HasSubstr("--opacity is for volume: composite does not use it (beside "));
    write("[picture]\nproduct = \"composite\"\n" + keys);
    for (const char* more : {"", "--product vil"}) {
        const auto within = draw(more);
        EXPECT_EQ(within.status, exit_bad_usage) << "the file is no good for its own product";
        EXPECT_THAT(within.err, HasSubstr("[camera] tilt_deg is for volume: "));
        EXPECT_THAT(within.err, HasSubstr(at("s.toml")));
    }
    EXPECT_EQ(draw("--product volume").status, exit_done) << "now they have something to say";
}

// 2026-11-22: the number of slices was dropped beside a tolerance, and rounded by --explain.
TEST_F(SceneFileTest, SlicesAndWhatChoosesThemExcludeEachOther) {
    commit();
    const auto draw = [&](const std::string& more) {
        return run(add_frame, fmt::format("frame KBGM --cache {} --width 400 --height 300 -o {} {}",
                                          cache(), at("a.png"), more));
    };
    const auto refused = [&](const std::string& more) {
        const auto ran = draw(more);
        EXPECT_EQ(ran.status, exit_bad_usage) << more;
        return ran.err;
    };
    // The picture says itself how many slices it has.
    const auto has_slices = [&](int count) {
        const auto bytes = *read_file(at("a.png"));
        const std::string all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        return all.find(fmt::format(", {} slices", count)) != std::string::npos;
    };
    EXPECT_THAT(refused("--slices 40 --tolerance \"dE 9\""),
                HasSubstr("--slices and --tolerance exclude each other: the tolerance chooses"));
    EXPECT_THAT(refused("--slices 40 --effect slices_128=on"),
                HasSubstr("--slices and --effect slices_... exclude each other"));
    EXPECT_EQ(draw("--slices 40 --effect every_pixel=off").status, exit_done);
    EXPECT_TRUE(has_slices(40)) << "no rung, but asked for";
    const auto explained = draw("--slices 40 --explain");
    EXPECT_EQ(explained.status, exit_done) << explained.err;
    EXPECT_THAT(explained.out,
                HasSubstr("has the 40 slices that were asked for, the plan is of 64"));
    EXPECT_TRUE(has_slices(40));
    const std::string scene = "--scene " + at("s.toml");
    write("[volume]\nslices = 40\n");
    EXPECT_EQ(draw(scene + " --effect slices_128=on --effect slices_64=on").status, exit_done);
    EXPECT_FALSE(has_slices(40)) << "what is typed wins";
    EXPECT_EQ(draw(scene + " --tolerance \"dE 60\"").status, exit_done);
    EXPECT_FALSE(has_slices(40)) << "what is typed wins";
    write("[plan]\ntolerance = \"dE 9\"\n[plan.effects]\nslices_64 = \"on\"\n");
    EXPECT_EQ(draw(scene + " --slices 40").status, exit_done);
    EXPECT_TRUE(has_slices(40)) << "what is typed wins";
    write("[volume]\nslices = 40\n[plan]\ntolerance = \"dE 9\"\n");
    EXPECT_THAT(
        refused(scene),
        HasSubstr(at("s.toml") + ": [volume] slices and [plan] tolerance exclude each other"));
}

TEST_F(SceneFileTest, TheOtherKindOfSceneIsNamed) {
    const fs::path scenes = testing::source_directory() / "scenes";
    const Status storms = read_scene_file(scenes / "small-storm.toml", settings_.scene,
                                          settings_.plan, settings_.loop);
    ASSERT_FALSE(storms);
    EXPECT_THAT(storms.error().message, HasSubstr("a scene of simulated storms, for stormcellar"));
    EXPECT_THAT(complaint("[[point]]\nvalue = 1\n"),
                HasSubstr("s.toml: a colour table, for --col"));
    EXPECT_THAT(
        complaint("[paths]\ndrop = \"/d\"\n[[loop]]\nname = \"a\"\n"),
        HasSubstr("s.toml: a configuration of stormcellard; a picture's scene has [picture]"));
    const auto picture = synth::read_scene(scenes / "picture-section.toml");
    ASSERT_FALSE(picture);
    EXPECT_THAT(picture.error().message, HasSubstr("a picture's scene ([picture])"));
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
        const auto ran =
            run(add_frame, fmt::format("frame KBGM --cache {} --scene {} -o {}{}", cache(),
                                       entry.path().string(), at(name + ".png"), where));
        EXPECT_EQ(ran.status, exit_done) << name << ": " << ran.err;
        EXPECT_GT(fs::file_size(directory_ / (name + ".png")), 20'000U) << name;
    }
    EXPECT_EQ(found, 3U);
}

}  // namespace
}  // namespace stormcellar::cli
