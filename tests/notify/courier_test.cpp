// Delivers in steps, with clocks of the test's own.
#include "notify/courier.h"

#include <gtest/gtest.h>

#include "tests/testing/temporary_directory.h"

namespace stormcellar::notify {
namespace {

using std::chrono::minutes;
using std::chrono::seconds;

const UtcTime start_time = *parse_utc("2024-06-01T22:00", UtcTime{});

class CourierOfARule : public ::testing::Test {
  protected:
    void put(int minute) {
        ASSERT_TRUE(
            outbox_->put({start_time + minutes{minute}, "cell"}, fmt::format("{}", minute)));
    }
    // Steps at a time after the start.
    bool step_at(seconds time) { return courier_.step(start_time + time, SteadyTime{} + time); }

    testing::TemporaryDirectory directory_;
    std::unique_ptr<Outbox> outbox_ = *Outbox::open(real_file_system(), directory_ / "box");
    Status answer_;
    std::vector<std::string> sent_;
    Courier courier_{"rule", *outbox_, [this](const std::string& text) {
                         sent_.push_back(text);
                         return answer_;
                     }};
};

TEST_F(CourierOfARule, DeliversTheOldestFirst) {
    put(5);
    put(0);
    EXPECT_TRUE(step_at(seconds{1}));
    EXPECT_TRUE(step_at(seconds{1}));
    EXPECT_FALSE(step_at(seconds{1}));
    EXPECT_EQ(sent_, (std::vector<std::string>{"0", "5"}));
    EXPECT_EQ(outbox_->waiting(), 0U);
}

TEST_F(CourierOfARule, TriesAgainWithLongerPausesUntilItSucceeds) {
    put(0);
    answer_ = fail(ErrorCode::busy, "away");
    std::vector<seconds::rep> tries;
    for (seconds time{0}; time < minutes{5}; ++time) {
        const std::size_t before = sent_.size();
        EXPECT_FALSE(step_at(time));
        if (sent_.size() > before) tries.push_back(time.count());
    }
    EXPECT_EQ(tries, (std::vector<seconds::rep>{0, 1, 3, 7, 15, 31, 63, 123, 183, 243}));
    answer_ = {};
    EXPECT_TRUE(step_at(minutes{6}));
    EXPECT_EQ(outbox_->waiting(), 0U);
    put(6);
    EXPECT_TRUE(step_at(minutes{6})) << "after a success the pause is over";
}

TEST_F(CourierOfARule, FinalFailuresDropTheMessageAtOnce) {
    put(0);
    answer_ = fail(ErrorCode::io, "the server answered 403");
    EXPECT_TRUE(step_at(seconds{0}));
    EXPECT_EQ(outbox_->waiting(), 0U);
    EXPECT_EQ(sent_.size(), 1U);
}

TEST_F(CourierOfARule, OldMessagesAreDroppedAndNotSent) {
    put(0);
    put(10);
    answer_ = fail(ErrorCode::busy, "away");
    EXPECT_FALSE(step_at(minutes{60})) << "the message is still worth a try";
    EXPECT_EQ(outbox_->waiting(), 2U);
    EXPECT_FALSE(step_at(minutes{61}));
    EXPECT_EQ(outbox_->waiting(), 1U);
    EXPECT_EQ(sent_, (std::vector<std::string>{"0", "10"}));
}

// A restart in the middle of a row of failures delivers the message once.
TEST_F(CourierOfARule, ARestartGoesOn) {
    put(0);
    answer_ = fail(ErrorCode::busy, "away");
    EXPECT_FALSE(step_at(seconds{0}));
    const auto again = *Outbox::open(real_file_system(), directory_ / "box");
    std::vector<std::string> sent;
    Courier later("rule", *again, [&](const std::string& text) {
        sent.push_back(text);
        return Status{};
    });
    EXPECT_TRUE(later.step(start_time, SteadyTime{}));
    EXPECT_FALSE(later.step(start_time, SteadyTime{}));
    EXPECT_EQ(sent, std::vector<std::string>{"0"});
}

TEST_F(CourierOfARule, AMessageThatCannotBeReadIsDropped) {
    put(0);
    std::filesystem::remove(directory_ / "box" / (outbox_->oldest()->id() + ".json"));
    EXPECT_TRUE(step_at(seconds{0}));
    EXPECT_FALSE(step_at(seconds{0}));
    EXPECT_TRUE(sent_.empty());
}

}  // namespace
}  // namespace stormcellar::notify
