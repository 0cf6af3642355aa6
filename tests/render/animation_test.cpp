#include "stormcellar/render/animation.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/animation/animation_format.h"
#include "tests/render/decoded_animation.h"
#include "tests/testing/power_cut_file_system.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::render {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Animation : public ::testing::TestWithParam<std::string> {
  protected:
    [[nodiscard]] std::string path() const { return (directory_ / GetParam()).string(); }
    [[nodiscard]] std::size_t entry_count() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(directory_.path()), fs::directory_iterator()));
    }
    static std::string contents(const fs::path& file) {
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    // Returns all files of an output, one after the other.
    static std::string all_of(const fs::path& output) {
        if (!fs::is_directory(output)) return contents(output);
        std::vector<fs::path> files(fs::directory_iterator(output), fs::directory_iterator{});
        std::sort(files.begin(), files.end());
        std::string all;
        for (const auto& file : files)
            all += contents(file);
        return all;
    }
    testing::TemporaryDirectory directory_;
};

TEST_P(Animation, UnfinishedLeavesNothingBehind) {
    {
        const auto writer = AnimationWriter::create(path(), {});
        ASSERT_TRUE(writer) << writer.error().message;
        for (const Image& frame : test_frames(3))
            ASSERT_TRUE((*writer)->add(frame));
        EXPECT_FALSE(fs::exists(path()));
    }
    EXPECT_EQ(entry_count(), 0U);
}

TEST_P(Animation, AppearsAtFinishAloneAndReplacesTheOldOne) {
    write_animation(path(), test_frames(2));
    const std::string before = all_of(path());
    {
        const auto writer = AnimationWriter::create(path(), {});
        ASSERT_TRUE(writer);
        for (const Image& frame : test_frames(4))
            ASSERT_TRUE((*writer)->add(frame));
        EXPECT_EQ(all_of(path()), before);
        ASSERT_TRUE((*writer)->finish());
    }
    EXPECT_NE(all_of(path()), before);
    EXPECT_EQ(entry_count(), 1U);
}

TEST_P(Animation, FailureAtAnyPointLeavesTheOldOneOrTheNewOneWhole) {
    write_animation(path(), test_frames(2));
    const std::string before = all_of(path());
    testing::TemporaryDirectory other;
    const std::string reference = (other / GetParam()).string();
    write_animation(reference, test_frames(3));
    const std::string after = all_of(reference);
    bool whole_run = false;
    for (std::uint64_t operation = 0; operation < 100 && !whole_run; ++operation) {
        testing::PowerCutFileSystem failing;
        failing.fail_from(operation);
        whole_run = [&] {
            const auto writer = AnimationWriter::create(path(), {}, failing);
            if (!writer) return false;
            for (const Image& frame : test_frames(3)) {
                if (!(*writer)->add(frame)) return false;
            }
            return (*writer)->finish().has_value();
        }();
        // A directory takes two renames. If both the second rename and the rename back fail, the
        // old directory remains under its temporary name.
        if (!fs::exists(path())) {
            ASSERT_EQ(GetParam(), "frames/") << "after operation " << operation;
            for (const auto& entry : fs::directory_iterator(directory_.path())) {
                if (all_of(entry) == before) fs::rename(entry, directory_ / "frames");
            }
        }
        const std::string now = all_of(path());
        EXPECT_TRUE(now == before || now == after) << "after operation " << operation;
    }
    EXPECT_TRUE(whole_run);
    EXPECT_EQ(all_of(path()), after);
}

TEST_P(Animation, SameFramesGiveTheSameBytes) {
    write_animation(path(), test_frames(4));
    const std::string first = all_of(path());
    write_animation(path(), test_frames(4));
    EXPECT_EQ(all_of(path()), first);
}

TEST_P(Animation, FrameOfAnotherSizeIsRefusedForGood) {
    const auto writer = AnimationWriter::create(path(), {});
    ASSERT_TRUE(writer);
    ASSERT_TRUE((*writer)->add(test_frame(0)));
    const auto added = (*writer)->add(test_frame(0, 60, 43));
    ASSERT_FALSE(added);
    EXPECT_EQ(added.error().code, ErrorCode::bad_argument);
    EXPECT_THAT(added.error().message, HasSubstr("60 by 43 pixels cannot follow one of 61 by 43"));
    EXPECT_THAT(added.error().message, HasSubstr(directory_.path().native()));
    EXPECT_FALSE((*writer)->add(test_frame(0)));
    EXPECT_FALSE((*writer)->finish());
}

TEST_P(Animation, NoFrameIsAnError) {
    const auto writer = AnimationWriter::create(path(), {});
    ASSERT_TRUE(writer);
    const auto finished = (*writer)->finish();
    ASSERT_FALSE(finished);
    EXPECT_THAT(finished.error().message, HasSubstr("no frame"));
    EXPECT_FALSE(fs::exists(path()));
}

TEST_P(Animation, PlaceThatCannotBeWrittenIsKnownBeforeAnyFrame) {
    const auto writer = AnimationWriter::create((directory_ / "missing" / GetParam()).string(), {});
    ASSERT_FALSE(writer);
    EXPECT_EQ(writer.error().code, ErrorCode::not_found);
    EXPECT_THAT(writer.error().message, HasSubstr("missing"));
}

std::vector<std::string> outputs() {
    std::vector<std::string> names{"a.webp", "a.gif", "a.apng", "frames/"};
#if STORMCELLAR_VIDEO
    names.insert(names.end(), {"a.mp4", "a.webm"});
#endif
    return names;
}
INSTANTIATE_TEST_SUITE_P(Formats, Animation, ::testing::ValuesIn(outputs()),
                         [](const auto& parameter) {
                             return parameter.param == "frames/" ? "png"
                                                                 : parameter.param.substr(2);
                         });

TEST(AnimationName, NeedsAnEndingThatSomeBuildWrites) {
    for (const char* name : {"a.webp", "/b/a.gif", "a.apng", "a.mp4", "a.webm", "frames/"}) {
        EXPECT_TRUE(check_animation_name(name)) << name;
    }
    for (const char* name : {"a.xyz", "frames", "a.webp.txt", "a.WEBP", ""}) {
        const Status status = check_animation_name(name);
        ASSERT_FALSE(status) << name;
        EXPECT_EQ(status.error().code, ErrorCode::bad_argument);
        EXPECT_NE(status.error().message.find("this build writes .webp"), std::string::npos);
    }
    const Status directory = check_animation_name("/tmp");
    ASSERT_FALSE(directory);
    EXPECT_EQ(directory.error().message,
              "/tmp: is a directory; name it /tmp/ to write PNG files into it");
}

TEST(AnimationOutput, UnknownEndingIsRefusedWithThoseThatAreKnown) {
    const auto writer = AnimationWriter::create("/tmp/loop.avi", {});
    ASSERT_FALSE(writer);
    EXPECT_EQ(writer.error().code, ErrorCode::bad_argument);
    EXPECT_THAT(writer.error().message, HasSubstr("'.avi'"));
    EXPECT_THAT(writer.error().message, HasSubstr(".webp, .gif, .apng"));
}

#if !STORMCELLAR_VIDEO
TEST(AnimationOutput, BuildWithoutFfmpegSaysSo) {
    for (const char* name : {"a.mp4", "a.webm"}) {
        const auto writer = AnimationWriter::create(name, {});
        ASSERT_FALSE(writer);
        EXPECT_THAT(writer.error().message, HasSubstr("has no FFmpeg"));
    }
}
#endif

TEST(AnimationOutput, OptionsOutsideTheirRangeAreRefused) {
    const testing::TemporaryDirectory directory;
    const std::string output = (directory / "a.gif").string();
    for (const double rate : {0.0, 0.09, 61.0, std::nan("")}) {
        EXPECT_FALSE(AnimationWriter::create(output, {.frames_per_second = rate})) << rate;
    }
    for (const double dwell : {-1.0, 61.0, std::nan("")}) {
        EXPECT_FALSE(AnimationWriter::create(output, {.last_frame_dwell_s = dwell})) << dwell;
    }
}

TEST(AnimationTimes, RoundingDoesNotAddUp) {
    const AnimationOptions options{.frames_per_second = 7, .last_frame_dwell_s = 2};
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < 700; ++i) {
        EXPECT_NEAR(static_cast<double>(frame_start(options, i, 100)),
                    100.0 * static_cast<double>(i) / 7, 0.5);
        sum += frame_duration(options, i, i == 699, 100);
    }
    EXPECT_EQ(sum, 100 * 100 + 200);
}

}  // namespace
}  // namespace stormcellar::render
