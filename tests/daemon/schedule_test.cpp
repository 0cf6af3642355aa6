#include "daemon/queue/schedule.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/daemon/steady_start.h"

namespace stormcellar::daemon {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

Job job(const std::string& path, std::int64_t newest_ns = 0) {
    Job made;
    made.path = path;
    made.newest_ns = newest_ns;
    return made;
}

std::string next_path(Schedule& schedule, SteadyTime now) {
    const auto next = schedule.next(now);
    return next ? next->path.native() : "";
}

TEST(Schedule, GivesTheNewestFirstAndEqualOnesAsTheyCame) {
    Schedule schedule(10);
    for (const auto& [path, newest] : std::vector<std::pair<std::string, std::int64_t>>{
             {"old", 1}, {"new", 9}, {"same-a", 5}, {"same-b", 5}}) {
        EXPECT_EQ(schedule.offer(job(path, newest)), Offered::queued);
    }
    EXPECT_EQ(next_path(schedule, t0), "new");
    EXPECT_EQ(next_path(schedule, t0), "same-a");
    EXPECT_EQ(next_path(schedule, t0), "same-b");
    EXPECT_EQ(next_path(schedule, t0), "old");
    EXPECT_EQ(next_path(schedule, t0), "");
    EXPECT_EQ(schedule.running_count(), 4U);
}

TEST(Schedule, OneEntryAPath) {
    Schedule schedule(10);
    Job first = job("a", 1);
    first.closed_at = t0;
    first.finish_as_is = true;
    Job second = job("a", 7);
    second.closed_at = t0 + seconds{1};
    schedule.offer(first);
    EXPECT_EQ(schedule.offer(second), Offered::merged);
    EXPECT_EQ(schedule.waiting_count(), 1U);
    const auto merged = schedule.next(t0);
    ASSERT_TRUE(merged);
    EXPECT_EQ(merged->newest_ns, 7);
    EXPECT_EQ(merged->closed_at, t0 + seconds{1}) << "the latest close counts";
    EXPECT_FALSE(merged->finish_as_is) << "a file that was closed again is not quiet";
    EXPECT_FALSE(schedule.next(t0));
}

TEST(Schedule, AMergedOfferWithoutACloseKeepsTheClose) {
    Schedule schedule(10);
    Job first = job("a");
    first.closed_at = t0;
    schedule.offer(first);
    schedule.offer(job("a"));
    EXPECT_EQ(schedule.next(t0)->closed_at, t0);
}

TEST(Schedule, WhatIsOfferedWhileItRunsIsLookedAtOnceMore) {
    Schedule schedule(10);
    schedule.offer(job("a"));
    ASSERT_EQ(next_path(schedule, t0), "a");
    EXPECT_EQ(schedule.offer(job("a")), Offered::merged);
    EXPECT_EQ(schedule.offer(job("a")), Offered::merged);
    EXPECT_EQ(next_path(schedule, t0), "") << "a file must not run twice at once";
    schedule.finished("a", t0 + seconds{2});
    EXPECT_EQ(next_path(schedule, t0 + seconds{1}), "") << "the requested time has not come";
    EXPECT_EQ(schedule.next_time(), t0 + seconds{2});
    EXPECT_EQ(next_path(schedule, t0 + seconds{2}), "a");
    schedule.finished("a");
    EXPECT_EQ(next_path(schedule, t0 + seconds{9}), "")
        << "the file is ingested once more, not twice";
    EXPECT_EQ(schedule.running_count(), 0U);
}

TEST(Schedule, AJobWaitsForItsTime) {
    Schedule schedule(10);
    Job later = job("later", 9);
    later.not_before = t0 + milliseconds{500};
    schedule.offer(later);
    schedule.offer(job("now", 1));
    EXPECT_EQ(next_path(schedule, t0), "now");
    EXPECT_EQ(next_path(schedule, t0), "");
    EXPECT_EQ(schedule.next_time(), t0 + milliseconds{500});
    EXPECT_EQ(next_path(schedule, t0 + milliseconds{500}), "later");
}

TEST(Schedule, RefusesBeyondItsLimitButMergesWhatItHas) {
    Schedule schedule(2);
    schedule.offer(job("a"));
    schedule.offer(job("b"));
    EXPECT_EQ(schedule.offer(job("c")), Offered::refused);
    EXPECT_EQ(schedule.offer(job("a")), Offered::merged);
    ASSERT_EQ(next_path(schedule, t0), "b") << "a was merged, so it came later";
    schedule.finished("b");
    EXPECT_EQ(schedule.offer(job("c")), Offered::queued);
}

TEST(Schedule, AFailedJobWaitsLongerEachTimeAndIsNeverDropped) {
    Schedule schedule(10);
    schedule.offer(job("a"));
    SteadyTime now = t0;
    std::vector<std::int64_t> waits;
    for (int i = 0; i < 9; ++i) {
        std::optional<Job> next = schedule.next(now);
        ASSERT_TRUE(next);
        (void)schedule.retry(*next, now);
        const SteadyTime then = *schedule.next_time();
        EXPECT_FALSE(schedule.next(then - milliseconds{1}));
        waits.push_back(std::chrono::duration_cast<seconds>(then - now).count());
        now = then;
    }
    EXPECT_EQ(waits, (std::vector<std::int64_t>{1, 2, 4, 8, 16, 32, 60, 60, 60}));
}

TEST(Schedule, AChangeWhileAJobFailsDoesNotEndTheWait) {
    Schedule schedule(10);
    schedule.offer(job("a"));
    const auto running = schedule.next(t0);
    schedule.offer(job("a"));
    EXPECT_TRUE(schedule.retry(*running, t0));
    EXPECT_EQ(schedule.waiting_count(), 0U);
    EXPECT_EQ(schedule.retrying_count(), 1U);
    EXPECT_FALSE(schedule.next(t0));
    const auto again = schedule.next(t0 + seconds{1});
    ASSERT_TRUE(again);
    EXPECT_EQ(again->failures, 1);
}

Job job_of(const std::string& path, const std::string& station, Urgency urgency = Urgency::live) {
    Job made = job(path);
    made.station = station;
    made.urgency = urgency;
    return made;
}

// 2026-11-25: files that could not be ingested filled the queue, and new files were refused.
TEST(Schedule, WhatIsTriedAgainTakesNoPlaceFromWhatComes) {
    Schedule schedule(4);
    for (int i = 0; i < 4; ++i) {
        schedule.offer(job("bad" + std::to_string(i)));
        const auto running = schedule.next(t0);
        ASSERT_TRUE(running);
        EXPECT_TRUE(schedule.retry(*running, t0));
    }
    EXPECT_EQ(schedule.retrying_count(), 4U);
    for (int i = 0; i < 4; ++i)
        EXPECT_EQ(schedule.offer(job("good" + std::to_string(i))), Offered::queued);
    EXPECT_EQ(schedule.offer(job("more")), Offered::refused);
    EXPECT_EQ(schedule.waiting_count(), 4U);
    // No further job may wait for another attempt, so a job that fails now is forgotten.
    const auto running = schedule.next(t0);
    EXPECT_FALSE(schedule.retry(*running, t0));
    EXPECT_EQ(schedule.running_count(), 0U);
    // Once the time of the failed jobs has come, they are like other jobs.
    for (int i = 0; i < 7; ++i)
        EXPECT_TRUE(schedule.next(t0 + seconds{1})) << i;
    EXPECT_EQ(schedule.retrying_count(), 0U);
    EXPECT_FALSE(schedule.next(t0 + seconds{99}));
}

TEST(Schedule, AtTheBoundTheStationThatHasMostGivesWay) {
    Schedule schedule(6);
    for (int i = 0; i < 5; ++i)
        schedule.offer(job_of("flood" + std::to_string(i), ""));
    EXPECT_EQ(schedule.offer(job_of("tlx0", "KTLX")), Offered::queued);
    EXPECT_EQ(schedule.offer(job_of("tlx1", "KTLX")), Offered::queued);
    EXPECT_EQ(schedule.offer(job_of("tlx2", "KTLX")), Offered::queued);
    EXPECT_EQ(schedule.offer(job_of("tlx3", "KTLX")), Offered::refused)
        << "KTLX has as many jobs as the flood";
    EXPECT_EQ(schedule.offer(job_of("flood9", "")), Offered::refused);
    EXPECT_EQ(schedule.offer(job_of("okx", "KOKX")), Offered::queued);
    using Paths = std::vector<std::filesystem::path>;
    EXPECT_EQ(schedule.take_displaced(), (Paths{"flood4", "flood3", "tlx2"}));
    EXPECT_TRUE(schedule.take_displaced().empty());
    EXPECT_EQ(schedule.waiting_count(), 6U);
}

// 2026-11-25: at the limit, a new job took the place of the newest job of its station, so that a
// flood left only old jobs.
TEST(Schedule, AtTheBoundWhatWouldBeServedLastGivesWay) {
    Schedule schedule(4);
    const auto job_at = [](const char* path, std::int64_t newest_ns, bool is_begun = false) {
        Job made = job_of(path, "KTLX");
        made.newest_ns = newest_ns;
        made.closed_at = t0;
        made.is_begun = is_begun;
        return made;
    };
    schedule.offer(job_at("going-on", 1, true));
    schedule.offer(job_at("fresh2", 2));
    Job found = job_of("found", "KTLX");
    found.newest_ns = 9;
    schedule.offer(found);
    schedule.offer(job_at("fresh3", 3));
    EXPECT_EQ(schedule.offer(job_at("fresh4", 4)), Offered::queued);
    EXPECT_EQ(schedule.offer(job_at("fresh1", 1)), Offered::refused);
    EXPECT_EQ(schedule.offer(job_at("fresh5", 5)), Offered::queued);
    EXPECT_EQ(schedule.offer(job_of("okx", "KOKX")), Offered::queued);
    using Paths = std::vector<std::filesystem::path>;
    EXPECT_EQ(schedule.take_displaced(), (Paths{"found", "fresh2", "fresh3"}));
    EXPECT_EQ(next_path(schedule, t0), "going-on");
}

TEST(Schedule, NewsOfAStationGoesBeforeItsOwnBacklog) {
    Schedule schedule(3);
    for (int i = 0; i < 3; ++i)
        schedule.offer(job_of("old" + std::to_string(i), "KTLX", Urgency::backlog));
    EXPECT_EQ(schedule.offer(job_of("old9", "KTLX", Urgency::backlog)), Offered::refused);
    EXPECT_EQ(schedule.offer(job_of("new", "KTLX")), Offered::queued);
    EXPECT_EQ(next_path(schedule, t0), "new");
}

TEST(Schedule, FilesThatTakeLongLeaveAWorkerToOthers) {
    Schedule schedule(10);
    schedule.set_workers(2);
    schedule.offer(job_of("a", ""));
    ASSERT_EQ(next_path(schedule, t0), "a");
    schedule.worked("a", seconds{8}, t0 + seconds{8});
    schedule.finished("a");
    schedule.offer(job_of("good", "KTLX"));
    ASSERT_EQ(next_path(schedule, t0), "good");
    schedule.worked("good", milliseconds{90}, t0, true);
    schedule.finished("good");
    const auto now = t0 + seconds{8};
    for (const char* path : {"b", "c"})
        schedule.offer(job_of(path, ""));
    EXPECT_EQ(next_path(schedule, now), "b");
    EXPECT_EQ(next_path(schedule, now), "") << "the last worker is reserved for light stations";
    EXPECT_GT(*schedule.next_time(), now) << "the caller must not ask again and again";
    schedule.offer(job_of("tlx", "KTLX"), now);
    EXPECT_LE(*schedule.next_time(), now);
    EXPECT_EQ(next_path(schedule, now), "tlx");
    schedule.worked("b", milliseconds{1}, now);
    schedule.finished("b");
    EXPECT_EQ(next_path(schedule, now), "c");
}

TEST(Schedule, AHoldConcernsEveryJob) {
    Schedule schedule(10);
    schedule.offer(job("a"));
    schedule.hold_until(t0 + seconds{4});
    EXPECT_FALSE(schedule.next(t0 + seconds{3}));
    EXPECT_EQ(schedule.next_time(), t0 + seconds{4});
    EXPECT_TRUE(schedule.next(t0 + seconds{4}));
}

// Compares the schedule with a simple implementation, which searches a list.
TEST(Schedule, AgreesWithAPlainListUnderRandomUse) {
    std::mt19937 random(20261121);
    Schedule schedule(8);
    std::vector<Job> waiting, running;  // in the order of the last offer
    const auto find = [](std::vector<Job>& jobs, const std::filesystem::path& path) {
        return std::find_if(jobs.begin(), jobs.end(),
                            [&](const Job& other) { return other.path == path; });
    };
    for (int step = 0; step < 20'000; ++step) {
        const std::string path(1, static_cast<char>('a' + random() % 12));
        const bool runs = find(running, path) != running.end();
        if (random() % 3 != 0 && !runs) {
            const Job offered = job(path, random() % 5);
            const auto known = find(waiting, path);
            const auto least = std::min_element(
                waiting.begin(), waiting.end(),
                [](const Job& a, const Job& b) { return a.newest_ns < b.newest_ns; });
            const bool is_full = waiting.size() + running.size() >= 8;
            const bool is_worth_more =
                least != waiting.end() && offered.newest_ns > least->newest_ns;
            const Offered expected = known != waiting.end()      ? Offered::merged
                                     : is_full && !is_worth_more ? Offered::refused
                                                                 : Offered::queued;
            ASSERT_EQ(schedule.offer(offered), expected);
            if (is_full && expected == Offered::queued) {
                const auto displaced = schedule.take_displaced();
                ASSERT_EQ(displaced.size(), 1U);
                const auto gone = find(waiting, displaced.front());
                ASSERT_EQ(gone->newest_ns, least->newest_ns);
                waiting.erase(gone);
            }
            if (expected == Offered::merged) {
                const std::int64_t newest = std::max(known->newest_ns, offered.newest_ns);
                waiting.erase(known);
                waiting.push_back(job(path, newest));
            } else if (expected == Offered::queued) {
                waiting.push_back(offered);
            }
        } else if (runs) {
            schedule.finished(path);
            running.erase(find(running, path));
        } else {
            const auto newest = std::max_element(
                waiting.begin(), waiting.end(),
                [](const Job& a, const Job& b) { return a.newest_ns < b.newest_ns; });
            const auto next = schedule.next(t0);
            ASSERT_EQ(next.has_value(), newest != waiting.end());
            if (!next) continue;
            ASSERT_EQ(next->path, newest->path);
            running.push_back(*newest);
            waiting.erase(newest);
        }
        ASSERT_EQ(schedule.waiting_count(), waiting.size());
        ASSERT_EQ(schedule.running_count(), running.size());
    }
}

TEST(Schedule, WhatWaitsIsToBeRegisteredAfterAWhileAndOnce) {
    Schedule schedule(10);
    schedule.offer(job("a", 1), t0);
    schedule.offer(job("b", 2), t0 + seconds{1});
    Job known = job("c", 3);
    known.is_registered = true;
    schedule.offer(known, t0);
    EXPECT_FALSE(schedule.next_unregistered(t0 + milliseconds{1999}));
    const auto first = schedule.next_unregistered(t0 + seconds{2});
    ASSERT_TRUE(first);
    EXPECT_EQ(first->path, "a") << "the job that has waited longest";
    EXPECT_EQ(schedule.waiting_count(), 2U);
    EXPECT_EQ(schedule.running_count(), 1U) << "the job must not run meanwhile";
    EXPECT_FALSE(schedule.next_unregistered(t0 + seconds{2}));
    EXPECT_EQ(next_path(schedule, t0 + seconds{2}), "c");
    schedule.registered("a");
    EXPECT_EQ(next_path(schedule, t0 + seconds{9}), "b");
    EXPECT_FALSE(schedule.next_unregistered(t0 + seconds{9})) << "a is registered, and b runs";
    EXPECT_EQ(next_path(schedule, t0 + seconds{9}), "a");
}

TEST(Schedule, SaysWhenTheNextIsToBeRegistered) {
    Schedule schedule(10);
    EXPECT_FALSE(schedule.next_unregistered_time());
    schedule.offer(job("a", 1), t0);
    EXPECT_EQ(schedule.next_unregistered_time(), t0 + seconds{2});
    schedule.hold_until(t0 + seconds{9});
    EXPECT_EQ(schedule.next_unregistered_time(), t0 + seconds{9});
    ASSERT_TRUE(schedule.next_unregistered(t0 + seconds{9}));
    EXPECT_FALSE(schedule.next_unregistered_time());
}

// The time that a failed job waits for its next attempt does not count as waiting for a worker.
TEST(Schedule, ARetryWaitsSinceItsTime) {
    Schedule schedule(10);
    schedule.offer(job("a", 1), t0);
    schedule.offer(job("b", 0), t0 + seconds{50});
    (void)schedule.retry(*schedule.next(t0), t0 + seconds{60});
    ASSERT_EQ(next_path(schedule, t0 + seconds{70}), "a");
    schedule.registered("a");
    EXPECT_EQ(schedule.oldest_offer(), t0 + seconds{50});
    EXPECT_EQ(next_path(schedule, t0 + seconds{70}), "a");
    EXPECT_EQ(next_path(schedule, t0 + seconds{70}), "b");
}

TEST(Schedule, WhatIsOfferedWhileItIsRegisteredIsOneJob) {
    Schedule schedule(10);
    schedule.offer(job("a", 1), t0);
    ASSERT_TRUE(schedule.next_unregistered(t0 + seconds{5}));
    Job closed = job("a", 8);
    closed.closed_at = t0 + seconds{5};
    EXPECT_EQ(schedule.offer(closed, t0 + seconds{5}), Offered::merged);
    schedule.registered("a");
    const auto next = schedule.next(t0 + seconds{5});
    ASSERT_TRUE(next);
    EXPECT_EQ(next->closed_at, closed.closed_at);
    schedule.finished("a");
    EXPECT_EQ(schedule.waiting_count() + schedule.running_count(), 0U);
}

TEST(Schedule, SaysSinceWhenTheFirstWaits) {
    Schedule schedule(10);
    EXPECT_FALSE(schedule.oldest_offer());
    Job later = job("later");
    later.not_before = t0 + seconds{60};
    schedule.offer(later, t0);
    EXPECT_FALSE(schedule.oldest_offer()) << "the job may not run yet";
    schedule.offer(job("a", 1), t0 + seconds{1});
    schedule.offer(job("b", 9), t0 + seconds{2});
    EXPECT_EQ(schedule.oldest_offer(), t0 + seconds{1});
    schedule.offer(job("a", 2), t0 + seconds{3});
    EXPECT_EQ(schedule.oldest_offer(), t0 + seconds{1})
        << "a merged job has waited since its first offer";
    EXPECT_EQ(next_path(schedule, t0 + seconds{4}), "b");
    EXPECT_EQ(next_path(schedule, t0 + seconds{4}), "a");
    EXPECT_FALSE(schedule.oldest_offer());
    schedule.offer(job("a", 2), t0 + seconds{9});
    schedule.finished("a");
    EXPECT_EQ(schedule.oldest_offer(), t0 + seconds{9}) << "the wait begins with the second offer";
}

TEST(Schedule, SaysHowLongTheLastLiveJobWaited) {
    Schedule schedule(10);
    Job live = job("live", 1);
    live.urgency = Urgency::live;
    schedule.offer(job("old", 1), t0);
    schedule.offer(live, t0 + seconds{4});
    EXPECT_EQ(next_path(schedule, t0 + seconds{7}), "live");
    EXPECT_EQ(schedule.last_wait(), seconds{3});
    EXPECT_EQ(next_path(schedule, t0 + seconds{9}), "old");
    EXPECT_EQ(schedule.last_wait(), seconds{3}) << "the backlog may wait";
}

}  // namespace
}  // namespace stormcellar::daemon
