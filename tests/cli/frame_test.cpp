#include <fstream>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cache/store.h"
#include "cli/commands.h"
#include "grid/brick_grid.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;

class Frame : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto store =
            cache::Store::open_for_writing(real_file_system(), directory_ / "cache", true);
        ASSERT_TRUE(store) << store.error().message;
        for (const char* time : {"20050822_024400", "20050822_025000"}) {
            grid::Grid grid;
            grid.spec = grid::default_spec(42.2, -75.98);
            grid.spec.nx = grid.spec.ny = 40;
            grid.time = parse_compact(time).value();
            grid.sites = {{"KBGM", 42.2, -75.98, 490}};
            grid.values.assign(grid.spec.cell_count(), 33);
            grid.status.assign(grid.spec.cell_count(), grid::CellStatus::value);
            const auto bricks =
                grid::BrickGrid::from(grid, grid::default_quantization(level2::Moment::ref));
            const auto path = store->commit("KBGM", cache::describe(grid), bricks.view());
            ASSERT_TRUE(path) << path.error().message;
        }
    }

    int run(const std::string& arguments) {
        CLI::App app;
        const Command command = add_frame(app);
        app.parse("frame --cache " + (directory_ / "cache").string() + " " + arguments);
        ::testing::internal::CaptureStderr();
        ::testing::internal::CaptureStdout();
        const int status = command.run();
        messages_ = ::testing::internal::GetCapturedStderr();
        facts_ = ::testing::internal::GetCapturedStdout();
        return status;
    }

    [[nodiscard]] std::string out(const char* name) const { return (directory_ / name).string(); }

    std::string text_of(const std::string& path) const {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    testing::TemporaryDirectory directory_;
    std::string messages_;
    std::string facts_;
};

TEST_F(Frame, DrawsTheLatestGridAsPng) {
    EXPECT_EQ(run("--domain KBGM -o " + out("a.png")), exit_done) << messages_;
    const std::string png = text_of(out("a.png"));
    EXPECT_THAT(png, ::testing::StartsWith("\x89PNG"));
    EXPECT_THAT(png, ::testing::HasSubstr("2005-08-22T02:50:00Z"));
}

TEST_F(Frame, TakesTheGridAtOrBeforeTheTime) {
    EXPECT_EQ(run("--domain KBGM --time 2005-08-22T02:49 --product composite -o " + out("a.png")),
              exit_done);
    EXPECT_THAT(text_of(out("a.png")), ::testing::HasSubstr("2005-08-22T02:44:00Z"));
}

TEST_F(Frame, SaysWhatItDidAsJson) {
    EXPECT_EQ(run("--domain KBGM --json --width 500 --slices 16 -o " + out("a.png")), exit_done);
    EXPECT_THAT(facts_, ::testing::HasSubstr("\"width\": 500"));
    EXPECT_THAT(facts_, ::testing::HasSubstr("\"render_s\""));
    EXPECT_EQ(messages_, "");
}

TEST_F(Frame, NothingMatchedIsStatusThreeAndWritesNothing) {
    EXPECT_EQ(run("--domain KTLX -o " + out("a.png")), exit_nothing_matched);
    EXPECT_THAT(messages_, ::testing::HasSubstr("domains are KBGM"));
    EXPECT_EQ(run("--domain KBGM --time 2005-08-22T02:43 -o " + out("a.png")),
              exit_nothing_matched);
    EXPECT_FALSE(fs::exists(out("a.png")));
}

TEST_F(Frame, NonsenseIsBadUsage) {
    EXPECT_EQ(run("--domain KBGM -o " + out("a.jpeg")), exit_bad_usage);
    EXPECT_EQ(run("--domain KBGM --time noon -o " + out("a.png")), exit_bad_usage);
    EXPECT_EQ(run("--domain KBGM --tilt 100 -o " + out("a.png")), exit_bad_usage);
    EXPECT_EQ(run("--domain KBGM --width 100 -o " + out("a.png")), exit_bad_usage)
        << "too small for labels";
    EXPECT_EQ(run("--domain KBGM --width 100 --no-labels -o " + out("a.png")), exit_done);
}

TEST_F(Frame, FailuresNameTheFile) {
    EXPECT_EQ(run("--domain KBGM -o " + out("no/such/a.png")), exit_failed);
    EXPECT_THAT(messages_, ::testing::HasSubstr("no/such"));
}

}  // namespace
}  // namespace stormcellar::cli
