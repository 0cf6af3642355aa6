#include "daemon/intake.h"

#include <gtest/gtest.h>

#include "tests/daemon/fake_sink.h"
#include "tests/daemon/write_file.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

using pipeline::IngestResult;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::int64_t second_ns = 1'000'000'000;

// Time stands still unless the test moves it.
class IntakeTest : public ::testing::Test {
  protected:
    static Config config() {
        Config made;
        made.quiet = seconds{30};
        made.reread = milliseconds{500};
        made.queue_limit = 4;
        return made;
    }
    [[nodiscard]] std::filesystem::path at(const char* name) const { return directory_ / name; }
    // A file of which the intake may read the stamp; written long ago.
    FileStamp make(const char* name, std::string_view text = "1") {
        write_file(at(name), text);
        FileStamp stamp = look_at(at(name)).stamp;
        stamp.modified_ns -= 100 * second_ns;
        return stamp;
    }
    std::string next() {
        const auto job = intake_.next_job();
        if (!job) return "";
        return job->path.filename().native() + (job->finish_partial ? "!" : "");
    }
    void end(const char* name, Result<pipeline::IngestOutcome> outcome) {
        Finished finished{.job = {}, .taken = Taken{}, .started = now_, .ended = now_};
        finished.job.path = at(name);
        if (outcome) {
            finished.taken = Taken{look_at(at(name)).stamp, *outcome};
        } else {
            finished.taken = tl::unexpected<Error>(outcome.error());
        }
        intake_.job_ended(finished);
    }
    void end(const char* name, IngestResult result) { end(name, outcome_of(result)); }

    testing::TemporaryDirectory directory_;
    SteadyTime now_ = SteadyTime{} + std::chrono::hours{1};
    std::int64_t wall_ns_ = 1'900'000'000 * second_ns;
    Intake intake_{config(), {[this] { return now_; }, [this] { return wall_ns_; }}};
};

TEST_F(IntakeTest, AClosedFileIsAJobAtOnceWithTheTimeOfItsClose) {
    intake_.file_closed(at("a"), make("a"));
    const auto job = intake_.next_job();
    ASSERT_TRUE(job);
    EXPECT_EQ(job->closed_at, now_);
    end("a", IngestResult::gridded);
    EXPECT_EQ(next(), "");
}

TEST_F(IntakeTest, AFollowedFileIsReadAtEveryWriteWithoutAPause) {
    pipeline::IngestOutcome followed = outcome_of(IngestResult::incomplete);
    followed.followed = true;
    intake_.file_closed(at("a"), make("a"));
    EXPECT_FALSE(intake_.follows(at("a")));
    EXPECT_EQ(next(), "a");
    end("a", followed);
    EXPECT_TRUE(intake_.follows(at("a")));
    EXPECT_EQ(next(), "");
    intake_.file_grew(at("a"), make("a", "12"));
    const auto job = intake_.next_job();
    ASSERT_TRUE(job);
    EXPECT_EQ(job->closed_at, now_);
    intake_.file_grew(at("a"), make("a", "123"));  // while it is read
    end("a", followed);
    EXPECT_EQ(next(), "a");
    // One that must be read from its start each time has to wait.
    end("a", IngestResult::incomplete);
    EXPECT_FALSE(intake_.follows(at("a")));
    intake_.file_closed(at("a"), make("a", "1234"));
    EXPECT_EQ(next(), "");
    now_ += milliseconds{500};
    EXPECT_EQ(next(), "a");
    end("a", followed);
    intake_.file_gone(at("a"));
    EXPECT_FALSE(intake_.follows(at("a")));
}

// Of the files in a directory that is moved away the kernel says nothing.
TEST_F(IntakeTest, FollowedFilesGoWithTheirDirectory) {
    pipeline::IngestOutcome followed = outcome_of(IngestResult::incomplete);
    followed.followed = true;
    std::filesystem::create_directories(at("day"));
    for (const char* name : {"day/a", "day2"}) {
        intake_.file_closed(at(name), make(name));
        next();
        end(name, followed);
    }
    intake_.directory_gone(at("day"), false);
    EXPECT_FALSE(intake_.follows(at("day/a")));
    EXPECT_TRUE(intake_.follows(at("day2")));
    EXPECT_EQ(next(), "a") << "so that its rows are marked";
    EXPECT_TRUE(intake_.needs_scan()) << "for the rows of those of which nothing is known";
    EXPECT_EQ(intake_.pending().growing, 1U);
}

TEST_F(IntakeTest, AScanFindsOutWhichFollowedFilesAreGone) {
    pipeline::IngestOutcome followed = outcome_of(IngestResult::incomplete);
    followed.followed = true;
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
    EXPECT_EQ(first[0].message, at("link\n").native() + ": is a symbolic link: left out");
    EXPECT_TRUE(scan(true).empty());
    EXPECT_TRUE(scan(false).empty());
    EXPECT_EQ(scan(true).size(), 2U) << "they went and came again";
    intake_.begin_scan();
    for (int i = 0; i < 100'000; ++i)
        intake_.entry_left_out(at(std::to_string(i).c_str()), "a FIFO");
    intake_.end_scan(true);
    EXPECT_EQ(intake_.take_directory_problems().size(), 64U) << "bounded";
}

// Somebody sets the clock, or the machine starts without one: no order, wait or file is lost.
TEST_F(IntakeTest, AClockThatIsSetBackKeepsTheOrderOfWhatIsClosed) {
    intake_.file_closed(at("first"), make("first"));
    wall_ns_ -= 3600 * second_ns;
    intake_.file_closed(at("second"), make("second"));
    wall_ns_ = 0;
    intake_.file_closed(at("third"), make("third"));
    EXPECT_EQ(next(), "third");
    EXPECT_EQ(next(), "second");
    EXPECT_EQ(next(), "first");
}

TEST_F(IntakeTest, AClockThatJumpsChangesNoWait) {
    for (const std::int64_t jump_ns :
         {-40 * 365 * 86'400 * second_ns, 3600 * second_ns, 40 * 365 * 86'400 * second_ns}) {
        intake_.file_closed(at("a"), make("a"));
        EXPECT_EQ(next(), "a");
        end("a", IngestResult::incomplete);
        wall_ns_ += jump_ns;
        now_ += seconds{29};
        intake_.poll_growing();
        EXPECT_EQ(next(), "") << "29 s have passed, whatever the wall says";
        now_ += seconds{2};
        intake_.poll_growing();
        EXPECT_EQ(next(), "a!") << "and now 31";
        end("a", IngestResult::gridded);
    }
}

// A time of the year 2100 would put a backlog before all that comes until then.
TEST_F(IntakeTest, FilesFromTheFutureGoBeforeNothingThatIsClosedNow) {
    FileStamp stamp = make("future");
    stamp.modified_ns = wall_ns_ + 70LL * 365 * 86'400 * second_ns;
    intake_.file_found(at("future"), stamp);
    now_ += seconds{1};
    wall_ns_ += second_ns;
    intake_.file_closed(at("new"), make("new"));
    EXPECT_EQ(next(), "new");
    EXPECT_EQ(next(), "future");
}

TEST_F(IntakeTest, WhatIsClosedNowGoesBeforeTheBacklog) {
    intake_.file_found(at("old"), make("old"));
    intake_.file_closed(at("new"), make("new"));
    EXPECT_EQ(next(), "new");
    EXPECT_EQ(next(), "old");
}

TEST_F(IntakeTest, OneChunkOfAVolumeIsWaitedForTheNewest) {
    intake_.file_closed(at("a"), make("a"));
    ASSERT_EQ(next(), "a");
    end("a", IngestResult::incomplete);
    EXPECT_EQ(intake_.pending().growing, 1U);
    pipeline::IngestOutcome newer = outcome_of(IngestResult::incomplete);
    newer.instead_of = at("a");
    intake_.file_closed(at("b"), make("b"));
    ASSERT_EQ(next(), "b");
    end("b", newer);
    EXPECT_EQ(intake_.pending().growing, 1U);
    now_ += seconds{30};
    intake_.poll_growing();
    EXPECT_EQ(next(), "b!");
    EXPECT_EQ(next(), "");
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

// The end of a volume, while the station's next one comes and another station sends much.
TEST_F(IntakeTest, TheEndOfAVolumeWaitsForOneTurnOfItsStation) {
    pipeline::IngestOutcome followed = outcome_of(IngestResult::incomplete);
    followed.followed = true;
    intake_.file_closed(at("KTLX20240101_000000"), make("KTLX20240101_000000"));
    ASSERT_EQ(next(), "KTLX20240101_000000");
    end("KTLX20240101_000000", followed);
    intake_.file_grew(at("KTLX20240101_000000"), make("KTLX20240101_000000", "12"));
    wall_ns_ += second_ns;
    intake_.file_closed(at("KTLX20240101_000500"), make("KTLX20240101_000500"));
    intake_.file_closed(at("KFWS20240101_000000"), make("KFWS20240101_000000"));
    wall_ns_ += second_ns;
    intake_.file_closed(at("KFWS20240101_000500"), make("KFWS20240101_000500"));
    EXPECT_EQ(next(), "KTLX20240101_000000");
    EXPECT_EQ(next(), "KFWS20240101_000500") << "the newest of those that were not begun";
    EXPECT_EQ(next(), "KTLX20240101_000500");
    EXPECT_EQ(next(), "KFWS20240101_000000");
}

TEST_F(IntakeTest, WhatHasToWaitIsRegisteredButWhatIsFollowedNeedNot) {
    pipeline::IngestOutcome followed = outcome_of(IngestResult::incomplete);
    followed.followed = true;
    intake_.file_closed(at("a"), make("a"));
    ASSERT_EQ(next(), "a");
    end("a", followed);
    intake_.file_grew(at("a"), make("a", "12"));
    intake_.file_closed(at("b"), make("b"));
    intake_.file_gone(at("c"));
    EXPECT_EQ(intake_.longest_wait(), seconds{0});
    now_ += seconds{2};
    EXPECT_EQ(intake_.longest_wait(), seconds{2});
    const auto job = intake_.next_unregistered();
    ASSERT_TRUE(job);
    EXPECT_EQ(job->path, at("b"));
    const auto noted = [&](const Job& of, IngestResult result) {
        Finished finished{.job = of, .taken = Taken{}, .started = now_, .ended = now_};
        finished.taken->ingest.result = result;
        intake_.registered(finished);
    };
    noted(*job, IngestResult::registered);
    EXPECT_EQ(intake_.pending().waiting, 3U) << "it still has to be taken in";
    const auto gone = intake_.next_unregistered();
    ASSERT_TRUE(gone);
    EXPECT_EQ(gone->path, at("c"));
    noted(*gone, IngestResult::vanished);
    EXPECT_EQ(intake_.pending().waiting + intake_.pending().running, 2U) << "it is done with";
    EXPECT_FALSE(intake_.next_unregistered());
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

// A clock that went back must not make files wait for ever.
TEST_F(IntakeTest, AFileFromTheFutureIsTakenAtOnce) {
    FileStamp stamp = make("a");
    stamp.modified_ns = wall_ns_ + 3600 * second_ns;
    intake_.file_found(at("a"), stamp);
    EXPECT_EQ(next(), "a");
}

TEST_F(IntakeTest, AnIncompleteFileIsFinishedWhenItWasQuiet) {
    intake_.file_closed(at("a"), make("a"));
    ASSERT_EQ(next(), "a");
    end("a", IngestResult::incomplete);
    EXPECT_EQ(intake_.pending().growing, 1U);
    now_ += seconds{29};
    intake_.poll_growing();
    EXPECT_EQ(next(), "");
    now_ += seconds{1};
    intake_.poll_growing();
    EXPECT_EQ(next(), "a!");
    end("a", IngestResult::gridded);
    EXPECT_EQ(intake_.pending().growing, 0U);
}

TEST_F(IntakeTest, AFileClosedForEachChunkIsNotReadForEachChunk) {
    intake_.file_closed(at("a"), make("a", "1"));
    ASSERT_EQ(next(), "a");
    end("a", IngestResult::incomplete);
    int reads = 0;
    for (int ms = 0; ms < 5000; ms += 50, now_ += milliseconds{50}) {
        intake_.file_closed(at("a"), make("a", std::to_string(ms)));
        if (next() == "a") {
            ++reads;
            end("a", IngestResult::incomplete);
        }
    }
    EXPECT_LE(reads, 10);
    EXPECT_GE(reads, 8);
}

TEST_F(IntakeTest, TheCloseOfTheLastChunkCountsForTheLatency) {
    intake_.file_closed(at("a"), make("a"));
    ASSERT_EQ(next(), "a");
    end("a", IngestResult::incomplete);
    now_ += milliseconds{100};
    const SteadyTime closed = now_;
    intake_.file_closed(at("a"), make("a", "12"));
    EXPECT_EQ(next(), "");
    now_ += milliseconds{400};
    const auto job = intake_.next_job();
    ASSERT_TRUE(job);
    EXPECT_EQ(job->closed_at, closed) << "the wait is part of the latency";
    EXPECT_FALSE(job->finish_partial);
}

TEST_F(IntakeTest, AFileThatIsNeverClosedIsReadWhenItRests) {
    make("a", "1");
    intake_.file_created(at("a"), look_at(at("a")).stamp);
    EXPECT_EQ(next(), "");
    now_ += seconds{1};
    intake_.poll_growing();
    ASSERT_EQ(next(), "a");
    end("a", IngestResult::incomplete);
    append_to_file(at("a"), "more");
    now_ += seconds{1};
    intake_.poll_growing();  // sees the change
    now_ += seconds{1};
    intake_.poll_growing();  // sees that it rests
    EXPECT_EQ(next(), "a");
}

TEST_F(IntakeTest, AFileThatFailsStaysAndWaits) {
    intake_.file_closed(at("a"), make("a"));
    ASSERT_EQ(next(), "a");
    end("a", fail(ErrorCode::io, "cache: no"));
    EXPECT_EQ(intake_.pending().waiting, 1U);
    EXPECT_EQ(next(), "");
    now_ += seconds{1};
    EXPECT_EQ(next(), "a");
}

TEST_F(IntakeTest, AFullDiskHoldsEveryFile) {
    intake_.file_closed(at("a"), make("a"));
    intake_.file_closed(at("b"), make("b"));
    ASSERT_EQ(next(), "a");
    end("a", fail(ErrorCode::no_space, "cache: full"));
    EXPECT_EQ(next(), "") << "b would fail as well";
    now_ += seconds{1};
    EXPECT_NE(next(), "");
    EXPECT_NE(next(), "");
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
    EXPECT_EQ(next(), "") << "what was taken is not offered again";
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

// 2026-11-22: a volume of chunks whose newest one was deleted waited for the next start.
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

// 2026-11-22: it waited for the next regular scan.
TEST_F(IntakeTest, WhatCouldNotBeLookedAtIsLookedForSoon) {
    EXPECT_FALSE(intake_.look_again_at());
    intake_.entry_unseen();
    intake_.entry_unseen();
    EXPECT_EQ(intake_.take_unseen(), 2U);
    EXPECT_EQ(intake_.take_unseen(), 0U);
    EXPECT_FALSE(intake_.needs_scan()) << "there is no use in it at once";
    EXPECT_EQ(intake_.look_again_at(), now_ + seconds{1});
    now_ += seconds{1};
    EXPECT_TRUE(intake_.needs_scan());
    // In vain: once nothing could be read, and once not all.
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
    // The next time begins with a second again; a drop directory that is missing is not the same.
    intake_.begin_scan();
    intake_.end_scan(false);
    EXPECT_FALSE(intake_.look_again_at());
    intake_.entry_unseen();
    EXPECT_EQ(intake_.look_again_at(), now_ + seconds{1});
}

TEST_F(IntakeTest, SaysWhenThereIsSomethingToDo) {
    EXPECT_FALSE(intake_.next_time(true, true));
    intake_.file_closed(at("a"), make("a"));
    EXPECT_FALSE(intake_.next_time(false, false)) << "no worker is free";
    EXPECT_EQ(intake_.next_time(false, true), now_ + seconds{2}) << "to be registered";
    EXPECT_LE(*intake_.next_time(true, true), now_);
    ASSERT_EQ(next(), "a");
    end("a", IngestResult::incomplete);
    EXPECT_EQ(intake_.next_time(false, false), now_ + seconds{1});
}

}  // namespace
}  // namespace stormcellar::daemon
