#include "daemon/status/reporter.h"

#include <gtest/gtest.h>

#include "tests/daemon/fake_sink.h"

namespace stormcellar::daemon {
namespace {

using pipeline::IngestResult;
using std::chrono::milliseconds;
using std::chrono::seconds;

Finished finished(IngestResult result) {
    Finished made{.job = {}, .taken = Taken{{}, outcome_of(result)}, .started = {}, .ended = {}};
    made.job.path = "/d/a\nb";
    made.started = SteadyTime{} + seconds{100};
    made.ended = made.started + milliseconds{80};
    return made;
}

TEST(LogLine, OfAGriddedFileNamesStationVolumeAndLatency) {
    Finished made = finished(IngestResult::gridded);
    made.job.closed_at = made.started - milliseconds{5};
    made.taken->ingest.read_s = 0.002;
    made.taken->ingest.decode_s = 0.05;
    made.taken->ingest.grid_s = 0.02;
    made.taken->ingest.commit_s = 0.008;
    EXPECT_EQ(describe(made),
              "gridded KTLX 2022-03-17T00:08:42Z /d/a\\x0ab: 85 ms after close; read 2 ms, decode "
              "50 ms, grid 20 ms, commit 8 ms");
}

TEST(LogLine, OfAFileWhoseCloseNobodySawSaysHowLongItTook) {
    Finished made = finished(IngestResult::gridded);
    made.taken->ingest.reason = "ends\nearly";
    made.taken->ingest.partial = true;
    EXPECT_EQ(describe(made),
              "gridded partial KTLX 2022-03-17T00:08:42Z /d/a\\x0ab: 80 ms; read 0 ms, decode 0 "
              "ms, grid 0 ms, commit 0 ms (ends\\x0aearly)");
}

TEST(LogLine, OfARejectedFileSaysWhy) {
    Finished made = finished(IngestResult::rejected);
    made.taken->ingest.station.clear();
    made.taken->ingest.volume_time.reset();
    made.taken->ingest.reason = "is empty";
    EXPECT_EQ(describe(made), "rejected ???? - /d/a\\x0ab (is empty)");
    made.taken->ingest.reason = std::string(100'000, 'x');
    EXPECT_LT(describe(made).size(), 600U) << "a file must not make the line longer";
}

TEST(LogLine, OfAFailureSaysWhenItIsTriedAgain) {
    Finished made = finished(IngestResult::gridded);
    made.job.failures = 2;
    made.taken = fail(ErrorCode::no_space, "/c/x: full");
    EXPECT_EQ(describe(made), "cannot store /d/a\\x0ab: /c/x: full; trying again in 4 s");
}

TEST(LogLine, OfASweepThatEnteredAGrowingVolumesGrid) {
    Finished made = finished(IngestResult::incomplete);
    made.job.closed_at = made.started - milliseconds{5};
    made.taken->ingest.living = {"/c/grid.scg"};
    EXPECT_EQ(describe(made),
              "sweep of KTLX 2022-03-17T00:08:42Z /d/a\\x0ab: gridded 85 ms after close");
    const About subject = about(made);
    EXPECT_EQ(subject.event, Event::living);
    EXPECT_DOUBLE_EQ(subject.latency_s.value_or(0), 0.085);
}

TEST(LogLine, SaysWhatItIsAbout) {
    Finished made = finished(IngestResult::gridded);
    About subject = about(made);
    EXPECT_EQ(subject.event, Event::gridded);
    EXPECT_EQ(subject.station, "KTLX");
    EXPECT_EQ(subject.volume, made.taken->ingest.volume_time);
    EXPECT_EQ(subject.file, "/d/a\nb")
        << "the writer of the line escapes the name, which is unchanged here";
    EXPECT_FALSE(subject.latency_s) << "nobody saw the close";
    EXPECT_DOUBLE_EQ(subject.took_s.value_or(0), 0.08);
    made = finished(IngestResult::rejected);
    made.taken->ingest.ending = pipeline::ended::Rejected{ErrorCode::truncated};
    subject = about(made);
    EXPECT_EQ(subject.event, Event::rejected);
    EXPECT_EQ(subject.reason, "truncated");
    made.taken = fail(ErrorCode::no_space, "/c/x: full");
    subject = about(made);
    EXPECT_EQ(subject.event, Event::store_failed);
    EXPECT_EQ(subject.reason, "no_space");
}

TEST(LogLine, OfEveryResultIsOneLine) {
    for (const IngestResult result :
         {IngestResult::gridded, IngestResult::no_moment, IngestResult::no_position,
          IngestResult::incomplete, IngestResult::rejected, IngestResult::unchanged,
          IngestResult::vanished}) {
        const std::string line = describe(finished(result));
        EXPECT_FALSE(line.empty());
        EXPECT_EQ(line.find('\n'), std::string::npos);
    }
}

}  // namespace
}  // namespace stormcellar::daemon
