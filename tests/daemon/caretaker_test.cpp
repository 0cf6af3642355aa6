#include "daemon/care/caretaker.h"

#include <atomic>
#include <functional>

#include <gtest/gtest.h>

#include "daemon/service/ingest_sink.h"
#include "tests/daemon/made_config.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

using std::chrono::milliseconds;

class CaretakerTest : public ::testing::Test {
  protected:
    CaretakerTest() {
        auto sink = IngestSink::open(config_in(directory_.path()));
        if (sink) sink_ = std::move(*sink);
    }
    [[nodiscard]] CareOf all() {
        return {sink_->catalog(), sink_->store(), sink_->mender(), sink_->site_watch()};
    }

    testing::TemporaryDirectory directory_;
    std::unique_ptr<IngestSink> sink_;
};

// While the caretaker works, it has a pulse, by which the watchdog notices a hang. The caretaker
// has no pulse while it waits: for files to be ingested, or an hour for the next round.
TEST_F(CaretakerTest, RestsWhileThereIsNothingToDo) {
    ASSERT_TRUE(sink_);
    std::atomic<bool> idle = false;
    std::atomic<int> asked = 0;
    const Caretaker keeper(all(), {.between_rounds = milliseconds{0}},
                           {[&] {
                                ++asked;
                                return idle.load();
                            },
                            [](pipeline::PairReport) {}});
    ASSERT_TRUE(testing::eventually([&] { return asked >= 3; }));
    for (int i = 0; i < 1000; ++i)
        EXPECT_FALSE(keeper.pulse().since())
            << "the caretaker rests while files are to be ingested";
    const SteadyTime before = std::chrono::steady_clock::now();
    idle = true;
    EXPECT_TRUE(testing::eventually([&] {
        const auto since = keeper.pulse().since();
        return since && *since >= before;
    }));
    idle = false;
    EXPECT_TRUE(testing::eventually([&] { return !keeper.pulse().since(); }));
}

TEST_F(CaretakerTest, RestsBetweenItsRounds) {
    ASSERT_TRUE(sink_);
    std::atomic<int> asked = 0;
    const Caretaker keeper(all(), {.between_looks = milliseconds{1}},
                           {[&] {
                                ++asked;
                                return true;
                            },
                            [](pipeline::PairReport) {}});
    ASSERT_TRUE(testing::eventually([&] { return asked >= 100; }))
        << "the first round must be over by now";
    EXPECT_TRUE(testing::eventually([&] { return !keeper.pulse().since(); }));
}

}  // namespace
}  // namespace stormcellar::daemon
