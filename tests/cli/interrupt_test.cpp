#include "cli/shared/interrupt.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/shared/progress.h"
#include "cli/shared/scratch_directory.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

TEST(Interrupt, FirstSignalOnlySetsTheFlag) {
    const Interrupt interrupt;
    EXPECT_FALSE(interrupt.flag());
    ::raise(SIGTERM);
    EXPECT_TRUE(interrupt.flag());
}

TEST(Interrupt, StartsAnewEachTime) {
    {
        const Interrupt interrupt;
        ::raise(SIGINT);
    }
    const Interrupt interrupt;
    EXPECT_FALSE(interrupt.flag());
}

TEST(InterruptDeathTest, SecondSignalEndsTheProgram) {
    EXPECT_EXIT(
        {
            const Interrupt interrupt;
            ::raise(SIGINT);
            ::raise(SIGINT);
        },
        ::testing::KilledBySignal(SIGINT), "");
}

TEST(InterruptDeathTest, EndsByTheSignalThatCame) {
    EXPECT_EXIT(
        {
            Interrupt interrupt;
            ::raise(SIGTERM);
            interrupt.end_by_signal();
        },
        ::testing::KilledBySignal(SIGTERM), "");
}

TEST(Interrupt, EndBySignalReturnsWhenNoneCame) {
    Interrupt interrupt;
    interrupt.end_by_signal();
    EXPECT_FALSE(interrupt.flag());
}

TEST(Interrupt, IgnoredSignalStaysIgnored) {
    ::signal(SIGHUP, SIG_IGN);
    {
        const Interrupt interrupt;
        ::raise(SIGHUP);
        EXPECT_FALSE(interrupt.flag());
    }
    ::raise(SIGHUP);
    ::signal(SIGHUP, SIG_DFL);
}

// Makes a scratch directory with a file in it, writes its path to the file `name` for the parent
// process, and raises the signal.
void make_scratch_and_raise(int number, const fs::path& name) {
    const auto scratch = ScratchDirectory::make();
    std::ofstream(scratch->path() / "output.webp") << "half";
    fs::create_directory(scratch->path() / "frames");
    std::ofstream(name) << scratch->path().native();
    ::raise(number);
}

class ScratchDirectoryDeathTest : public ::testing::Test {
  protected:
    [[nodiscard]] fs::path made() const {
        std::string text;
        std::getline(std::ifstream(directory_ / "name"), text);
        return text;
    }
    testing::TemporaryDirectory directory_;
};

TEST_F(ScratchDirectoryDeathTest, EverySignalThatEndsTheProgramRemovesIt) {
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
        EXPECT_EXIT(make_scratch_and_raise(number, directory_ / "name"),
                    ::testing::KilledBySignal(number), "");
        ASSERT_FALSE(made().empty());
        EXPECT_FALSE(fs::exists(made())) << number;
    }
}

TEST_F(ScratchDirectoryDeathTest, ASecondSignalBesideAnInterruptRemovesItToo) {
    EXPECT_EXIT(
        {
            const auto scratch = ScratchDirectory::make();
            std::ofstream(directory_ / "name") << scratch->path().native();
            const Interrupt interrupt;
            ::raise(SIGINT);
            ::raise(SIGINT);
        },
        ::testing::KilledBySignal(SIGINT), "");
    ASSERT_FALSE(made().empty());
    EXPECT_FALSE(fs::exists(made()));
}

// 2026-11-29: a signal that came before the program watched for signals left a new directory
// behind.
TEST(ScratchDirectory, IsRemovedByASignalThatComesAtOnce) {
    const testing::TemporaryDirectory directory;
    ::setenv("TMPDIR", directory.path().c_str(), 1);
    for (int round = 0; round < 300; ++round) {
        const pid_t child = ::fork();
        if (child == 0) {
            const auto scratch = ScratchDirectory::make();
            for (;;)
                ::pause();
        }
        while (fs::is_empty(directory.path())) {
        }
        ::kill(child, SIGINT);
        int status = 0;
        ::waitpid(child, &status, 0);
        EXPECT_TRUE(WIFSIGNALED(status));
        ASSERT_TRUE(fs::is_empty(directory.path())) << "round " << round;
    }
    ::unsetenv("TMPDIR");
}

TEST(ScratchDirectory, GoesWithItsObject) {
    fs::path path;
    {
        auto scratch = ScratchDirectory::make();
        ASSERT_TRUE(scratch);
        const ScratchDirectory moved = std::move(*scratch);
        path = moved.path();
        EXPECT_TRUE(fs::is_directory(path));
    }
    EXPECT_FALSE(fs::exists(path));
}

TEST(ProgressLine, SaysRateAndTimeLeftOnceTheyAreKnown) {
    EXPECT_EQ(progress_line("frames", 0, 12, 5), "frames [........................]  0/12");
    EXPECT_EQ(progress_line("frames", 6, 12, 0.5), "frames [############............]  6/12");
    EXPECT_EQ(progress_line("frames", 6, 12, 3),
              "frames [############............]  6/12, 2.0 a second, 3 s left");
    EXPECT_EQ(progress_line("files", 1, 241, 30),
              "files [........................]   1/241, 2.0 a minute, 2 h 0 min left");
    EXPECT_EQ(progress_line("files", 10, 100, 60),
              "files [##......................]  10/100, 10.0 a minute, 9 min left");
    EXPECT_EQ(progress_line("frames", 12, 12, 60), "frames [########################] 12/12");
}

}  // namespace
}  // namespace stormcellar::cli
