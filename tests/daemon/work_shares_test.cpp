#include "daemon/queue/work_shares.h"

#include <gtest/gtest.h>

#include "tests/daemon/steady_start.h"

namespace stormcellar::daemon {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Time = WorkShares::Time;

void run(WorkShares& shares, const std::string& station, WorkShares::Time::duration took,
         bool is_good, Time now) {
    shares.begun(station, now);
    shares.ended(station, took, is_good, now);
}

TEST(WorkShares, StationsWhoseFilesAreQuickAndGoodHaveAllWorkers) {
    WorkShares shares;
    shares.set_workers(2);
    run(shares, "KTLX", milliseconds{90}, true, t0);
    run(shares, "KOKX", milliseconds{90}, true, t0);
    for (int file = 1; file < 100; ++file) {
        const auto now = t0 + seconds{file};
        ASSERT_TRUE(shares.may_begin("KTLX", now)) << file;
        shares.begun("KTLX", now);
        ASSERT_TRUE(shares.may_begin("KOKX", now)) << file;
        shares.begun("KOKX", now);
        shares.ended("KTLX", milliseconds{90}, true, now);
        shares.ended("KOKX", milliseconds{90}, true, now);
    }
}

// Nobody knows how long a job takes before it has ended, so a station may not use all workers, even
// with its first files.
TEST(WorkShares, NoStationHasAllWorkersAlone) {
    WorkShares shares;
    shares.set_workers(3);
    run(shares, "KTLX", milliseconds{90}, true, t0);
    for (int file = 0; file < 2; ++file) {
        ASSERT_TRUE(shares.may_begin("KTLX", t0)) << file;
        shares.begun("KTLX", t0);
    }
    EXPECT_FALSE(shares.may_begin("KTLX", t0));
    EXPECT_TRUE(shares.may_begin("KOKX", t0))
        << "a station without a good file may run if no other such station runs";
}

// 2026-11-25: 141 files of 1.4 kB, each of a different station, delayed a real file by 15 s.
TEST(WorkShares, StationsOfWhichNothingGoodHasComeLeaveOneWorkerToTheOthers) {
    WorkShares shares;
    shares.set_workers(2);
    run(shares, "KTLX", milliseconds{90}, true, t0);
    run(shares, "KOKX", milliseconds{90}, false, t0);
    EXPECT_TRUE(shares.may_begin("KBGM", t0));
    shares.begun("KBGM", t0);
    for (const char* station : {"KOKX", "KENX", ""})
        EXPECT_FALSE(shares.may_begin(station, t0)) << station;
    EXPECT_TRUE(shares.may_begin("KTLX", t0));
    const auto later = t0 + WorkShares::good_for + seconds{1};
    EXPECT_FALSE(shares.may_begin("KTLX", later)) << "the last good file came long ago";
    shares.ended("KBGM", milliseconds{90}, true, later);
    EXPECT_TRUE(shares.may_begin("KTLX", later));
}

TEST(WorkShares, HeavyStationsLeaveOneWorkerToTheOthers) {
    WorkShares shares;
    shares.set_workers(3);
    for (const char* station : {"KTLX", "KOKX"})
        run(shares, station, seconds{8}, true, t0);
    run(shares, "KBGM", milliseconds{90}, true, t0);
    run(shares, "", seconds{8}, false, t0);
    shares.begun("KTLX", t0);
    EXPECT_TRUE(shares.may_begin("", t0));
    shares.begun("", t0);
    EXPECT_FALSE(shares.may_begin("KOKX", t0));
    EXPECT_FALSE(shares.may_begin("", t0));
    EXPECT_TRUE(shares.may_begin("KBGM", t0)) << "KBGM owes nothing";
    // A debt of 6 s above the limit is paid back in 30 s.
    EXPECT_FALSE(shares.may_begin("KOKX", t0 + seconds{29}));
    EXPECT_TRUE(shares.may_begin("KOKX", t0 + seconds{30}));
}

TEST(WorkShares, OneWorkerIsForAll) {
    WorkShares shares;
    shares.set_workers(1);
    run(shares, "KTLX", seconds{60}, false, t0);
    EXPECT_TRUE(shares.may_begin("KTLX", t0));
}

}  // namespace
}  // namespace stormcellar::daemon
