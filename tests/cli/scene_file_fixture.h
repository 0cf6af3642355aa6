// tests/cli/scene_file_fixture.h -- a scene file, a grid to draw, and the commands that use them.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "cli/picture/scene_file.h"
#include "stormcellar/base/file_system.h"
#include "tests/cli/run_in_process.h"
#include "tests/cli/uniform_grid.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {

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
    // Returns the error for this scene file, without the directory, which differs in each run.
    std::string complaint(const std::string& text) {
        const Status status = read(text);
        if (status) return "no complaint";
        EXPECT_EQ(status.error().code, ErrorCode::bad_argument);
        const std::string directory = directory_.path().native() + "/";
        EXPECT_TRUE(status.error().message.starts_with(directory)) << status.error().message;
        return status.error().message.substr(directory.size());
    }
    void commit() {
        auto store = cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
        ASSERT_TRUE(store) << store.error().message;
        testing::commit_grid(*store, testing::uniform_grid("20050822_024400", 33));
    }
    static testing::ProgramResult run(const std::string& arguments) {
        return run_in_process(arguments);
    }
    [[nodiscard]] std::string cache() const { return (directory_ / "cache").string(); }
    [[nodiscard]] std::string at(const std::string& name) const {
        return (directory_ / name).string();
    }

    testing::TemporaryDirectory directory_;
    AllSettings settings_;
};

}  // namespace stormcellar::cli
