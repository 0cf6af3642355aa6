// Tests the metadata in the files of loops.
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/loop_fixture.h"
#include "tests/render/decoded_animation.h"
#include "tests/testing/file_bytes.h"

namespace stormcellar::cli {
namespace {

using ::testing::HasSubstr;

// Returns the blocks of the first comment of a GIF.
std::string gif_comment(const std::string& path) {
    const std::string all = testing::file_text(path);
    std::string comment;
    for (std::size_t at = all.find("\x21\xFE") + 2; all[at] != '\0';) {
        const auto length = static_cast<std::size_t>(static_cast<unsigned char>(all[at]));
        comment += all.substr(at + 1, length);
        at += 1 + length;
    }
    return comment;
}

TEST_F(Loop, EveryFormatSaysWhatItShowsAndHow) {
    commit_three();
    Words arguments = {"KBGM"};
    for (const char* name : {"a.webp", "a.gif", "a.apng", "a.mp4", "a.webm", "a/"}) {
        arguments.emplace_back("-o");
        arguments.push_back(out(name));
    }
    const auto result = run(arguments);
    ASSERT_EQ(result.status, 0) << result.err;
    const auto text_of = [&](const std::string& name) { return testing::file_text(out(name)); };
    std::map<std::string, std::string> texts = {
        {"webp", render::decode_webp(out("a.webp")).metadata.at("XMP")},
        {"gif", gif_comment(out("a.gif"))},
        {"mp4", text_of("a.mp4")},
        {"webm", text_of("a.webm")}};
    for (const char* png : {"a.apng", "a/frame_0000.png", "a/frame_0002.png"}) {
        for (const auto& [keyword, text] : png_texts(out(png)))
            texts[png] += keyword + ": " + text + "\n";
        if (std::string(png) == "a/frame_0002.png") continue;
        EXPECT_EQ(png_texts(out(png))["Stations"], "");  // this grid names no stations
    }
    for (const auto& [name, text] : texts) {
        SCOPED_TRACE(name);
        for (const char* line :
             {"Title: KBGM 2005-08-22T02:44:00Z to 2005-08-22T02:56:00Z",
              "First time: 2005-08-22T02:44:00Z", "Last time: 2005-08-22T02:56:00Z", "Frames: 3",
              "Domain: KBGM", "Product: volume", "Moment: REF", "Units: dBZ",
              "Grid: 40 x 40 x 32 cells of 1 km, azimuthal_equidistant",
              "Picture: 796 x 532 pixels, 16 slices, ", "Software: stormcellar "}) {
            EXPECT_THAT(text, HasSubstr(line));
        }
    }
    for (const char c : texts["gif"])
        EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~'));
    const auto bytes = text_of("a.gif") + text_of("a.webp") + text_of("a.apng");
    ASSERT_EQ(run(arguments).status, 0);
    EXPECT_EQ(bytes, text_of("a.gif") + text_of("a.webp") + text_of("a.apng"));
}

TEST_F(Loop, APlannedPicturesErrorIsInItsFile) {
    commit_three();
    const auto result = run({"KBGM", "--tolerance", "dE 5", "--width", "200", "--height", "150",
                             "--no-labels", "-o", out("a.gif")});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(gif_comment(out("a.gif")), HasSubstr("Picture error: tolerance dE 5"));
    EXPECT_THAT(gif_comment(out("a.gif")), HasSubstr("predicted dE "));
}

TEST_F(Loop, FramesOfADamagedGridAreNotCounted) {
    commit_three();
    fs::resize_file(grids_[0], 100);
    ASSERT_EQ(run({"KBGM", "-o", out("a.gif")}).status, 0);
    EXPECT_THAT(gif_comment(out("a.gif")), HasSubstr("First time: 2005-08-22T02:50:00Z"));
    EXPECT_THAT(gif_comment(out("a.gif")), HasSubstr("Frames: 2\n"));
}

}  // namespace
}  // namespace stormcellar::cli
