// Tests which animations a configuration has, and how the server sends them.
#include "web/doors/pictures/loops.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/testing/temporary_directory.h"
#include "tests/web/asked.h"
#include "web/config/web_setup.h"

namespace stormcellar::web {
namespace {

namespace fs = std::filesystem;

class Loops : public ::testing::Test {
  protected:
    Loops() {
        write("stormcellard.toml",
              "[[loop]]\nname = \"oklahoma\"\ndomain = \"KTLX\"\nlast = 3\n"
              "outputs = [\"made/ok.webp\", \"made/ok.mp4\", \"made/frames/\", \"b/other.webp\"]\n"
              "[[loop]]\nname = \"plains\"\nscene = \"scenes/plains.toml\"\n"
              "[[loop]]\nname = \"bare\"\nscene = \"scenes/missing.toml\"\n");
        write("scenes/plains.toml", "[loop]\noutputs = [\"plains.gif\"]\nlast = 5\n");
        write("made/ok.webp", "RIFF and more");
        write("b/other.webp", "another");
        write("scenes/plains.gif", "GIF89a");
    }
    void write(const fs::path& name, const std::string& text) {
        fs::create_directories((directory_ / name).parent_path());
        std::ofstream(directory_ / name, std::ios::binary) << text;
    }
    [[nodiscard]] LoopsDoor door() const {
        const auto setup = load_web_setup(directory_ / "stormcellard.toml");
        EXPECT_TRUE(setup) << setup.error().message;
        return LoopsDoor(setup->loops);
    }
    testing::TemporaryDirectory directory_;
};

TEST_F(Loops, AreThoseOfTheConfigurationAndOfItsScenes) {
    LoopsDoor loops = door();
    const auto json = nlohmann::json::parse(body_of(asked(loops, "/loops")));
    ASSERT_EQ(json["loops"].size(), 3u);
    EXPECT_EQ(json["loops"][0]["loop"], "oklahoma");
    ASSERT_EQ(json["loops"][0]["files"].size(), 1u) << "the video does not exist yet";
    EXPECT_EQ(json["loops"][0]["files"][0]["url"], "http://localhost:8090/loops/oklahoma.webp");
    EXPECT_EQ(json["loops"][0]["files"][0]["bytes"], 13);
    EXPECT_EQ(json["loops"][1]["files"][0]["media_type"], "image/gif");
    EXPECT_EQ(json["loops"][2]["files"].size(), 0u);
}

TEST_F(Loops, AreGivenOutWithTagsAndRanges) {
    LoopsDoor loops = door();
    const Answer whole = asked(loops, "/loops/oklahoma.webp");
    EXPECT_EQ(whole.status, 200u);
    EXPECT_EQ(body_of(whole), "RIFF and more");
    EXPECT_EQ(header_of(whole, "Content-Type"), "image/webp");
    EXPECT_EQ(header_of(whole, "Cache-Control"), "no-cache");
    const Answer part = asked(loops, "/loops/oklahoma.webp", {{"Range", "bytes=5-7"}});
    EXPECT_EQ(part.status, 206u);
    EXPECT_EQ(body_of(part), "and");
    const std::string etag = header_of(whole, "ETag");
    EXPECT_EQ(asked(loops, "/loops/oklahoma.webp", {{"If-None-Match", etag}}).status, 304u);
    // stormcellar replaces an animation by renaming a new file.
    write("next", "RIFF and else");
    fs::rename(directory_ / "next", directory_ / "made/ok.webp");
    const Answer next = asked(loops, "/loops/oklahoma.webp", {{"If-None-Match", etag}});
    EXPECT_EQ(next.status, 200u);
    EXPECT_EQ(body_of(next), "RIFF and else");
    EXPECT_EQ(body_of(asked(loops, "/loops/plains.gif")), "GIF89a");
}

TEST_F(Loops, OtherNamesAreNotFound) {
    LoopsDoor loops = door();
    for (const char* target :
         {"/loops/oklahoma.mp4", "/loops/oklahoma", "/loops/texas.webp", "/loops/plains.webp",
          "/loops/oklahoma.webp/more", "/loops/other.webp", "/loops/stormcellard.toml"})
        EXPECT_EQ(asked(loops, target).status, 404u) << target;
    fs::remove(directory_ / "made/ok.webp");
    fs::create_symlink(directory_ / "stormcellard.toml", directory_ / "made/ok.webp");
    EXPECT_EQ(asked(loops, "/loops/oklahoma.webp").status, 503u) << "links are not followed";
}

}  // namespace
}  // namespace stormcellar::web
