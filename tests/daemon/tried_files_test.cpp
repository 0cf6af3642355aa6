// Tests how the service treats files that it was ingesting when the process ended.
#include "daemon/queue/tried_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/base/file_system.h"
#include "tests/daemon/write_file.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

class TriedFilesTest : public ::testing::Test {
  protected:
    fs::path make(const char* name) {
        write_file(directory_ / name, name);
        return directory_ / name;
    }
    // The process ends while it ingests both files.
    void end_under_way(const fs::path& a, const fs::path& b) const {
        TriedFiles tried(file());
        tried.begin(a, stamp(a));
        tried.begin(b, stamp(b));
    }
    static FileStamp stamp(const fs::path& path) { return look_at(path).stamp; }
    [[nodiscard]] fs::path file() const { return directory_ / "tried"; }
    testing::TemporaryDirectory directory_;
};

TEST_F(TriedFilesTest, WhatWasUnderWayWaitsLongerEachTimeAndIsGivenUp) {
    const fs::path bomb = make("bomb"), good = make("good\nname");
    EXPECT_THAT(TriedFiles(file()).waits(), IsEmpty());
    for (const int wait : {2, 8, 32, 128, 512, 0}) {
        {
            TriedFiles tried(file());
            EXPECT_FALSE(tried.is_given_up(bomb, stamp(bomb)));
            tried.begin(good, stamp(good));
            tried.begin(bomb, stamp(bomb));
            tried.end(good);
        }  // the process ends
        if (wait == 0) break;
        EXPECT_THAT(TriedFiles(file()).waits(), ElementsAre(Pair(bomb, seconds{wait})));
    }
    EXPECT_THAT(TriedFiles(file()).waits(), IsEmpty()) << "a file that was given up does not wait";
    EXPECT_TRUE(TriedFiles(file()).is_given_up(bomb, stamp(bomb)));
    write_file(bomb, "another one");
    TriedFiles tried(file());
    EXPECT_FALSE(tried.is_given_up(bomb, stamp(bomb)));
    tried.begin(bomb, stamp(bomb));
    tried.end(bomb);
    EXPECT_THAT(TriedFiles(file()).waits(), IsEmpty());
}

// 2026-11-28: if one of several files that were ingested together ended the process, all these
// files waited equally long. So they were ingested together again, until all were given up.
TEST_F(TriedFilesTest, WhatRanTogetherIsTriedApart) {
    const fs::path bomb = make("bomb"), good = make("good");
    end_under_way(bomb, good);
    EXPECT_THAT(TriedFiles(file()).waits(),
                ElementsAre(Pair(bomb, seconds{2}), Pair(good, seconds{12})));
}

TEST_F(TriedFilesTest, AStartBetweenDoesNotCount) {
    const fs::path bomb = make("bomb");
    TriedFiles(file()).begin(bomb, stamp(bomb));
    for (int i = 0; i < 3; ++i)
        EXPECT_THAT(TriedFiles(file()).waits(), ElementsAre(Pair(bomb, seconds{2})));
    fs::remove(bomb);
    EXPECT_THAT(TriedFiles(file()).waits(), IsEmpty());
}

// 2026-11-28: the process was killed between writing a list and truncating its file, and the next
// start took the rest of the old list for files that were being ingested.
TEST_F(TriedFilesTest, TheRestOfAnOlderListDoesNotCount) {
    const fs::path first = make("first"), second = make("second");
    end_under_way(first, second);
    const auto older = read_file(file());
    ASSERT_TRUE(older);
    fs::remove(file());
    TriedFiles(file()).begin(first, stamp(first));
    const auto newer = read_file(file());
    ASSERT_TRUE(newer);
    ASSERT_LT(newer->size(), older->size());
    std::string both;
    for (const auto* bytes : {&*newer, &*older})
        both.append(reinterpret_cast<const char*>(bytes->data()) + both.size(),
                    bytes->size() - both.size());
    write_file(file(), both);
    EXPECT_THAT(TriedFiles(file()).waits(), ElementsAre(Pair(first, seconds{2})));
}

TEST_F(TriedFilesTest, WhatMakesNoSenseIsPassedOver) {
    const fs::path there = make("there");
    using namespace std::string_literals;
    for (const std::string& text : {"x"s, "1 1 1 1 "s, "\0\0\0"s, std::string(2'000'000, '1'),
                                    "1 1 1 "s + there.native() + "\0"s,
                                    "-1 1 99999999999999999999 1 "s + there.native() + "\0"s}) {
        write_file(file(), text);
        EXPECT_THAT(TriedFiles(file()).waits(), IsEmpty());
    }
    const TriedFiles nowhere(directory_ / "none/tried");
    EXPECT_THAT(nowhere.waits(), IsEmpty());
}

}  // namespace
}  // namespace stormcellar::daemon
