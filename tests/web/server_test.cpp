// The server, asked over sockets by clients that behave and by clients that do not.
#include "web/http/server.h"

#include <atomic>
#include <condition_variable>
#include <fstream>
#include <future>
#include <mutex>
#include <new>
#include <set>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>

#include "tests/testing/temporary_directory.h"
#include "tests/web/raw_client.h"

namespace stormcellar::web {
namespace {

using namespace std::chrono_literals;

class FunctionDoor : public Door {
  public:
    explicit FunctionDoor(std::function<Answer(const Request&)> make) : make_(std::move(make)) {}
    Answer answer(const Request& request) override { return make_(request); }

  private:
    std::function<Answer(const Request&)> make_;
};

// A stream into which a test puts lines.
class TestStream : public Stream {
  public:
    void put(std::string_view line) {
        change([&] { waiting_ += line; });
    }
    void end() {
        change([&] { has_ended_ = true; });
    }
    [[nodiscard]] bool is_left() const {
        const std::scoped_lock lock(mutex_);
        return is_left_;
    }
    std::optional<std::string> read(std::size_t most) override {
        const std::scoped_lock lock(mutex_);
        if (waiting_.empty() && has_ended_) return std::nullopt;
        std::string some = waiting_.substr(0, most);
        waiting_.erase(0, some.size());
        return some;
    }
    void on_more(std::function<void()> more) override {
        const std::scoped_lock lock(mutex_);
        more_ = std::move(more);
        is_left_ = more_ == nullptr;
    }

  private:
    template <class Change>
    void change(Change apply) {
        const std::scoped_lock lock(mutex_);
        apply();
        if (more_) more_();
    }
    mutable std::mutex mutex_;
    std::string waiting_;
    bool has_ended_ = false, is_left_ = false;
    std::function<void()> more_;
};

class WebServer : public ::testing::Test {
  protected:
    void add(std::string path, std::function<Answer(const Request&)> make) {
        doors_->add(std::move(path), std::make_shared<FunctionDoor>(std::move(make)));
    }
    void start() {
        add("/", [](const Request& request) {
            return text_answer(200, "text/plain", "at " + request.path);
        });
        options_.listen = {{"127.0.0.1", 0}};
        auto opened = Server::open(options_, doors_);
        ASSERT_TRUE(opened) << opened.error().message;
        server_ = std::move(*opened);
        const std::string url = server_->addresses().at(0);
        port_ = std::stoi(url.substr(url.rfind(':') + 1));
    }
    [[nodiscard]] std::string get(std::string_view target, std::string_view headers = "") const {
        return RawClient::get(port_, target, headers);
    }
    static bool wait_for(const std::function<bool()>& condition) {
        for (int i = 0; i < 1000 && !condition(); ++i)
            std::this_thread::sleep_for(10ms);
        return condition();
    }

    ServerOptions options_;
    std::shared_ptr<Doors> doors_ = std::make_shared<Doors>();
    std::unique_ptr<Server> server_;
    int port_ = 0;
};

TEST_F(WebServer, ADoorWithWorkersOfItsOwnHoldsUpNoOther) {
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
        ASSERT_TRUE(wait_for([&] {
            const ServerFacts facts = server_->facts();
            return facts.working + facts.waiting == pictures.size();
        }));
    }
    EXPECT_EQ(body_in(get("/other")), "at /other") << "the worker of the server is free";
    const std::string refused = get("/slow");
    EXPECT_EQ(status_in(refused), 503) << "one is drawn and one waits";
    EXPECT_NE(refused.find("Retry-After: "), std::string::npos);
    released.set_value();
    for (auto& picture : pictures)
        EXPECT_EQ(body_in(picture.get()), "a picture");
    EXPECT_EQ(drawn, 2);
}

TEST_F(WebServer, RequestsThatWaitForADoorsWorkersAreAnsweredWhenItStops) {
    std::promise<void> released;
    const std::shared_future<void> release = released.get_future().share();
    const auto slow = std::make_shared<FunctionDoor>([release](const Request&) {
        release.wait();
        return text_answer(200, "text/plain", "a picture");
    });
    slow->set_workers(std::make_shared<WorkQueue>(1, 8));
    doors_->add("/slow", slow);
    start();
    std::vector<std::future<std::string>> pictures;
    for (int i = 0; i < 3; ++i)
        pictures.push_back(std::async(std::launch::async, [&] { return get("/slow"); }));
    ASSERT_TRUE(wait_for([&] {
        const ServerFacts facts = server_->facts();
        return facts.working == 1 && facts.waiting == 2;
    }));
    auto stopped = std::async(std::launch::async, [&] { server_.reset(); });
    EXPECT_EQ(stopped.wait_for(20ms), std::future_status::timeout) << "one is under way";
    released.set_value();
    stopped.get();
    std::multiset<int> statuses;
    for (auto& picture : pictures)
        statuses.insert(status_in(picture.get()));
    EXPECT_EQ(statuses, (std::multiset<int>{200, 503, 503}));
}

TEST_F(WebServer, AnswersWithWhatEveryAnswerHas) {
    start();
    const std::string answer = get("/a/b?c=d");
    EXPECT_EQ(status_in(answer), 200);
    EXPECT_EQ(body_in(answer), "at /a/b");
    for (const char* header :
         {"X-Content-Type-Options: nosniff", "Content-Security-Policy: default-src 'none';",
          "Cross-Origin-Resource-Policy: same-origin", "Content-Length: 7"})
        EXPECT_NE(answer.find(header), std::string::npos) << header;
    EXPECT_EQ(answer.find("Access-Control-Allow-Origin"), std::string::npos);
}

// 2026-11-28: a tile of 600 bytes carried 593 bytes of headers, most of them for pages.
TEST_F(WebServer, DataHasNoHeadersOfPages) {
    add("/tile", [](const Request&) { return text_answer(200, "image/png", "a tile"); });
    add("/page", [](const Request&) { return text_answer(200, "text/html", "a page"); });
    add("/drawing", [](const Request&) { return text_answer(200, "image/svg+xml", "may run"); });
    start();
    const std::string tile = get("/tile");
    EXPECT_LT(tile.size(), 250u) << tile;
    for (const char* header :
         {"X-Content-Type-Options: nosniff", "Cross-Origin-Resource-Policy: same-origin"})
        EXPECT_NE(tile.find(header), std::string::npos) << header;
    for (const char* path : {"/page", "/drawing"}) {
        for (const char* header :
             {"Content-Security-Policy", "Cross-Origin-Opener-Policy: same-origin",
              "Cross-Origin-Embedder-Policy: require-corp", "Referrer-Policy: no-referrer"})
            EXPECT_NE(get(path).find(header), std::string::npos) << path << header;
    }
}

TEST_F(WebServer, LetsOtherPagesReadIfThatWasChosen) {
    options_.any_origin = true;
    start();
    EXPECT_NE(get("/").find("Access-Control-Allow-Origin: *"), std::string::npos);
    RawClient client(port_);
    client.send("OPTIONS /a HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    const std::string answer = client.read_to_end();
    EXPECT_EQ(status_in(answer), 204);
    EXPECT_NE(answer.find("Access-Control-Allow-Methods: GET, HEAD, OPTIONS"), std::string::npos);
}

TEST_F(WebServer, KeepsConnectionsAndAnswersPipelinedRequestsInOrder) {
    start();
    RawClient client(port_);
    client.send(
        "GET /1 HTTP/1.1\r\nHost: localhost\r\n\r\nGET /2 HTTP/1.1\r\nHost: localhost\r\n\r\n"
        "HEAD /3 HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    const std::string all = client.read_to_end();
    const std::size_t first = all.find("at /1"), second = all.find("at /2");
    EXPECT_LT(first, second);
    ASSERT_NE(second, std::string::npos);
    const std::string third = all.substr(second + 5);
    EXPECT_EQ(status_in(third), 200);
    EXPECT_NE(third.find("Content-Length: 5"), std::string::npos);
    EXPECT_EQ(body_in(third), "") << "HEAD";
}

TEST_F(WebServer, RefusesWhatItMustNotAnswer) {
    start();
    EXPECT_EQ(status_in(get("/../etc/passwd")), 400);
    EXPECT_EQ(status_in(get("/%2e%2e/etc/passwd")), 400);
    EXPECT_EQ(status_in(get("/a%00b")), 400);
    EXPECT_EQ(status_in(get("/?a=%ff")), 400);
    EXPECT_EQ(status_in(get("/", "Host: evil.example\r\n")), 400) << "two Host fields";
    RawClient other(port_);
    other.send("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n");
    EXPECT_EQ(status_in(other.read_to_end()), 421);
    RawClient post(port_);
    post.send("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n\r\nhello");
    const std::string refused = post.read_to_end();
    EXPECT_EQ(status_in(refused), 405);
    EXPECT_NE(refused.find("Allow: GET, HEAD, OPTIONS"), std::string::npos);
    RawClient smuggler(port_);
    smuggler.send(
        "GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 40\r\n\r\n"
        "GET /inner HTTP/1.1\r\nHost: localhost\r\n\r\n");
    const std::string outer = smuggler.read_to_end();
    EXPECT_EQ(status_in(outer), 413);
    EXPECT_EQ(outer.find("/inner"), std::string::npos) << "a body is never read as a request";
}

TEST_F(WebServer, RefusesHeadersWithoutEnd) {
    start();
    RawClient client(port_);
    client.send("GET / HTTP/1.1\r\nHost: localhost\r\nX: ");
    const std::string block(64 * 1024, 'x');
    std::size_t sent = 0;
    while (sent < 100'000'000 && client.send(block))
        sent += block.size();
    EXPECT_LT(sent, 10'000'000u) << "the connection is closed long before";
    EXPECT_EQ(status_in(get("/")), 200);
}

TEST_F(WebServer, GarbageIsNoRequest) {
    start();
    for (const std::string& garbage :
         {std::string{"\0\0\0\0\r\n\r\n", 8},
          std::string{"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\r\n\r\n"}, std::string{"GET\r\n\r\n"},
          std::string{"GET / HTTP/9.9\r\n\r\n"}, std::string{"\r\n\r\n"}}) {
        RawClient client(port_);
        client.send(garbage);
        const std::string answer = client.read_until("\r\n\r\n", 500ms);
        EXPECT_NE(status_in(answer), 200) << garbage;
    }
    EXPECT_EQ(status_in(get("/")), 200);
}

TEST_F(WebServer, WorkersDoNotHoldUpOthersAndBeyondTheQueueClientsComeBack) {
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
    ASSERT_TRUE(wait_for([&] { return server_->facts().working == 1; }));
    auto second = std::async(std::launch::async, [&] { return get("/slow"); });
    ASSERT_TRUE(wait_for([&] { return server_->facts().waiting == 1; }));
    EXPECT_EQ(status_in(get("/quick")), 200);
    const std::string third = get("/slow");
    EXPECT_EQ(status_in(third), 503);
    EXPECT_NE(third.find("Retry-After: 2"), std::string::npos);
    go_on.set_value();
    EXPECT_EQ(status_in(first.get()), 200);
    EXPECT_EQ(status_in(second.get()), 200);
}

// 2026-11-28: a worker that threw, or had no memory left, ended the server.
TEST_F(WebServer, AnAnswerThatThrowsIsA503AndTheServerGoesOn) {
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
    EXPECT_EQ(trouble, "/var/lib/secret: trouble") << "for the log";
}

// 2026-11-28: who asked while a grid was computed for another client was told to come back.
TEST_F(WebServer, WhatTakesLongWaitsForWorkersOfItsOwn) {
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
    std::vector<std::future<std::string>> computed;
    for (int i = 0; i < 3; ++i)
        computed.push_back(std::async(std::launch::async, [&] { return get("/long/grid"); }));
    ASSERT_TRUE(wait_for([&] {
        const ServerFacts facts = server_->facts();
        return facts.working == 1 && facts.waiting == 2;
    }));
    EXPECT_EQ(body_in(get("/long/kept")), "kept\n") << "the worker of the server is free";
    released.set_value();
    for (auto& one : computed)
        EXPECT_EQ(body_in(one.get()), "computed\n");
}

TEST_F(WebServer, StreamsSendWhatComesAndEnd) {
    const auto stream = std::make_shared<TestStream>();
    add("/events", [&](const Request&) {
        Answer answer;
        answer.with("Content-Type", "text/event-stream");
        answer.body = stream;
        return answer;
    });
    start();
    RawClient client(port_);
    client.send("GET /events HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    EXPECT_NE(client.read_until("\r\n\r\n").find("text/event-stream"), std::string::npos);
    for (const char* line : {"data: 1\n\n", "data: 2\n\n"}) {
        stream->put(line);
        EXPECT_NE(client.read_until(line).find(line), std::string::npos);
    }
    EXPECT_EQ(server_->facts().streams, 1u);
    stream->end();
    EXPECT_TRUE(client.is_closed(5s));
    EXPECT_TRUE(wait_for([&] { return stream->is_left() && server_->facts().streams == 0; }));
}

TEST_F(WebServer, AStreamWhoseClientIsGoneIsLeft) {
    const auto stream = std::make_shared<TestStream>();
    add("/events", [&](const Request&) {
        Answer answer;
        answer.body = stream;
        return answer;
    });
    start();
    {
        RawClient client(port_);
        client.send("GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n");
        stream->put(":\n");
        EXPECT_NE(client.read_until(":\n").find(":\n"), std::string::npos);
    }
    EXPECT_TRUE(wait_for([&] {
        stream->put(":\n");
        return stream->is_left();
    }));
}

TEST_F(WebServer, ConnectionsBeyondTheLimitAreClosedAndTheServerGoesOn) {
    options_.limits.most_connections = 16;
    options_.limits.most_connections_of_address = 1000;
    options_.limits.request_time = 1s;
    start();
    std::vector<std::unique_ptr<RawClient>> idle;
    for (int i = 0; i < 200; ++i)
        idle.push_back(std::make_unique<RawClient>(port_));
    EXPECT_TRUE(wait_for([&] { return server_->facts().connections <= 16; }));
    // The idle ones are ended in time, so that others find a place.
    EXPECT_TRUE(wait_for([&] { return status_in(get("/")) == 200; }));
    for (const auto& client : idle)
        EXPECT_TRUE(client->is_closed(5s));
}

TEST_F(WebServer, OneAddressDoesNotTakeAllPlaces) {
    options_.limits.most_connections_of_address = 4;
    start();
    std::vector<std::unique_ptr<RawClient>> held;
    for (int i = 0; i < 8; ++i)
        held.push_back(std::make_unique<RawClient>(port_));
    EXPECT_TRUE(wait_for([&] { return server_->facts().connections == 4; }));
    int closed = 0;
    for (const auto& client : held)
        closed += client->is_closed(200ms) ? 1 : 0;
    EXPECT_EQ(closed, 4);
}

TEST_F(WebServer, HalfARequestIsCutOffInTime) {
    options_.limits.request_time = 1s;
    start();
    RawClient client(port_);
    client.send("GET / HTTP/1.1\r\nHo");
    const auto began = std::chrono::steady_clock::now();
    // One byte now and then does not prolong it.
    bool is_open = true;
    while (is_open && std::chrono::steady_clock::now() - began < 10s) {
        is_open = client.send("s") && !client.is_closed(200ms);
    }
    EXPECT_FALSE(is_open);
    EXPECT_EQ(status_in(get("/")), 200);
}

TEST_F(WebServer, AClientThatTakesNothingIsCutOff) {
    options_.limits.rate_time = 1s;
    const Text large = text_of(std::string(64 << 20, 'x'));
    add("/large", [&](const Request&) {
        Answer answer;
        answer.body = Pieces{large};
        return answer;
    });
    start();
    RawClient client(port_, 4096);
    client.send("GET /large HTTP/1.1\r\nHost: localhost\r\n\r\n");
    ASSERT_TRUE(wait_for([&] { return server_->facts().connections == 1; }));
    EXPECT_TRUE(wait_for([&] { return server_->facts().connections == 0; }));
}

// 2026-11-28: 120 clients that took ranges of a kept answer slowly held 120 copies of it, and the
// server was killed for its memory.
TEST_F(WebServer, AnswersOnTheirWayHaveABudget) {
    constexpr std::size_t large = 8 << 20;
    options_.limits.answer_bytes = 20 << 20;
    const auto answer_with_text = [](const Text& text) {
        Answer answer;
        answer.body = Pieces{text};
        return answer;
    };
    const Text shared = text_of(std::string(large, 's'));
    add("/shared", [&, shared](const Request&) { return answer_with_text(shared); });
    add("/own", [&](const Request&) { return answer_with_text(text_of(std::string(large, 'o'))); });
    start();
    std::vector<std::unique_ptr<RawClient>> slow;
    const auto take_slowly = [&](std::string_view path, const std::string& from) {
        slow.push_back(std::make_unique<RawClient>(port_, 4096, from));
        slow.back()->send("GET " + std::string(path) + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
        return status_in(slow.back()->read_until("\r\n\r\n"));
    };
    for (int i = 0; i < 8; ++i)
        EXPECT_EQ(take_slowly("/shared", "127.0.0." + std::to_string(10 + i)), 200);
    EXPECT_EQ(server_->facts().answer_bytes, large) << "all of them share it";
    EXPECT_EQ(take_slowly("/own", "127.0.0.2"), 200);
    EXPECT_EQ(take_slowly("/own", "127.0.0.2"), 503) << "more than half of it for one client";
    EXPECT_EQ(take_slowly("/own", "127.0.0.3"), 503) << "no room";
    EXPECT_EQ(status_in(get("/")), 200) << "small answers pass";
    slow.clear();
    EXPECT_TRUE(wait_for([&] { return server_->facts().answer_bytes == 0; }));
    EXPECT_EQ(body_in(get("/own")).size(), large);
}

// 2026-11-28: a client that took 1,000 bytes a second held a connection for ten hours.
TEST_F(WebServer, AnAnswerHasATotalTime) {
    options_.limits.answer_time = 3s;
    options_.limits.rate_time = 60s;
    options_.limits.least_bytes_per_s = 10'000'000;
    const Text large = text_of(std::string(64 << 20, 'x'));
    add("/large", [&](const Request&) {
        Answer answer;
        answer.body = Pieces{large};
        return answer;
    });
    start();
    EXPECT_EQ(body_in(get("/large")).size(), large->size());
    RawClient client(port_, 4096);
    client.send("GET /large HTTP/1.1\r\nHost: localhost\r\n\r\n");
    ASSERT_TRUE(wait_for([&] { return server_->facts().connections == 1; }));
    EXPECT_TRUE(wait_for([&] {
        (void)client.read_until("never", 1ms);
        return server_->facts().connections == 0;
    }));
}

// 2026-11-28: 1,024 slow readers of five addresses kept all connections, and an honest client was
// refused ten times of ten.
TEST_F(WebServer, TheSlowestBodiesGiveWay) {
    options_.limits.most_connections = 8;
    options_.limits.most_connections_of_address = 8;
    const Text large = text_of(std::string(64 << 20, 'x'));
    add("/large", [&](const Request&) {
        Answer answer;
        answer.body = Pieces{large};
        return answer;
    });
    start();
    std::vector<std::unique_ptr<RawClient>> slow;
    for (int i = 0; i < 8; ++i) {
        slow.push_back(std::make_unique<RawClient>(port_, 4096, "127.0.0.2"));
        slow.back()->send("GET /large HTTP/1.1\r\nHost: localhost\r\n\r\n");
        EXPECT_EQ(status_in(slow.back()->read_until("\r\n\r\n")), 200);
    }
    EXPECT_TRUE(wait_for([&] { return status_in(get("/")) == 200; }));
}

TEST_F(WebServer, AFileThatIsCutWhileItIsSentEndsTheConnectionEarly) {
    const testing::TemporaryDirectory directory;
    const auto path = directory / "file";
    std::ofstream(path) << std::string(1 << 20, 'x');
    const auto file = std::make_shared<const Descriptor>(::open(path.c_str(), O_RDONLY));
    add("/file", [&](const Request& request) {
        Entity entity;
        entity.bytes = {FileSlice{file, 0, 1 << 20}};
        entity.content_type = "application/octet-stream";
        return answer_with(request, entity);
    });
    add("/joined", [&](const Request& request) {
        Entity entity;
        entity.bytes = {text_of("head"), FileSlice{file, 0, 1 << 20}};
        return answer_with(request, entity);
    });
    start();
    EXPECT_EQ(body_in(get("/file")).size(), 1u << 20);
    EXPECT_EQ(body_in(get("/joined")).size(), (1u << 20) + 4);
    std::filesystem::resize_file(path, 1000);
    for (const char* target : {"/file", "/joined"}) {
        const std::string cut = get(target);
        EXPECT_EQ(status_in(cut), 200);
        EXPECT_LE(body_in(cut).size(), 1004u) << "fewer bytes than Content-Length says";
        EXPECT_NE(cut.find("Content-Length: 1048"), std::string::npos);
    }
}

TEST_F(WebServer, StopsSoonWhateverIsOpen) {
    const auto stream = std::make_shared<TestStream>();
    add("/events", [&](const Request&) {
        Answer answer;
        answer.body = stream;
        return answer;
    });
    start();
    RawClient idle(port_), half(port_), streaming(port_);
    half.send("GET / HT");
    streaming.send("GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n");
    ASSERT_TRUE(wait_for([&] { return server_->facts().streams == 1; }));
    const auto began = std::chrono::steady_clock::now();
    server_.reset();
    EXPECT_LT(std::chrono::steady_clock::now() - began, 10s);
    EXPECT_TRUE(idle.is_closed(1s));
    EXPECT_TRUE(half.is_closed(1s));
    EXPECT_TRUE(streaming.is_closed(1s));
}

TEST_F(WebServer, AnAddressThatIsTakenOrNoneIsAnError) {
    start();
    ServerOptions options;
    options.listen = {{"127.0.0.1", port_}};
    const auto taken = Server::open(options, doors_);
    ASSERT_FALSE(taken);
    EXPECT_EQ(taken.error().code, ErrorCode::busy);
    options.listen = {{"example.org", 80}};
    const auto none = Server::open(options, doors_);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace stormcellar::web
