// Tests how clients share the threads that make answers.
#include "web/http/work_queue.h"

#include <future>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/testing/waiting.h"

namespace stormcellar::web {
namespace {

// A queue with one thread, which a client occupies until go_on() is called.
class SharedQueue : public ::testing::Test {
  protected:
    using Turn = WorkQueue::Turn;
    SharedQueue() {
        std::promise<void> began;
        EXPECT_TRUE(queue_.add("greedy", [&, this](Turn) {
            began.set_value();
            released_.get_future().wait();
        }));
        began.get_future().wait();
    }
    bool ask(const std::string& client, const std::string& name) {
        return queue_.add(client, [this, name](Turn turn) {
            const std::scoped_lock lock(mutex_);
            (turn == Turn::came ? served_ : refused_).push_back(name);
        });
    }
    void go_on() {
        released_.set_value();
        EXPECT_TRUE(
            testing::eventually([this] { return queue_.waiting() + queue_.working() == 0; }));
    }

    std::promise<void> released_;
    std::mutex mutex_;
    std::vector<std::string> served_, refused_;
    WorkQueue queue_{1, 4};
};

// 2026-11-28: one client requested large pictures on 40 connections and got all places. Another
// client requested a small picture twelve times and always got 503.
TEST_F(SharedQueue, AClientThatAsksForLessGetsAPlaceAndTheNextTurn) {
    for (const char* name : {"1", "2", "3", "4"})
        ASSERT_TRUE(ask("greedy", name));
    EXPECT_FALSE(ask("greedy", "5"));
    EXPECT_TRUE(ask("modest", "a"));
    EXPECT_EQ(refused_, (std::vector<std::string>{"4"}))
        << "the newest request of the greedy client";
    go_on();
    EXPECT_EQ(served_, (std::vector<std::string>{"a", "1", "2", "3"}));
}

TEST_F(SharedQueue, ClientsTakeTurns) {
    for (const char* name : {"a1", "a2"})
        ASSERT_TRUE(ask("a", name));
    for (const char* name : {"b1", "b2"})
        ASSERT_TRUE(ask("b", name));
    go_on();
    EXPECT_EQ(served_, (std::vector<std::string>{"a1", "b1", "a2", "b2"}));
    EXPECT_TRUE(refused_.empty());
}

// 2026-11-28: among clients with one request at a time, the client whose name sorts first always
// went first, and the other clients waited for as long as this client sent requests.
TEST_F(SharedQueue, WhoCameFirstGoesFirstWhateverItsName) {
    for (const char* name : {"z", "m", "a"})
        ASSERT_TRUE(ask(name, name));
    go_on();
    EXPECT_EQ(served_, (std::vector<std::string>{"z", "m", "a"}));
}

TEST_F(SharedQueue, ClientsWithOneRequestEachTakeNoPlaceOfEachOther) {
    for (const char* name : {"a", "b", "c", "d"})
        ASSERT_TRUE(ask(name, name));
    EXPECT_FALSE(ask("e", "e"));
    go_on();
    EXPECT_EQ(served_.size(), 4u);
}

}  // namespace
}  // namespace stormcellar::web
