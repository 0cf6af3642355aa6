#include "daemon/work_shares.h"

#include <gtest/gtest.h>

#include "tests/daemon/steady_start.h"

namespace stormcellar::daemon {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(WorkShares, AStationWhoseFilesAreQuickHasAllWorkers) {
    WorkShares shares;
    shares.set_workers(2);
    for (int file = 0; file < 100; ++file) {
        const auto now = t0 + seconds{file};
        EXPECT_TRUE(shares.may_begin("KTLX", now));
        shares.begun("KTLX", now);
        EXPECT_TRUE(shares.may_begin("KTLX", now)) << file;
        shares.begun("KTLX", now);
        shares.ended("KTLX", milliseconds{90}, now);
        shares.ended("KTLX", milliseconds{90}, now);
    }
}

TEST(WorkShares, HeavyStationsLeaveOneWorkerToTheOthers) {
    WorkShares shares;
    shares.set_workers(3);
    for (const char* station : {"KTLX", "KOKX", ""}) {
        shares.begun(station, t0);
        shares.ended(station, seconds{8}, t0);
    }
    shares.begun("KTLX", t0);
    EXPECT_TRUE(shares.may_begin("", t0));
    shares.begun("", t0);
    EXPECT_FALSE(shares.may_begin("KOKX", t0));
    EXPECT_FALSE(shares.may_begin("", t0));
    EXPECT_TRUE(shares.may_begin("KBGM", t0)) << "it owes nothing";
    // 6 s too much are paid back in 30 s.
    EXPECT_FALSE(shares.may_begin("KOKX", t0 + seconds{29}));
    EXPECT_TRUE(shares.may_begin("KOKX", t0 + seconds{30}));
}

TEST(WorkShares, OneWorkerIsForAll) {
    WorkShares shares;
    shares.set_workers(1);
    shares.begun("KTLX", t0);
    shares.ended("KTLX", seconds{60}, t0);
    EXPECT_TRUE(shares.may_begin("KTLX", t0));
}

}  // namespace
}  // namespace stormcellar::daemon
