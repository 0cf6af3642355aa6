// Tests a scene file together with typed options. Some options exclude keys of the file; other
// options override keys.
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/scene_file_fixture.h"
#include "tests/testing/file_bytes.h"

namespace stormcellar::cli {
namespace {

using ::testing::HasSubstr;

TEST_F(SceneFileTest, WhatIsWrongIsSaidBeforeWhatIsMissing) {
    const auto file = write("[loop]\nfps = 100\n");
    for (const char* name : {"frame", "loop"}) {
        const auto ran = run(fmt::format("{} --cache x --scene {}", name, file.string()));
        EXPECT_EQ(ran.status, exit_bad_usage);
        EXPECT_THAT(ran.err, HasSubstr("s.toml:2: [loop] fps: 100 is out of range"));
        const auto absent = run(fmt::format("{} --cache x --scene {}", name, at("absent")));
        EXPECT_EQ(absent.status, exit_failed);
        EXPECT_THAT(absent.err, HasSubstr("absent: No such file"));
    }
}

TEST_F(SceneFileTest, WhatMakesNoSenseTogetherNamesTheFile) {
    commit();
    const auto said = [&](const std::string& arguments) {
        const auto ran =
            run(fmt::format("{} KBGM --cache {} --scene {}", arguments, cache(), at("s.toml")));
        EXPECT_EQ(ran.status, exit_bad_usage) << ran.err;
        return ran.err;
    };
    const std::string frame = "frame -o " + at("a.png");
    const std::string loop = "loop -o " + at("a.webp");
    write("[camera]\ntilt_deg = 120\n");
    const std::string tilted = at("s.toml") + ": [camera] tilt_deg must be 0 to 90, not 120";
    EXPECT_THAT(said(frame), HasSubstr(tilted));
    EXPECT_THAT(said(loop), HasSubstr(tilted));
    EXPECT_THAT(said(frame + " --width 500"), HasSubstr(tilted));
    EXPECT_THAT(
        said(frame + " --tilt 100"),
        HasSubstr("--tilt must be 0 to 90, not 100 (together with --scene " + at("s.toml") + ")"));
    write("[picture]\nproduct = \"section\"\n");
    EXPECT_THAT(said(frame), HasSubstr(at("s.toml") + ": a section needs its two ends"));
    const auto mended =
        run(fmt::format("{} KBGM --cache {} --scene {} --section 42,-76.1,42.3,-75.8", frame,
                        cache(), at("s.toml")));
    EXPECT_EQ(mended.status, exit_done) << mended.err;
}

TEST_F(SceneFileTest, APlanIsLeftOutForAProductThatWasTyped) {
    commit();
    const auto draw = [&](const std::string& more) {
        return run(fmt::format("frame KBGM --cache {} --scene {} --width 400 --height 300 -o {} {}",
                               cache(), at("s.toml"), at("a.png"), more));
    };
    const std::string plan = "[plan]\ntolerance = \"dE 9\"\n[plan.effects]\nevery_pixel = \"on\"\n";
    write(plan);
    const auto typed = draw("--product composite");
    EXPECT_EQ(typed.status, exit_done) << typed.err;
    for (const char* more : {"--tolerance \"dE 5\"", "--explain", "--effect=every_pixel=off"}) {
        const auto both = draw(std::string("--product composite ") + more);
        EXPECT_EQ(both.status, exit_bad_usage) << more;
        EXPECT_THAT(both.err,
                    HasSubstr("--tolerance, --effect and --explain need --product volume"));
    }
    write("[picture]\nproduct = \"composite\"\n" + plan);
    const auto within = draw("");
    EXPECT_EQ(within.status, exit_bad_usage);
    EXPECT_THAT(within.err,
                HasSubstr(at("s.toml") +
                          ": [plan] needs the product volume; it does not work with composite"));
    EXPECT_EQ(draw("--product volume").status, exit_done) << "the plan applies to a volume";
}

// 2026-11-22: keys that the picture did not use were ignored without a message.
TEST_F(SceneFileTest, KeysAreLeftOutForAProductThatWasTyped) {
    commit();
    const auto draw = [&](const std::string& more) {
        return run(fmt::format("frame KBGM --cache {} --scene {} -o {} {}", cache(), at("s.toml"),
                               at("a.png"), more));
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
    EXPECT_THAT(both.err,
                HasSubstr("--opacity is for volume; composite does not use it (together with "));
    write("[picture]\nproduct = \"composite\"\n" + keys);
    for (const char* more : {"", "--product vil"}) {
        const auto within = draw(more);
        EXPECT_EQ(within.status, exit_bad_usage) << "the file has an error for its own product";
        EXPECT_THAT(within.err, HasSubstr("[camera] tilt_deg is for volume; "));
        EXPECT_THAT(within.err, HasSubstr(at("s.toml")));
    }
    EXPECT_EQ(draw("--product volume").status, exit_done) << "the keys apply to a volume";
}

TEST_F(SceneFileTest, PanelsAreForFrameAlone) {
    commit();
    const auto with_scene = [&](const std::string& arguments) {
        return run(fmt::format("{} KBGM --cache {} --scene {}", arguments, cache(), at("s.toml")));
    };
    const std::string frame = "frame --json -o " + at("a.png");
    const std::string loop = "loop -o " + at("a.webp");
    write("[picture]\nproduct = \"composite\"\npanels = [\"REF\"]\n");
    const auto drawn = with_scene(frame);
    EXPECT_EQ(drawn.status, exit_done) << drawn.err;
    EXPECT_THAT(drawn.out, HasSubstr("\"width\": 1280")) << "panels have this usual size";
    const auto one = with_scene(frame + " --moment REF");
    EXPECT_EQ(one.status, exit_done) << one.err;
    EXPECT_THAT(one.out, HasSubstr("\"width\": 796")) << "a typed option overrides the file";
    const auto refused = with_scene(loop);
    EXPECT_EQ(refused.status, exit_bad_usage);
    EXPECT_THAT(refused.err, HasSubstr(at("s.toml") + ": [picture] panels is for frame"));
    EXPECT_EQ(with_scene(loop + " --moment REF").status, exit_done);
    write("[picture]\nproduct = \"composite\"\n");
    const auto typed = with_scene(loop + " --panels REF,VEL");
    EXPECT_EQ(typed.status, exit_bad_usage);
    EXPECT_THAT(typed.err, HasSubstr("--panels is for frame"));
    EXPECT_THAT(typed.err, HasSubstr("name it with --moment"));
}

TEST_F(SceneFileTest, WrongPanelsAreSaidWithTheirLine) {
    EXPECT_EQ(complaint("[picture]\npanels = [\"REF\", \"REF\"]\n"),
              "s.toml:2: [picture] panels: the list names REF twice");
    EXPECT_THAT(complaint("[picture]\npanels = [\"XYZ\"]\n"),
                HasSubstr("s.toml:2: [picture] panels: the list must name moments (REF, VEL"));
    EXPECT_THAT(complaint("[picture]\npanels = []\n"), HasSubstr("not ''"));
    EXPECT_EQ(complaint("[picture]\nmoment = \"VEL\"\npanels = [\"REF\", \"VEL\"]\n"),
              "s.toml:3: [picture] panels: each panel has a moment and colors of its own; leave "
              "out moment");
}

// 2026-11-22: a tolerance made the program ignore the number of slices, and --explain rounded it.
TEST_F(SceneFileTest, SlicesAndWhatChoosesThemExcludeEachOther) {
    commit();
    const auto draw = [&](const std::string& more) {
        return run(fmt::format("frame KBGM --cache {} --width 400 --height 300 -o {} {}", cache(),
                               at("a.png"), more));
    };
    const auto refused = [&](const std::string& more) {
        const auto ran = draw(more);
        EXPECT_EQ(ran.status, exit_bad_usage) << more;
        return ran.err;
    };
    // The metadata in the PNG name the number of slices.
    const auto has_slices = [&](int count) {
        return testing::file_text(at("a.png")).find(fmt::format(", {} slices", count)) !=
               std::string::npos;
    };
    EXPECT_THAT(
        refused("--slices 40 --tolerance \"dE 9\""),
        HasSubstr("--slices and --tolerance cannot be used together: the tolerance chooses"));
    EXPECT_THAT(refused("--slices 40 --effect slices_128=on"),
                HasSubstr("--slices and --effect slices_... cannot be used together"));
    EXPECT_EQ(draw("--slices 40 --effect every_pixel=off").status, exit_done);
    EXPECT_TRUE(has_slices(40)) << "40 is not a rung, but was requested";
    const auto explained = draw("--slices 40 --explain");
    EXPECT_EQ(explained.status, exit_done) << explained.err;
    EXPECT_THAT(explained.out, HasSubstr("has the 40 slices that you asked for; the plan has 64"));
    EXPECT_TRUE(has_slices(40));
    const std::string scene = "--scene " + at("s.toml");
    write("[volume]\nslices = 40\n");
    EXPECT_EQ(draw(scene + " --effect slices_128=on --effect slices_64=on").status, exit_done);
    EXPECT_FALSE(has_slices(40)) << "a typed option overrides the file";
    EXPECT_EQ(draw(scene + " --tolerance \"dE 60\"").status, exit_done);
    EXPECT_FALSE(has_slices(40)) << "a typed option overrides the file";
    write("[plan]\ntolerance = \"dE 9\"\n[plan.effects]\nslices_64 = \"on\"\n");
    EXPECT_EQ(draw(scene + " --slices 40").status, exit_done);
    EXPECT_TRUE(has_slices(40)) << "a typed option overrides the file";
    write("[volume]\nslices = 40\n[plan]\ntolerance = \"dE 9\"\n");
    EXPECT_THAT(
        refused(scene),
        HasSubstr(at("s.toml") + ": [volume] slices and [plan] tolerance cannot be used together"));
}

}  // namespace
}  // namespace stormcellar::cli
