// tests/cli/loop_fixture.h -- a cache of small grids, and runs of `stormcellar loop` as a user
// starts it.
#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/cli/run_stormcellar.h"
#include "tests/cli/uniform_grid.h"
#include "tests/testing/file_bytes.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {

class Loop : public ::testing::Test {
  protected:
    fs::path commit(const std::string& compact_time, float dbz, int cells = 40) {
        grid::Grid grid = testing::uniform_grid(compact_time, dbz, cells);
        grid.start_time = grid.end_time = grid.time;
        return grids_.emplace_back(testing::commit_grid(store_, grid));
    }
    // Returns the path of the grid for this many minutes after 3 UTC.
    [[nodiscard]] fs::path path_at_minute(int minutes) const {
        const UtcTime time = parse_compact("20050822_030000").value();
        return store_.path_of("KBGM", level2::Moment::ref, time + std::chrono::minutes{minutes})
            .value();
    }
    void commit_three() {
        commit("20050822_024400", 22);
        commit("20050822_025000", 33);
        commit("20050822_025600", 44);
    }
    static bool has(const Words& arguments, const char* option) {
        return std::find(arguments.begin(), arguments.end(), option) != arguments.end();
    }
    testing::ProgramResult run(Words arguments) const {
        // Draw a volume with few slices, which is quick. Other products have no slices, and a
        // tolerance chooses the number of slices.
        if (!has(arguments, "--product") && !has(arguments, "--tolerance")) {
            arguments.insert(arguments.begin(), {"--slices", "16"});
        }
        arguments.insert(arguments.begin(), {"loop", "--cache", (directory_ / "cache").string()});
        return testing::run_stormcellar(arguments);
    }
    [[nodiscard]] std::string out(const std::string& name) const {
        return (directory_ / "out" / name).string();
    }
    [[nodiscard]] Words written() const {
        Words names;
        for (const auto& entry : fs::directory_iterator(directory_ / "out"))
            names.push_back(entry.path().filename());
        std::sort(names.begin(), names.end());
        return names;
    }
    void SetUp() override { fs::create_directory(directory_ / "out"); }

    testing::TemporaryDirectory directory_;
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
    std::vector<fs::path> grids_;
};

// Returns the texts of a PNG or APNG, by keyword.
inline std::map<std::string, std::string> png_texts(const std::string& path) {
    const std::string all = testing::file_text(path);
    std::map<std::string, std::string> texts;
    for (std::size_t at = 8; at + 12 <= all.size();) {
        const auto byte = [&](std::size_t i) {
            return static_cast<std::size_t>(static_cast<unsigned char>(all[at + i]));
        };
        const std::size_t length = byte(0) << 24U | byte(1) << 16U | byte(2) << 8U | byte(3);
        const std::string data = all.substr(at + 8, length);
        if (all.substr(at + 4, 4) == "tEXt") {
            texts[data.substr(0, data.find('\0'))] = data.substr(data.find('\0') + 1);
        }
        at += 12 + length;
    }
    return texts;
}

}  // namespace stormcellar::cli
