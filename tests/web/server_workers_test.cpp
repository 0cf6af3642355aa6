// Tests how the server shares its workers, and what it does if an answer throws.
#include <atomic>
#include <future>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/testing/waiting.h"
#include "tests/web/served.h"

namespace stormcellar::web {
namespace {

using namespace std::chrono_literals;

class WebServerWorkers : public WebServer {
  protected:
    // Sends three requests, and waits until one is being answered and two wait. Returns the
    // answers.
    [[nodiscard]] std::vector<std::future<std::string>> asked_three_times(const char* target) {
        std::vector<std::future<std::string>> answers;
        for (int i = 0; i < 3; ++i)
            answers.push_back(std::async(std::launch::async, [=, this] { return get(target); }));
        EXPECT_TRUE(testing::eventually([&] {
            const ServerFacts facts = server_->facts();
            return facts.working == 1 && facts.waiting == 2;
        }));
        return answers;
    }
};

TEST_F(WebServerWorkers, ADoorWithWorkersOfItsOwnHoldsUpNoOther) {
    options_.limits.workers = 1;
    std::promise<void> released;
    const std::shared_future<void> release = released.get_future().share();
    std::atomic<int> drawn = 0;
    const auto slow = std::make_shared<FunctionDoor>([&](const Request&) {
        ++drawn;
        release.wait();
        return text_answer(200, "text/plain", "a picture");
    });
    slow->set_workers(std::make_shared<WorkQueue>(1, 1));
    doors_->add("/slow", slow);
    start();
    std::vector<std::future<std::string>> pictures;
    for (int i = 0; i < 2; ++i) {
        pictures.push_back(std::async(std::launch::async, [&] { return get("/slow"); }));
        ASSERT_TRUE(testing::eventually([&] {
            const ServerFacts facts = server_->facts();
            return facts.working + facts.waiting == pictures.size();
        }));
    }
    EXPECT_EQ(body_in(get("/other")), "at /other") << "the worker of the server is free";
    const std::string refused = get("/slow");
    EXPECT_EQ(status_in(refused), 503) << "one picture is being drawn and one request waits";
    EXPECT_NE(refused.find("Retry-After: "), std::string::npos);
    released.set_value();
    for (auto& picture : pictures)
        EXPECT_EQ(body_in(picture.get()), "a picture");
    EXPECT_EQ(drawn, 2);
}

// A request that waits while the server stops is answered if its turn comes soon, and gets 503
// otherwise.
TEST_F(WebServerWorkers, RequestsThatWaitForADoorsWorkersAreAnsweredWhenItStops) {
    for (const auto busy_for : {20ms, 2500ms}) {
        std::promise<void> released;
        const std::shared_future<void> release = released.get_future().share();
        const auto slow = std::make_shared<FunctionDoor>([release](const Request&) {
            release.wait();
            return text_answer(200, "text/plain", "a picture");
        });
        slow->set_workers(std::make_shared<WorkQueue>(1, 8));
        doors_ = std::make_shared<Doors>();
        doors_->add("/slow", slow);
        start();
        auto pictures = asked_three_times("/slow");
        auto stopped = std::async(std::launch::async, [&] { server_.reset(); });
        EXPECT_EQ(stopped.wait_for(busy_for), std::future_status::timeout)
            << "one answer is under way";
        released.set_value();
        stopped.get();
        std::multiset<int> statuses;
        for (auto& picture : pictures)
            statuses.insert(status_in(picture.get()));
        const bool is_soon = busy_for < 2s;
        EXPECT_EQ(statuses, (std::multiset<int>{200, is_soon ? 200 : 503, is_soon ? 200 : 503}));
    }
}

TEST_F(WebServerWorkers, WorkersDoNotHoldUpOthersAndBeyondTheQueueClientsComeBack) {
    options_.limits.workers = 1;
    options_.limits.most_waiting = 1;
    std::promise<void> go_on;
    const std::shared_future<void> released = go_on.get_future().share();
    add("/slow", [&](const Request&) {
        released.wait();
        return sentence(200, "done");
    });
    class QuickDoor : public Door {
      public:
        std::optional<Answer> answer_at_once(const Request&) override {
            return sentence(200, "quick");
        }
        Answer answer(const Request&) override { return sentence(500, "not asked"); }
    };
    doors_->add("/quick", std::make_shared<QuickDoor>());
    start();
    auto first = std::async(std::launch::async, [&] { return get("/slow"); });
    ASSERT_TRUE(testing::eventually([&] { return server_->facts().working == 1; }));
    auto second = std::async(std::launch::async, [&] { return get("/slow"); });
    ASSERT_TRUE(testing::eventually([&] { return server_->facts().waiting == 1; }));
    EXPECT_EQ(status_in(get("/quick")), 200);
    const std::string third = get("/slow");
    EXPECT_EQ(status_in(third), 503);
    EXPECT_NE(third.find("Retry-After: 2"), std::string::npos);
    go_on.set_value();
    EXPECT_EQ(status_in(first.get()), 200);
    EXPECT_EQ(status_in(second.get()), 200);
}

// 2026-11-28: a worker that threw, or had no memory left, ended the server.
TEST_F(WebServerWorkers, AnAnswerThatThrowsIsA503AndTheServerGoesOn) {
    class ThrowingDoor : public Door {
      public:
        std::optional<Answer> answer_at_once(const Request& request) override {
            if (request.path == "/throws/at-once") throw std::bad_alloc();
            return std::nullopt;
        }
        Answer answer(const Request& request) override {
            if (request.path == "/throws/memory") throw std::bad_alloc();
            throw std::runtime_error("/var/lib/secret: trouble");
        }
    };
    doors_->add("/throws", std::make_shared<ThrowingDoor>());
    std::mutex mutex;
    std::string trouble;
    options_.on_answer = [&](const Served& served) {
        const std::scoped_lock lock(mutex);
        if (!served.trouble.empty()) trouble = served.trouble;
    };
    start();
    for (const char* target : {"/throws/at-once", "/throws/memory", "/throws/other"}) {
        const std::string answer = get(target);
        EXPECT_EQ(status_in(answer), 503) << target;
        EXPECT_NE(answer.find("Retry-After: "), std::string::npos) << target;
        EXPECT_EQ(answer.find("/var/lib"), std::string::npos) << target;
    }
    EXPECT_EQ(status_in(get("/")), 200);
    const std::scoped_lock lock(mutex);
    EXPECT_EQ(trouble, "/var/lib/secret: trouble") << "the log gets the error";
}

// 2026-11-28: a client got 503 if a grid was being computed for another client.
TEST_F(WebServerWorkers, WhatTakesLongWaitsForWorkersOfItsOwn) {
    class LongDoor : public Door {
      public:
        explicit LongDoor(std::shared_future<void> release) : release_(std::move(release)) {}
        std::optional<Answer> answer_soon(const Request& request) override {
            if (request.path == "/long/kept") return sentence(200, "kept");
            return std::nullopt;
        }
        Answer answer(const Request&) override {
            release_.wait();
            return sentence(200, "computed");
        }

      private:
        std::shared_future<void> release_;
    };
    options_.limits.workers = 1;
    std::promise<void> released;
    const auto door = std::make_shared<LongDoor>(released.get_future().share());
    door->set_long_workers(std::make_shared<WorkQueue>(1, 8));
    doors_->add("/long", door);
    start();
    auto computed = asked_three_times("/long/grid");
    EXPECT_EQ(body_in(get("/long/kept")), "kept\n") << "the worker of the server is free";
    released.set_value();
    for (auto& one : computed)
        EXPECT_EQ(body_in(one.get()), "computed\n");
}

}  // namespace
}  // namespace stormcellar::web
