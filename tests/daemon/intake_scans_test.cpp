// Tests scans, and files that no longer exist.
#include <gtest/gtest.h>

#include "tests/daemon/intake_fixture.h"

namespace stormcellar::daemon {
namespace {

using pipeline::IngestResult;
using std::chrono::seconds;

// If a directory is moved away, the kernel sends no events for its files.
TEST_F(IntakeTest, FollowedFilesGoWithTheirDirectory) {
    pipeline::IngestOutcome followed = outcome_of(IngestResult::incomplete);
    followed.ending = pipeline::ended::Incomplete{.is_followed = true};
    std::filesystem::create_directories(at("day"));
    for (const char* name : {"day/a", "day2"}) {
        intake_.file_closed(at(name), make(name));
        next();
        end(name, followed);
    }
    intake_.directory_gone(at("day"), false);
    EXPECT_FALSE(intake_.follows(at("day/a")));
    EXPECT_TRUE(intake_.follows(at("day2")));
    EXPECT_EQ(next(), "a") << "the rows of the file must be marked";
    EXPECT_TRUE(intake_.needs_scan())
        << "RowKeeper must mark the rows of files that are not followed";
    EXPECT_EQ(intake_.pending().growing, 1U);
}

TEST_F(IntakeTest, AScanFindsOutWhichFollowedFilesAreGone) {
    pipeline::IngestOutcome followed = outcome_of(IngestResult::incomplete);
    followed.ending = pipeline::ended::Incomplete{.is_followed = true};
    for (const char* name : {"a", "b"}) {
        intake_.file_closed(at(name), make(name));
        next();
        end(name, followed);
    }
    std::filesystem::remove(at("a"));
    intake_.begin_scan();
    intake_.end_scan(false);
    EXPECT_TRUE(intake_.follows(at("a"))) << "the drop directory could not be read";
    intake_.begin_scan();
    intake_.end_scan(true);
    EXPECT_FALSE(intake_.follows(at("a")));
    EXPECT_TRUE(intake_.follows(at("b")));
}

TEST_F(IntakeTest, ProblemsAreGivenOnceAsLongAsScansFindThem) {
    const auto scan = [&](bool finds) {
        intake_.begin_scan();
        if (finds) {
            intake_.entry_left_out(at("link\n"), "a symbolic link");
            intake_.directory_problem({ErrorCode::io, "closed: no"});
        }
        intake_.end_scan(true);
        return intake_.take_directory_problems();
    };
    const auto first = scan(true);
    ASSERT_EQ(first.size(), 2U);
    EXPECT_EQ(first[0].code, ErrorCode::not_a_file);
    EXPECT_EQ(first[0].message, at("link\n").native() + ": is a symbolic link, so it is not read");
    EXPECT_TRUE(scan(true).empty());
    EXPECT_TRUE(scan(false).empty());
    EXPECT_EQ(scan(true).size(), 2U) << "the entries vanished and came back";
    intake_.begin_scan();
    for (int i = 0; i < 100'000; ++i)
        intake_.entry_left_out(at(std::to_string(i).c_str()), "a FIFO");
    intake_.end_scan(true);
    EXPECT_EQ(intake_.take_directory_problems().size(), 64U) << "the number of problems is limited";
}

TEST_F(IntakeTest, WhatAScanFindsIsLiveWhenItIsYoung) {
    FileStamp young = make("KTLX20240101_000000");
    young.modified_ns = wall_ns_ - 599 * second_ns;
    FileStamp old = make("KTLX20230101_000000");
    old.modified_ns = wall_ns_ - 601 * second_ns;
    intake_.file_found(at("KTLX20230101_000000"), old);
    intake_.file_found(at("KTLX20240101_000000"), young);
    const auto first = intake_.next_job();
    const auto second = intake_.next_job();
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->urgency, Urgency::live);
    EXPECT_EQ(first->station, "KTLX");
    EXPECT_EQ(second->urgency, Urgency::backlog);
}

TEST_F(IntakeTest, ScansOfferAFileOnceUntilItChanges) {
    const FileStamp stamp = make("a");
    intake_.begin_scan();
    intake_.file_found(at("a"), stamp);
    intake_.end_scan(true);
    EXPECT_EQ(next(), "a");
    end("a", IngestResult::rejected);
    for (int i = 0; i < 3; ++i) {
        intake_.begin_scan();
        intake_.file_found(at("a"), stamp);
        intake_.end_scan(true);
        EXPECT_EQ(next(), "");
    }
    intake_.begin_scan();
    intake_.file_found(at("a"), {stamp.inode, stamp.size_bytes + 1, stamp.modified_ns});
    EXPECT_EQ(next(), "a");
}

TEST_F(IntakeTest, AFileWrittenThisMomentIsLeftToRest) {
    FileStamp stamp = make("a");
    stamp = look_at(at("a")).stamp;
    wall_ns_ = stamp.modified_ns + second_ns / 10;
    intake_.file_found(at("a"), stamp);
    EXPECT_EQ(next(), "");
    now_ += seconds{1};
    intake_.poll_growing();
    EXPECT_EQ(next(), "a");
}

// A clock that was set back must not make files wait forever.
TEST_F(IntakeTest, AFileFromTheFutureIsTakenAtOnce) {
    FileStamp stamp = make("a");
    stamp.modified_ns = wall_ns_ + 3600 * second_ns;
    intake_.file_found(at("a"), stamp);
    EXPECT_EQ(next(), "a");
}

TEST_F(IntakeTest, WhatDoesNotFitIsFoundByAScanOnceThereIsRoom) {
    const FileStamp stamp = make("x");
    intake_.begin_scan();
    for (const char* name : {"a", "b", "c", "d", "e"})
        intake_.file_found(at(name), stamp);
    intake_.end_scan(true);
    EXPECT_FALSE(intake_.needs_scan()) << "the queue is still full";
    for (const char* name : {"a", "b", "c"}) {
        ASSERT_EQ(next(), name);
        end(name, IngestResult::gridded);
    }
    EXPECT_TRUE(intake_.needs_scan());
    intake_.begin_scan();
    for (const char* name : {"a", "b", "c", "d", "e"})
        intake_.file_found(at(name), stamp);
    intake_.end_scan(true);
    EXPECT_FALSE(intake_.needs_scan());
    EXPECT_EQ(next(), "d");
    EXPECT_EQ(next(), "e");
    EXPECT_EQ(next(), "") << "ingested files are not offered again";
}

TEST_F(IntakeTest, LostEventsCallForAScan) {
    EXPECT_FALSE(intake_.needs_scan());
    intake_.events_lost();
    EXPECT_TRUE(intake_.needs_scan());
    EXPECT_EQ(intake_.take_overflows(), 1U);
    EXPECT_EQ(intake_.take_overflows(), 0U);
    intake_.begin_scan();
    EXPECT_FALSE(intake_.needs_scan());
}

TEST_F(IntakeTest, AScanOfAVanishedDropDirectoryForgetsNothing) {
    const FileStamp stamp = make("a");
    intake_.file_found(at("a"), stamp);
    ASSERT_EQ(next(), "a");
    end("a", IngestResult::gridded);
    intake_.begin_scan();
    intake_.end_scan(false);
    intake_.begin_scan();
    intake_.file_found(at("a"), stamp);
    EXPECT_EQ(next(), "");
}

TEST_F(IntakeTest, AFileThatWentIsLookedAtLastSoThatItsRowsAreMarked) {
    intake_.file_gone(at("gone"));
    intake_.file_found(at("old"), make("old"));
    EXPECT_EQ(next(), "old");
    EXPECT_EQ(next(), "gone");
    end("gone", IngestResult::vanished);
    EXPECT_EQ(intake_.pending().running, 1U);
}

// 2026-11-22: a volume of chunks waited until the next start if its newest chunk was deleted.
TEST_F(IntakeTest, OneThatWentIsAskedForAgainWhereAVolumeWaitsInItsName) {
    intake_.file_closed(at("a"), make("a"));
    ASSERT_EQ(next(), "a");
    end("a", IngestResult::incomplete);
    std::filesystem::remove(at("a"));
    intake_.file_gone(at("a"));
    EXPECT_EQ(next(), "a");
    end("a", IngestResult::incomplete);
    for (int second = 0; second < 30; ++second) {
        intake_.poll_growing();
        ASSERT_EQ(next(), "") << second;
        now_ += seconds{1};
    }
    intake_.poll_growing();
    EXPECT_EQ(next(), "a!");
    end("a", IngestResult::gridded);
    EXPECT_EQ(intake_.pending(), Pending{});
}

// 2026-11-22: an entry that could not be examined waited for the next regular scan.
TEST_F(IntakeTest, WhatCouldNotBeLookedAtIsLookedForSoon) {
    EXPECT_FALSE(intake_.look_again_at());
    intake_.entry_unseen();
    intake_.entry_unseen();
    EXPECT_EQ(intake_.take_unseen(), 2U);
    EXPECT_EQ(intake_.take_unseen(), 0U);
    EXPECT_FALSE(intake_.needs_scan()) << "a scan at once would fail, too";
    EXPECT_EQ(intake_.look_again_at(), now_ + seconds{1});
    now_ += seconds{1};
    EXPECT_TRUE(intake_.needs_scan());
    // Two scans fail: the first reads nothing, and the second reads only a part.
    intake_.begin_scan();
    EXPECT_FALSE(intake_.needs_scan());
    intake_.end_scan(false);
    EXPECT_EQ(intake_.look_again_at(), now_ + seconds{2});
    now_ += seconds{2};
    intake_.begin_scan();
    intake_.entry_unseen();
    intake_.end_scan(true);
    EXPECT_EQ(intake_.look_again_at(), now_ + seconds{4});
    now_ += seconds{4};
    intake_.begin_scan();
    intake_.end_scan(true);
    EXPECT_FALSE(intake_.look_again_at());
    EXPECT_FALSE(intake_.needs_scan());
    // After a success, the delay of retries begins at one second again. A missing drop directory
    // requests no retry.
    intake_.begin_scan();
    intake_.end_scan(false);
    EXPECT_FALSE(intake_.look_again_at());
    intake_.entry_unseen();
    EXPECT_EQ(intake_.look_again_at(), now_ + seconds{1});
}
}  // namespace
}  // namespace stormcellar::daemon
