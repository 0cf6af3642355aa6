#include "daemon/queue/worker_pool.h"

#include <atomic>
#include <latch>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/daemon/fake_sink.h"
#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

using pipeline::IngestResult;
using std::chrono::milliseconds;
using std::chrono::seconds;

Job job(const std::string& path) {
    Job made;
    made.path = path;
    return made;
}

WorkerPool::Work work_of(Sink& sink) {
    return [&sink](const Job& given) {
        return sink.take(given.path, given.finish_as_is, pipeline::Tries::more_follow);
    };
}

std::vector<Finished> collect(WorkerPool& pool, std::size_t count) {
    std::vector<Finished> all;
    (void)testing::eventually([&] {
        for (Finished& finished : pool.collect())
            all.push_back(std::move(finished));
        return all.size() >= count;
    });
    return all;
}

TEST(WorkerPool, GivesBackEachJobWithItsResultAndTimes) {
    FakeSink sink([](const auto&, bool) { return outcome_of(IngestResult::gridded); });
    std::atomic<int> wakes = 0;
    WorkerPool pool(work_of(sink), "ingest", 2, [&] { ++wakes; });
    pool.submit(job("a"));
    const std::vector<Finished> ended = collect(pool, 1);
    ASSERT_EQ(ended.size(), 1U);
    EXPECT_EQ(ended[0].job.path, "a");
    ASSERT_TRUE(ended[0].taken);
    EXPECT_EQ(ended[0].taken->ingest.result(), IngestResult::gridded);
    EXPECT_LE(ended[0].started, ended[0].ended);
    EXPECT_TRUE(pool.drain(seconds{20}));
    EXPECT_EQ(wakes, 1);
}

TEST(WorkerPool, AWorkerOutlivesWhatAFileThrows) {
    FakeSink sink([](const std::filesystem::path& path, bool) {
        if (path == "bad") throw std::runtime_error("boom");
        return outcome_of(IngestResult::gridded);
    });
    WorkerPool pool(work_of(sink), "ingest", 1, [] {});
    for (int i = 0; i < 3; ++i) {
        pool.submit(job("bad"));
        const std::vector<Finished> bad = collect(pool, 1);
        ASSERT_EQ(bad.size(), 1U);
        ASSERT_FALSE(bad[0].taken);
        EXPECT_EQ(bad[0].taken.error().code, ErrorCode::internal);
        EXPECT_EQ(bad[0].taken.error().message, "bad: boom");
    }
    pool.submit(job("good"));
    const std::vector<Finished> good = collect(pool, 1);
    ASSERT_EQ(good.size(), 1U);
    EXPECT_TRUE(good[0].taken);
}

// A lack of memory is a fault of the system, so the job is tried again.
TEST(WorkerPool, WantOfMemoryIsTheSystems) {
    FakeSink sink([](const std::filesystem::path&, bool) -> pipeline::IngestOutcome {
        throw std::bad_alloc{};
    });
    WorkerPool pool(work_of(sink), "ingest", 1, [] {});
    pool.submit(job("file"));
    const std::vector<Finished> ended = collect(pool, 1);
    ASSERT_EQ(ended.size(), 1U);
    ASSERT_FALSE(ended[0].taken);
    EXPECT_EQ(ended[0].taken.error().code, ErrorCode::exhausted);
}

TEST(WorkerPool, RunsAsManyJobsAtOnceAsItHasWorkers) {
    std::latch all_run(3);
    FakeSink sink([&](const auto&, bool) {
        all_run.arrive_and_wait();  // would hang if the jobs ran one after another
        return outcome_of(IngestResult::gridded);
    });
    WorkerPool pool(work_of(sink), "ingest", 3, [] {});
    for (const char* name : {"a", "b", "c"}) {
        EXPECT_TRUE(pool.has_free_worker());
        pool.submit(job(name));
    }
    EXPECT_EQ(collect(pool, 3).size(), 3U);
    EXPECT_TRUE(pool.has_free_worker());
}

TEST(WorkerPool, SaysWhichJobRunsLongestAndSinceWhen) {
    std::latch release(1);
    FakeSink sink([&](const auto&, bool) {
        release.wait();
        return outcome_of(IngestResult::gridded);
    });
    WorkerPool pool(work_of(sink), "ingest", 1, [] {});
    EXPECT_FALSE(pool.oldest());
    const SteadyTime before = std::chrono::steady_clock::now();
    pool.submit(job("a"));
    EXPECT_FALSE(pool.has_free_worker());
    EXPECT_TRUE(testing::eventually([&] { return pool.oldest().has_value(); }));
    const auto oldest = pool.oldest();
    release.count_down();
    ASSERT_TRUE(oldest);
    EXPECT_GE(oldest->since, before);
    EXPECT_EQ(oldest->path, job("a").path);
    EXPECT_EQ(collect(pool, 1).size(), 1U);
    EXPECT_FALSE(pool.oldest());
}

TEST(WorkerPool, CanGrowAndShrink) {
    std::atomic<int> running = 0;
    std::atomic<bool> is_held = false;
    FakeSink sink([&](const auto&, bool) {
        ++running;
        EXPECT_TRUE(testing::eventually([&] { return !is_held; }));
        --running;
        return outcome_of(IngestResult::gridded);
    });
    WorkerPool pool(work_of(sink), "ingest", 1, [] {});
    // Submits jobs while workers are free, holds them until all run, and returns their number.
    const auto run_at_once = [&] {
        is_held = true;
        int jobs = 0;
        for (; jobs < 10 && pool.has_free_worker(); ++jobs)
            pool.submit(job("x"));
        EXPECT_TRUE(testing::eventually([&] { return running == jobs; }));
        is_held = false;
        EXPECT_EQ(collect(pool, static_cast<std::size_t>(jobs)).size(),
                  static_cast<std::size_t>(jobs));
        return jobs;
    };
    EXPECT_EQ(run_at_once(), 1);
    pool.resize(4);
    EXPECT_EQ(run_at_once(), 4);
    pool.resize(1);
    EXPECT_EQ(run_at_once(), 1);
}

TEST(WorkerPool, DrainingEndsRunningJobsAndBeginsNone) {
    std::latch begun(1);
    std::atomic<bool> is_held = true;
    FakeSink sink([&](const auto&, bool) {
        begun.count_down();
        EXPECT_TRUE(testing::eventually([&] { return !is_held; }));
        return outcome_of(IngestResult::gridded);
    });
    {
        WorkerPool pool(work_of(sink), "ingest", 1, [] {});
        pool.submit(job("a"));
        begun.wait();
        pool.submit(job("b"));  // the only worker is busy, so it has not begun this job
        EXPECT_FALSE(pool.drain(milliseconds{1})) << "the first job still runs";
        is_held = false;
        EXPECT_TRUE(pool.drain(seconds{20}));
        EXPECT_EQ(pool.collect().size(), 1U);
        EXPECT_FALSE(pool.has_free_worker()) << "the caller must submit no other job";
    }
    EXPECT_EQ(sink.calls(), std::vector<std::string>{"a"}) << "the threads of the pool have ended";
}

TEST(WorkerPool, DrainingGivesUpOnAJobThatHangs) {
    std::latch begun(1), release(1);
    FakeSink sink([&](const auto&, bool) {
        begun.count_down();
        release.wait();
        return outcome_of(IngestResult::gridded);
    });
    WorkerPool pool(work_of(sink), "ingest", 1, [] {});
    pool.submit(job("a"));
    begun.wait();
    EXPECT_FALSE(pool.drain(milliseconds{20}));
    release.count_down();
}

}  // namespace
}  // namespace stormcellar::daemon
