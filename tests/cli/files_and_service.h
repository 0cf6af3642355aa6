// tests/cli/files_and_service.h -- real volumes as files, and the directories of a service that can
// ingest them.
#pragma once

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/cli/run_stormcellar.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"

namespace stormcellar::cli {

// A fixture that skips its tests if the real volumes are not available.
class FilesAndService : public ::testing::Test {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        data_ = *testing::data_directory();
        std::ofstream(directory_ / "config.toml")
            << "[paths]\ndrop = \"drop\"\nstate = \"state\"\ncache = \"cache\"\n";
    }

    // Returns a path in the test's own directory, where config.toml is.
    [[nodiscard]] std::string out(const std::string& name) const {
        return (directory_ / name).native();
    }

    // Runs the daemon on a copy of the raw file until the cache has a grid made from it.
    void ingest(const std::string& file) {
        fs::create_directories(directory_ / "drop");
        fs::copy_file(file, directory_ / "drop" / fs::path(file).filename());
        testing::RunningProgram daemon(STORMCELLARD, {"--config", out("config.toml")});
        ASSERT_TRUE(testing::eventually([&] {
            return fs::is_directory(directory_ / "cache") &&
                   run({"cache", "list", "--cache", out("cache")}).status == 0;
        })) << daemon.err();
        EXPECT_EQ(daemon.end(SIGTERM), 0);
    }

    testing::TemporaryDirectory directory_;
    fs::path data_;
};

}  // namespace stormcellar::cli
