// Runs `stormcellar loop` as a user does.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <map>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/loop_fixture.h"
#include "tests/pipeline/small_house.h"
#include "tests/render/decoded_animation.h"
#include "tests/testing/waiting.h"

namespace stormcellar::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

TEST_F(Loop, WritesTheSameFramesToEveryOutput) {
    commit_three();
    const auto result = run({"KBGM", "-o", out("a.webp"), "-o", out("frames/")});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("2005-08-22T02:44:00Z to 2005-08-22T02:56:00Z"));
    EXPECT_EQ(result.out, "");
    const auto webp = render::decode_webp(out("a.webp"));
    ASSERT_EQ(webp.frames.size(), 3U) << webp.error;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto png =
            render::decode_png_file(out("frames/frame_000" + std::to_string(i) + ".png"));
        EXPECT_EQ(webp.frames[i].image.rgba, png.rgba) << i;
    }
    EXPECT_NE(webp.frames[0].image.rgba, webp.frames[1].image.rgba);
    EXPECT_THAT(webp.metadata.at("XMP"), HasSubstr("KBGM 2005-08-22T02:44:00Z"));
}

// Fixes the view, which a loop would otherwise fit to all of its grids.
const Words plain_view =
    words("--zoom 1 --field-of-view 0 --exaggeration 5 --opacity 1 --light none --tilt 55");

TEST_F(Loop, DrawsWhatFrameDraws) {
    commit_three();
    ASSERT_EQ(run(with({"KBGM", "--azimuth", "180", "-o", out("frames/")}, plain_view)).status, 0);
    Words of_frame = {"frame",     "KBGM", "--cache", (directory_ / "cache").string(),
                      "--slices",  "16",   "--time",  "2005-08-22T02:50",
                      "--azimuth", "180",  "-o",      out("b.png")};
    of_frame.insert(of_frame.end(), plain_view.begin(), plain_view.end());
    const auto frame = testing::run_stormcellar(of_frame);
    ASSERT_EQ(frame.status, 0) << frame.err;
    EXPECT_EQ(render::decode_png_file(out("frames/frame_0001.png")).rgba,
              render::decode_png_file(out("b.png")).rgba);
}

TEST_F(Loop, GoesToStandardOutputToo) {
    commit_three();
    const auto webp = run({"KBGM", "-o", "-"});
    ASSERT_EQ(webp.status, 0) << webp.err;
    EXPECT_EQ(webp.out.substr(0, 4), "RIFF");
    EXPECT_THAT(webp.err, HasSubstr("standard output: KBGM"));
    EXPECT_EQ(run({"KBGM", "-o", "-.gif"}).out.substr(0, 4), "GIF8");
    EXPECT_EQ(run({"KBGM", "-o", "-", "-o", "-.gif"}).status, 2);
    EXPECT_EQ(run({"KBGM", "-o", "-", "--json"}).status, 2);
    EXPECT_EQ(run({"KBGM", "-o", "-.doc"}).status, 2);
}

TEST_F(Loop, TakesTheRangeAndOfItTheLast) {
    commit_three();
    const auto frames = [&](const Words& range) {
        const auto json =
            json_of(run(with(range, {"--domain", "KBGM", "--json", "-o", out("a.gif")})));
        return std::pair<std::string, int>(json["from"], json["frames"]);
    };
    EXPECT_EQ(frames({"--from", "2005-08-22T02:50:00Z"}),
              (std::pair<std::string, int>("2005-08-22T02:50:00Z", 2)));
    EXPECT_EQ(frames({"--to", "2005-08-22T02:50:00Z"}),
              (std::pair<std::string, int>("2005-08-22T02:44:00Z", 2)));
    EXPECT_EQ(frames({"--last", "1"}), (std::pair<std::string, int>("2005-08-22T02:56:00Z", 1)));
    EXPECT_EQ(frames({"--last", "9"}), (std::pair<std::string, int>("2005-08-22T02:44:00Z", 3)));
}

TEST_F(Loop, WhatLiesInTheFutureIsNotTheNewest) {
    commit_three();
    commit("20991231_000000", 50);
    const auto frames = [&](const Words& range) {
        return json_of(run(with(range, {"--domain", "KBGM", "--json", "-o", out("a.gif")})))["to"]
            .get<std::string>();
    };
    EXPECT_EQ(frames({"--last", "1"}), "2005-08-22T02:56:00Z");
    EXPECT_EQ(frames({}), "2005-08-22T02:56:00Z");
    EXPECT_EQ(frames({"--to", "2100-01-01"}), "2099-12-31T00:00:00Z") << "within --to";
    const auto frame =
        testing::run_stormcellar({"frame", "KBGM", "--cache", (directory_ / "cache").string(),
                                  "--slices", "16", "--json", "-o", out("b.png")});
    EXPECT_EQ(nlohmann::json::parse(frame.out)["time"], "2005-08-22T02:56:00Z");
}

TEST_F(Loop, WhereAllLiesInTheFutureItIsShownWithAWarning) {
    commit("20991231_000000", 50);
    const auto result = run({"KBGM", "-o", out("a.gif")});
    EXPECT_EQ(result.status, 0);
    EXPECT_THAT(result.err, HasSubstr("is in the future"));
}

TEST_F(Loop, ColorsAndViewAreThoseOfAllFrames) {
    commit("20050822_024400", 5);
    commit("20050822_025000", 70);
    for (const Words& product : {Words{"--product", "composite"},
                                 {"--product", "echotop"},
                                 {"--product", "vil"},
                                 {"--field-of-view", "60"}}) {
        Words arguments = {"KBGM", "-o", out("f/")};
        arguments.insert(arguments.end(), product.begin(), product.end());
        const auto result = run(arguments);
        ASSERT_EQ(result.status, 0) << result.err;
        EXPECT_THAT(result.err, ::testing::Not(HasSubstr("differ")));
        const auto first = render::decode_png_file(out("f/frame_0000.png"));
        const auto second = render::decode_png_file(out("f/frame_0001.png"));
        ASSERT_EQ(first.rgba.size(), second.rgba.size());
        std::size_t differing = 0;
        for (int y = 60; y < first.height - 20; ++y) {
            for (int x = first.width - 110; x < first.width; ++x) {
                const std::size_t at =
                    4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(first.width) +
                         static_cast<std::size_t>(x));
                differing += std::equal(first.rgba.begin() + static_cast<std::ptrdiff_t>(at),
                                        first.rgba.begin() + static_cast<std::ptrdiff_t>(at + 4),
                                        second.rgba.begin() + static_cast<std::ptrdiff_t>(at))
                                 ? 0
                                 : 1;
            }
        }
        EXPECT_EQ(differing, 0U) << product.back();
    }
}

TEST_F(Loop, SaysThatGridsOfADomainDiffer) {
    commit("20050822_024400", 22);
    commit("20050822_025000", 33, 48);
    const auto result = run({"KBGM", "-o", out("a.gif")});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("differ in place or size"));
}

TEST_F(Loop, MakesFramesBetweenGridsWhenCalledFor) {
    commit_three();
    const auto json = json_of(run({"KBGM", "--interval", "3min", "--product", "composite",
                                   "--no-labels", "--json", "-o", out("frames/")}));
    EXPECT_EQ(json["frames"], 4);  // 02:45, 02:48, 02:51, 02:54
    EXPECT_EQ(json["interpolated"], 4);
    EXPECT_EQ(png_texts(out("frames/frame_0000.png"))["Between grids"],
              "advected, each volume as of its middle");
    const auto own = run({"KBGM", "--product", "composite", "--no-labels", "-o", out("own/")});
    ASSERT_EQ(own.status, 0) << own.err;
    const auto two =
        run({"KBGM", "--interval", "120", "--from", "2005-08-22T02:50", "--to", "2005-08-22T02:50",
             "--product", "composite", "--no-labels", "-o", out("two/")});
    ASSERT_EQ(two.status, 0) << two.err;
    EXPECT_EQ(render::decode_png_file(out("two/frame_0000.png")).rgba,
              render::decode_png_file(out("own/frame_0001.png")).rgba);
    EXPECT_EQ(run({"KBGM", "--time-method", "blend", "-o", out("a.gif")}).status, 2);
    EXPECT_EQ(run({"KBGM", "--interval", "60", "--follow", "-o", out("a.gif")}).status, 2);
    EXPECT_EQ(run({"KBGM", "--interval", "0", "-o", out("a.gif")}).status, 2);
    EXPECT_EQ(run({"KBGM", "--interval", "1h", "-o", out("a.gif")}).status, 3);
}

TEST_F(Loop, DrawsTheProductAndMomentAskedFor) {
    commit_three();
    const auto cappi = run({"KBGM", "--product", "cappi", "--height-km", "4", "--colours",
                            "safe-reflectivity", "--json", "-o", out("a.webp")});
    EXPECT_EQ(cappi.status, 0) << cappi.err;
    EXPECT_THAT(cappi.out, ::testing::HasSubstr("\"product\": \"cappi\""));
    EXPECT_THAT(cappi.out, ::testing::HasSubstr("\"moment\": \"REF\""));
    const auto velocity = run({"KBGM", "--moment", "VEL", "-o", out("b.webp")});
    EXPECT_EQ(velocity.status, 3);
    EXPECT_THAT(velocity.err, ::testing::HasSubstr("its grids are of REF"));
    EXPECT_FALSE(fs::exists(out("b.webp")));
}

TEST_F(Loop, SaysWhatItDidAsJson) {
    commit_three();
    const auto result =
        run({"KBGM", "--json", "--width", "500", "--height", "400", "-o", out("a.webp")});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json["frames"], 3);
    EXPECT_EQ(json["width"], 500);
    EXPECT_EQ(json["skipped"].size(), 0U);
    EXPECT_EQ(json["outputs"][0], out("a.webp"));
    for (const char* phase : {"read_s", "render_s", "encode_s"})
        EXPECT_TRUE(json[phase].is_number()) << phase;
    EXPECT_LE(json["read_s"].get<double>(), json["total_s"].get<double>());
}

TEST_F(Loop, PingPongGoesThereAndBack) {
    commit_three();
    const auto result = run({"KBGM", "-o", out("a.webp"), "--ping-pong", "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto frames = render::decode_webp(out("a.webp")).frames;
    ASSERT_EQ(frames.size(), 4U);
    EXPECT_EQ(frames[3].image.rgba, frames[1].image.rgba);
    EXPECT_NE(frames[2].image.rgba, frames[1].image.rgba);
    EXPECT_EQ(nlohmann::json::parse(result.out)["to"], "2005-08-22T02:56:00Z");
}

TEST_F(Loop, AnOrbitTurnsTheCamera) {
    commit("20050822_024400", 40);
    commit("20050822_025000", 40);
    const auto frames_of = [&](const Words& more) {
        Words arguments{"KBGM", "-o", out("o.webp"), "--no-labels"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        arguments.insert(arguments.end(), plain_view.begin(), plain_view.end());
        EXPECT_EQ(run(arguments).status, 0);
        return render::decode_webp(out("o.webp")).frames;
    };
    const auto turning = frames_of({"--azimuth", "180", "--orbit", "90"});
    ASSERT_EQ(turning.size(), 2U);
    EXPECT_EQ(turning[0].image.rgba, frames_of({"--azimuth", "180", "--last", "2"})[0].image.rgba);
    EXPECT_EQ(turning[1].image.rgba, frames_of({"--azimuth", "225", "--last", "1"})[0].image.rgba);
    EXPECT_NE(turning[1].image.rgba, turning[0].image.rgba);
}

TEST_F(Loop, AnOrbitAroundOneGridHasAsManyFramesAsAskedFor) {
    commit("20050822_024400", 40);
    const auto frames_of = [&](const Words& more) {
        Words arguments{"KBGM",    "-o",  out("o.webp"), "--no-labels",
                        "--width", "200", "--height",    "150"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto result = run(arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        return render::decode_webp(out("o.webp")).frames;
    };
    // A camera with a typed position orbits about the point that it looks at.
    const auto frames = frames_of(
        {"--orbit", "360", "--frames", "8", "--camera-km", "5,-90,30", "--look-at-km", "5,0,4"});
    ASSERT_EQ(frames.size(), 8U);
    for (std::size_t i = 1; i < frames.size(); ++i)
        EXPECT_NE(frames[i].image.rgba, frames[0].image.rgba) << i;
    // After a quarter of the orbit, clockwise, the camera looks from the west.
    const auto from_west = frames_of({"--camera-km=-85,0,30", "--look-at-km", "5,0,4"});
    EXPECT_EQ(frames[2].image.rgba, from_west[0].image.rgba);
}

TEST_F(Loop, FramesAreSpreadOverTheGrids) {
    commit_three();
    const auto result = run({"KBGM", "-o", out("f/"), "--frames", "6", "--no-labels"});
    ASSERT_EQ(result.status, 0) << result.err;
    std::vector<std::vector<std::byte>> frames;
    for (int i = 0; i < 6; ++i)
        frames.push_back(*read_file(out(fmt::format("f/frame_{:04}.png", i))));
    EXPECT_FALSE(fs::exists(out("f/frame_0006.png")));
    EXPECT_EQ(frames[0], frames[1]);
    EXPECT_NE(frames[1], frames[2]);
    EXPECT_EQ(frames[2], frames[3]);
    EXPECT_EQ(frames[4], frames[5]);
}

TEST_F(Loop, TheCameraFliesThroughItsKeys) {
    commit("20050822_024400", 40);
    std::ofstream(directory_ / "fly.toml")
        << "[picture]\nwidth = 200\nheight = 150\n[labels]\nshow = false\n"
           "[camera]\nfield_of_view_deg = 50\n[loop]\nfps = 2\n"
           "[[loop.camera]]\ntime_s = 0\nat_km = [0, -90, 30]\nlook_at_km = [0, 0, 5]\n"
           "[[loop.camera]]\ntime_s = 1\nat_km = [-60, -60, 20]\nlook_at_km = [0, 0, 5]\n"
           "[[loop.camera]]\ntime_s = 2\nat_km = [-90, 20, 40]\nlook_at_km = [0, 0, 5]\n";
    const std::string scene = (directory_ / "fly.toml").string();
    const auto result = run({"KBGM", "--scene", scene, "-o", out("f.webp")});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto frames = render::decode_webp(out("f.webp")).frames;
    ASSERT_EQ(frames.size(), 5U);  // two frames a second for 2 s, and a last frame at 2 s
    const auto still = [&](const std::string& place) {
        EXPECT_EQ(run({"KBGM", "--scene", scene, "--camera-km=" + place, "--look-at-km", "0,0,5",
                       "-o", out("s.webp")})
                      .status,
                  0);
        return render::decode_webp(out("s.webp")).frames.front().image.rgba;
    };
    EXPECT_EQ(frames[0].image.rgba, still("0,-90,30"));
    EXPECT_EQ(frames[2].image.rgba, still("-60,-60,20"));
    EXPECT_EQ(frames[4].image.rgba, still("-90,20,40"));
    EXPECT_NE(frames[1].image.rgba, frames[0].image.rgba);
}

TEST_F(Loop, QuietPrintsNothing) {
    commit_three();
    const auto result = run({"KBGM", "--quiet", "-o", out("a.webp")});
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.out + result.err, "");
}

TEST_F(Loop, FrameRateAndDwellReachTheFile) {
    commit_three();
    ASSERT_EQ(run({"KBGM", "--fps", "4", "--dwell", "2", "-o", out("a.webp")}).status, 0);
    const auto webp = render::decode_webp(out("a.webp"));
    ASSERT_EQ(webp.frames.size(), 3U);
    EXPECT_DOUBLE_EQ(webp.frames[0].duration_s, 0.25);
    EXPECT_DOUBLE_EQ(webp.frames[2].duration_s, 2.25);
}

TEST_F(Loop, DamagedGridIsNamedAndLeftOut) {
    commit_three();
    fs::resize_file(grids_[1], 100);
    const auto result = run({"KBGM", "-o", out("a.webp")});
    EXPECT_EQ(result.status, 0);
    EXPECT_THAT(result.err, HasSubstr("frame left out"));
    EXPECT_THAT(result.err, HasSubstr(grids_[1].filename().native()));
    EXPECT_EQ(render::decode_webp(out("a.webp")).frames.size(), 2U);
}

TEST_F(Loop, NothingButDamagedGridsIsAFailureAndWritesNothing) {
    commit("20050822_024400", 22);
    fs::resize_file(grids_[0], 100);
    const auto ran = run({"KBGM", "-o", out("a.webp"), "-o", out("frames/")});
    EXPECT_EQ(ran.status, 1);
    EXPECT_THAT(ran.err, HasSubstr("the only grid cannot be read; nothing was written"));
    EXPECT_THAT(written(), IsEmpty());
}

TEST_F(Loop, NothingMatchedIsStatusThree) {
    commit_three();
    const auto other = run({"KTLX", "-o", out("a.webp")});
    EXPECT_EQ(other.status, 3);
    EXPECT_THAT(other.err, HasSubstr("the domains are KBGM"));
    const auto late = run({"KBGM", "--from", "2006-01-01", "-o", out("a.webp")});
    EXPECT_EQ(late.status, 3);
    EXPECT_THAT(late.err, HasSubstr("from 2006-01-01"));
    EXPECT_THAT(written(), IsEmpty());
}

TEST_F(Loop, NonsenseIsBadUsageInOneLineAndWritesNothing) {
    commit_three();
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
        {{"KBGM", "-o", out("a.avi")}, "the ending '.avi' is not known"},
        {{"KBGM", "-o", out("")}, "a.webp"},
        {{"KBGM", "-o", out("a.webp"), "--from", "noon"}, "--from: 'noon' is not a time"},
        {{"KBGM", "-o", out("a.webp"), "--fps", "0"}, "0.1 to 60"},
        {{"KBGM", "-o", out("a.webp"), "--last", "0"}, "--last"},
        {{"KBGM", "-o", out("a.webp"), "-o", out("./a.webp")}, "named twice"},
        {{"KBGM", "-o", out("a.webp"), "--tilt", "100"}, "tilt"},
        {{"KBGM", "-o", out("b.gif"), "-o", out("a.avi")}, "a.avi"},
        {{"KBGM", "-o", out("a.webp"), "--last", "1", "--orbit", "360"}, "--frames 120"},
        {{"KBGM", "-o", out("a.webp"), "--last", "1", "--frames", "9"}, "--orbit 360"},
        {{"KBGM", "--domain", "KENX", "-o", out("a.webp")}, "two domains"},
        {{"KBGM20050822_024414.gz", "-o", out("a.webp")}, "no such file"},
        {{"KBGM"}, "--output"},
    };
    std::ofstream(directory_ / "out/a.webp") << "mine";
    for (const auto& [arguments, message] : cases) {
        const auto result = run(arguments);
        EXPECT_EQ(result.status, message == "no such file" ? 1 : 2) << message;
        EXPECT_THAT(result.err, StartsWith("stormcellar: ")) << message;
        EXPECT_THAT(result.err, HasSubstr(message));
        EXPECT_THAT(written(), ElementsAre("a.webp")) << message;
        EXPECT_EQ(fs::file_size(directory_ / "out/a.webp"), 4U) << message;
    }
}

TEST_F(Loop, PlaceThatCannotBeWrittenIsAFailureThatNamesIt) {
    commit_three();
    const auto result = run({"KBGM", "-o", out("missing/a.webp")});
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("there is no directory " + out("missing")));
    const auto cache = testing::run_stormcellar(
        {"loop", "KBGM", "--cache", (directory_ / "nowhere").string(), "-o", out("a.webp")});
    EXPECT_EQ(cache.status, 1);
    EXPECT_THAT(cache.err, HasSubstr("nowhere"));
}

// Interrupts a loop of very many grids while the program writes the frames.
TEST_F(Loop, InterruptedLeavesNothingAndEndsByTheSignal) {
    commit("20050822_024400", 22);
    for (int i = 0; i < 400; ++i) {
        fs::copy_file(grids_[0], path_at_minute(i));
    }
    const std::string cache = (directory_ / "cache").string();
    const std::string webp = out("a.webp"), frames = out("frames/");
    // The directory of frames has a temporary name until the loop is complete.
    const auto frames_drawn = [&] {
        for (const auto& entry : fs::directory_iterator(directory_ / "out")) {
            if (entry.is_directory() && fs::exists(entry.path() / "frame_0001.png")) return true;
        }
        return false;
    };
    const int signal = testing::interrupt_program(
        STORMCELLAR_PROGRAM,
        {"loop", "KBGM", "--quiet", "--cache", cache, "-o", webp, "-o", frames}, frames_drawn);
    EXPECT_EQ(signal, SIGINT);
    EXPECT_THAT(written(), IsEmpty());
}

// 2026-11-25: Ctrl-C left the temporary directory through which standard output goes.
TEST_F(Loop, InterruptedOnItsWayToStandardOutputItLeavesNoTemporaryDirectory) {
    commit("20050822_024400", 40);
    const fs::path temporary = directory_ / "tmp";
    fs::create_directory(temporary);
    ::setenv("TMPDIR", temporary.c_str(), 1);
    const int signal = testing::interrupt_program(
        STORMCELLAR_PROGRAM,
        {"loop", "KBGM", "--quiet", "--cache", (directory_ / "cache").string(), "--orbit", "360",
         "--frames", "2000", "-o", "-"},
        [&] { return !fs::is_empty(temporary); });
    ::unsetenv("TMPDIR");
    EXPECT_EQ(signal, SIGINT);
    EXPECT_TRUE(fs::is_empty(temporary));
}

// All grids are links to one file. A thread truncates and restores this file all the time, so most
// grids are truncated while they are drawn.
TEST_F(Loop, GridsThatAreCutWhileTheyAreDrawnAreLeftOut) {
    commit("20050822_024400", 22);
    for (int i = 1; i < 40; ++i) {
        fs::create_hard_link(grids_[0], path_at_minute(i));
    }
    const auto bytes = *read_file(grids_[0]);
    std::atomic<bool> done = false;
    std::thread vandal([&] {
        std::fstream file(grids_[0], std::ios::in | std::ios::out | std::ios::binary);
        while (!done) {
            testing::pass_time(std::chrono::milliseconds(3));
            fs::resize_file(grids_[0], 4096);
            testing::pass_time(std::chrono::milliseconds(1));
            file.seekp(0).write(reinterpret_cast<const char*>(bytes.data()),
                                static_cast<std::streamsize>(bytes.size()));
            file.flush();
        }
    });
    const auto result = run({"KBGM", "--quiet", "-o", out("a.webp")});
    done = true;
    vandal.join();
    EXPECT_TRUE(result.status == 0 || result.status == 1) << "a signal ended the program";
    EXPECT_THAT(result.err, HasSubstr("frame left out"));
    EXPECT_THAT(result.err, HasSubstr("cut"));
    EXPECT_EQ(fs::exists(out("a.webp")), result.status == 0);
}

TEST_F(Loop, RealVolumesBecomeALoop) {
    STORMCELLAR_NEED_DATA();
    auto catalog = catalog::CatalogWriter::open(directory_ / "catalog");
    ASSERT_TRUE(catalog) << catalog.error().message;
    pipeline::Ingestor ingestor(*catalog, store_, pipeline::small_grid());
    for (const char* name : {"KBGM20050822_024414.gz", "KBGM20050822_025001.gz"}) {
        const auto outcome = ingestor.ingest(testing::real_file("sequence-kbgm") / name, false);
        ASSERT_TRUE(outcome) << outcome.error().message;
        ASSERT_EQ(outcome->result(), pipeline::IngestResult::gridded) << outcome->reason;
    }
    const auto result = run({"KBGM", "-o", out("a.webp"), "--no-labels"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto loop = render::decode_webp(out("a.webp"));
    ASSERT_EQ(loop.frames.size(), 2U) << loop.error;
    // Echo moves between the volumes; without labels nothing else can differ.
    EXPECT_NE(loop.frames[0].image.rgba, loop.frames[1].image.rgba);
    int saturated = 0;  // number of colored pixels; ground and lines are gray
    const render::Image& image = loop.frames[0].image;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        const auto [low, high] = std::minmax({image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]});
        if (high - low > 60) ++saturated;
    }
    EXPECT_GT(saturated, 1000);
}

}  // namespace
}  // namespace stormcellar::cli
