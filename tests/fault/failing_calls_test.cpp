// Makes each system call of the real program fail in turn. No data may be lost, and no temporary
// files may be left.
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <future>
#include <mutex>
#include <ostream>

#include <gtest/gtest.h>

#include "tests/fault/faulty_daemon.h"
#include "tests/fault/load.h"
#include "tests/fault/steering_file.h"
#include "tests/testing/waiting.h"

namespace stormcellar::fault {
namespace {

using Clock = std::chrono::steady_clock;

struct Failure {
    const char* name;
    std::uint32_t kinds;
    int error_number;
    bool lasts;          // calls fail until 200 ms after the first failure; false: one call fails
    bool in_drop;        // calls on the incoming files may fail, too
    bool needs_restart;  // only the next start removes temporary files that are left
};

void PrintTo(const Failure& failure, std::ostream* out) {
    *out << failure.name;
}

constexpr std::uint32_t changes =
    kind_write | kind_truncate | kind_sync | kind_rename | kind_create;
constexpr Failure failures[] = {
    {"EachWriteFindsNoSpace", kind_write, ENOSPC, false, false, false},
    {"FromEachWriteOnNoSpace", kind_write | kind_truncate | kind_create, ENOSPC, true, false,
     false},
    {"EachWriteFails", kind_write, EIO, false, false, false},
    {"EachWriteIsShort", kind_write, short_write, false, false, false},
    {"EachSyncFails", kind_sync, EIO, false, false, false},
    {"EachSizeAndRenameFails", kind_truncate | kind_rename, EIO, false, false, false},
    {"EachReadFails", kind_read, EIO, false, true, false},
    {"EachOpenFindsNoDescriptor", kind_open | kind_create, EMFILE, false, true, false},
    {"FromEachOpenOnNoDescriptor", kind_open | kind_create, EMFILE, true, true, false},
    {"FromEachCallOnTheDiskFails", changes | kind_remove, EIO, true, false, true},
};

// The result of a run in which one call, or every call from one call on, failed.
struct Tried {
    std::uint64_t calls = 0, failed = 0;
    bool ended = false;  // the daemon gave up, for example at its start
    double seconds = 0;
};

class FailingCalls : public ::testing::TestWithParam<Failure> {
  protected:
    // Delivers a volume in each way, and a file that is not a volume. Two of these deliveries come
    // before the start, the other deliveries after the start.
    static Tried run(std::uint64_t at);
};

// Waits until all files are settled. Returns true if the daemon ended instead.
bool ends_before(FaultyDaemon& daemon, SteeringFile& steering, bool lasts, std::size_t files) {
    std::optional<Clock::time_point> first;
    bool has_ended = false;
    const bool comes_to_an_end = testing::eventually([&] {
        if (lasts && steering->failed > 0 && !first) first = Clock::now();
        if (first && Clock::now() - *first > std::chrono::milliseconds{200}) steering.end();
        if (const auto status = daemon.running().ended()) {
            EXPECT_EQ(*status, 1) << daemon.log_end();
            EXPECT_EQ(daemon.log_end().find("ready: watching"), std::string::npos)
                << "the daemon may give up only at its start\n"
                << daemon.log_end();
            has_ended = true;
        }
        return has_ended || daemon.settled() >= files;
    });
    EXPECT_TRUE(comes_to_an_end) << "the daemon does not catch up\n" << daemon.log_end();
    return has_ended;
}

Tried FailingCalls::run(std::uint64_t at) {
    const Failure& failure = GetParam();
    FaultyDaemon daemon;
    const Places places = daemon.places();
    std::vector<std::filesystem::path> below = {places.state, places.cache};
    if (failure.in_drop) below.push_back(places.drop);
    SteeringFile steering(daemon.running().root() / "steering", below, failure.kinds);
    steering.fail(at, failure.lasts ? UINT64_MAX : 1, failure.error_number);
    Shipments shipments(daemon.drop(), 3, {"XFAA", "XFAB"});
    std::vector<Delivered> delivered;
    const auto put = [&](const Shipment& shipment) {
        deliver(shipment);
        delivered.push_back(shipment.delivered);
    };
    put(shipments.volume(Way::whole));
    put(shipments.volume(Way::chunks));
    const auto began = Clock::now();
    daemon.start(steering.environment());
    put(shipments.volume(Way::growing));
    put(shipments.junk());
    Tried tried;
    tried.ended = ends_before(daemon, steering, failure.lasts, files_of(delivered));
    if (failure.lasts || tried.ended) steering.end();  // otherwise the stop might fail
    if (failure.needs_restart && !tried.ended) {
        EXPECT_EQ(daemon.stop(), 0) << daemon.log_end();
    }
    if (tried.ended || failure.needs_restart) {
        daemon.start();
        EXPECT_TRUE(daemon.catches_up(files_of(delivered))) << daemon.log_end();
    }
    tried.seconds = std::chrono::duration<double>(Clock::now() - began).count();
    EXPECT_EQ(daemon.stop(), 0) << daemon.log_end();
    tried.calls = steering->calls;
    tried.failed = steering->failed;
    const Aftermath after = look_at_aftermath(places, delivered);
    EXPECT_TRUE(after.holds()) << "failed at " << at << ": " << steering->last_failed.data() << "\n"
                               << after.problem_text() << daemon.log_end();
    return tried;
}

// Makes $STORMCELLAR_FAILING_TRIES runs. In each run a different call fails; these calls are spread
// evenly over all calls.
TEST_P(FailingCalls, NothingIsLost) {
    if (is_sanitized) GTEST_SKIP() << "no other library may be loaded before the sanitizer's";
    const std::uint64_t calls = run(UINT64_MAX).calls;
    ASSERT_GT(calls, 0U);
    const auto tries = static_cast<std::uint64_t>(number_of("STORMCELLAR_FAILING_TRIES", 3));
    const std::uint64_t step = std::max<std::uint64_t>(1, calls / tries);
    std::vector<std::uint64_t> places;
    for (std::uint64_t at = 1 + step / 2; at <= calls; at += step)
        places.push_back(at);
    std::mutex mutex;
    std::size_t taken = 0, failed = 0, ended = 0;
    double longest_s = 0;
    std::vector<std::future<void>> workers;
    for (int i = 0; i < 3; ++i) {
        workers.push_back(std::async(std::launch::async, [&] {
            std::unique_lock lock(mutex);
            while (taken < places.size()) {
                const std::uint64_t at = places[taken++];
                lock.unlock();
                const Tried tried = run(at);
                lock.lock();
                failed += tried.failed > 0 ? 1 : 0;
                ended += tried.ended ? 1 : 0;
                longest_s = std::max(longest_s, tried.seconds);
            }
        }));
    }
    for (auto& worker : workers)
        worker.get();
    std::printf(
        "%s: %lu calls, %zu tried, %zu of them came to fail, %zu ended the daemon, at most "
        "%.1f s until all was there\n",
        GetParam().name, calls, places.size(), failed, ended, longest_s);
    std::fflush(stdout);
    EXPECT_GT(failed, 0U);
}

INSTANTIATE_TEST_SUITE_P(Each, FailingCalls, ::testing::ValuesIn(failures),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace stormcellar::fault
