#include "cli/picture/drawn_frames.h"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

class KeptFramesTest : public ::testing::Test {
  protected:
    fs::path grid(const std::string& name, const std::string& text = "grid") {
        std::ofstream(directory_ / name) << text;
        return directory_ / name;
    }
    // Returns a frame with 400 bytes of pixels, whose red channel counts the drawings.
    Result<render::Image> frame(DrawnFrames& kept, const fs::path& path,
                                const render::Scene& scene = {}) {
        return kept.frame(path, scene, [this]() -> Result<render::Image> {
            ++drawn_;
            return render::Image(10, 10, {static_cast<std::uint8_t>(drawn_), 0, 0, 255});
        });
    }
    testing::TemporaryDirectory directory_;
    int drawn_ = 0;
};

TEST_F(KeptFramesTest, TheSameGridIsDrawnOnce) {
    DrawnFrames kept;
    const fs::path a = grid("a");
    const fs::path b = grid("b");
    EXPECT_EQ(frame(kept, a)->at(3, 3)[0], 1);
    EXPECT_EQ(frame(kept, b)->at(3, 3)[0], 2);
    kept.next_loop();
    EXPECT_EQ(frame(kept, a)->at(3, 3)[0], 1);
    EXPECT_EQ(drawn_, 2);
}

TEST_F(KeptFramesTest, WhatDiffersIsDrawnAnew) {
    DrawnFrames kept;
    const fs::path a = grid("a");
    render::Scene scene;
    (void)frame(kept, a, scene);
    scene.camera.azimuth_deg += 1;
    (void)frame(kept, a, scene);
    scene.slices = 64;
    (void)frame(kept, a, scene);
    scene.integration = render::Integration::riemann;
    (void)frame(kept, a, scene);
    scene.pixel_tolerance = 0.01;
    (void)frame(kept, a, scene);
    EXPECT_EQ(drawn_, 5);
    fs::rename(grid("new"), a);  // replaced by rename, as by the store
    (void)frame(kept, a, scene);
    EXPECT_EQ(drawn_, 6);
    grid("a", "another length");
    (void)frame(kept, a, scene);
    EXPECT_EQ(drawn_, 7);
}

TEST_F(KeptFramesTest, WhatALoopDidNotWantGoes) {
    DrawnFrames kept;
    const fs::path a = grid("a");
    const fs::path b = grid("b");
    (void)frame(kept, a);
    (void)frame(kept, b);
    kept.next_loop();
    (void)frame(kept, b);
    kept.next_loop();
    EXPECT_EQ(kept.count(), 1U);
    (void)frame(kept, b);
    EXPECT_EQ(drawn_, 2);
    (void)frame(kept, a);
    EXPECT_EQ(drawn_, 3);
}

TEST_F(KeptFramesTest, NoMoreIsKeptThanThereIsRoomFor) {
    DrawnFrames kept(1000);
    const fs::path all[] = {grid("a"), grid("b"), grid("c")};
    for (int round = 0; round < 2; ++round) {
        for (const fs::path& path : all)
            ASSERT_TRUE(frame(kept, path));
    }
    EXPECT_EQ(kept.count(), 2U);
    EXPECT_EQ(drawn_, 4) << "the third frame is drawn twice";
    kept.next_loop();
    (void)frame(kept, all[2]);
    EXPECT_EQ(kept.count(), 2U) << "frames are dropped between loops, not during a loop";
    kept.next_loop();
    (void)frame(kept, all[2]);
    EXPECT_EQ(kept.count(), 1U);
    (void)frame(kept, all[2]);
    EXPECT_EQ(drawn_, 6);
}

TEST_F(KeptFramesTest, WhatCannotBeDrawnIsNotKept) {
    DrawnFrames kept;
    const auto failed = kept.frame(
        grid("a"), {}, []() -> Result<render::Image> { return fail(ErrorCode::io, "broken"); });
    EXPECT_FALSE(failed);
    EXPECT_TRUE(frame(kept, directory_ / "a"));
    ASSERT_TRUE(frame(kept, directory_ / "none")) << "the file is gone, but still open";
    EXPECT_EQ(kept.count(), 1U);
}

}  // namespace
}  // namespace stormcellar::cli
