#include "synth/write_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::synth {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

Scene small_storm(int count) {
    auto scene = read_scene(testing::source_directory() / "scenes/small-storm.toml");
    if (!scene) throw std::runtime_error(scene.error().message);
    scene->schedule.count = count;
    return std::move(*scene);
}

std::vector<std::byte> bytes_of(const fs::path& path) {
    auto bytes = read_file(path);
    return bytes ? *bytes : std::vector<std::byte>{};
}

TEST(WriteScene, GivesTheSameFilesWhateverTheThreads) {
    const testing::TemporaryDirectory directory;
    const Scene scene = small_storm(4);
    const auto alone = write_scene(scene, directory / "new/one", real_file_system());
    ASSERT_TRUE(alone) << alone.error().message;
    WriteSceneOptions options;
    options.threads = 4;
    const auto together = write_scene(scene, directory / "four", real_file_system(), options);
    ASSERT_TRUE(together) << together.error().message;
    const fs::path one = directory / "new/one";
    EXPECT_THAT(alone->files,
                ElementsAre(one / "XSYN20240601_220000_V06", one / "XSYN20240601_220100_V06",
                            one / "XSYN20240601_220200_V06", one / "XSYN20240601_220300_V06"));
    ASSERT_EQ(together->files.size(), 4U);
    EXPECT_EQ(alone->bytes, together->bytes);
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto expected = bytes_of(alone->files[i]);
        bytes += expected.size();
        EXPECT_EQ(together->files[i].filename(), alone->files[i].filename());
        EXPECT_EQ(bytes_of(together->files[i]), expected);
    }
    EXPECT_EQ(bytes, alone->bytes);
    EXPECT_FALSE(alone->stopped);
}

TEST(WriteScene, StopsBetweenVolumesAndKeepsThoseThatAreWhole) {
    const testing::TemporaryDirectory directory;
    std::atomic<bool> stop{false};
    WriteSceneOptions options;
    options.stop = &stop;
    options.written = [&](const fs::path&) { stop = true; };
    const auto written = write_scene(small_storm(3), directory.path(), real_file_system(), options);
    ASSERT_TRUE(written);
    EXPECT_TRUE(written->stopped);
    ASSERT_EQ(written->files.size(), 1U);
    EXPECT_EQ(bytes_of(written->files[0]).size(), written->bytes);
    std::size_t entries = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(directory.path()))
        ++entries;
    EXPECT_EQ(entries, 1U) << "nothing half written is left";
}

TEST(WriteScene, NamesWhatCannotBeWritten) {
    const testing::TemporaryDirectory directory;
    const auto file = write_file_atomically(real_file_system(), directory / "file", {});
    ASSERT_TRUE(file);
    const auto written =
        write_scene(small_storm(2), directory / "file" / "below", real_file_system());
    ASSERT_FALSE(written);
    EXPECT_THAT(written.error().message, ::testing::HasSubstr("file/below"));
}

}  // namespace
}  // namespace stormcellar::synth
