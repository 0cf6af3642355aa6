// Tests the server over sockets, with clients that behave and clients that do not.
#include <chrono>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <gtest/gtest.h>

#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"
#include "tests/web/served.h"

namespace stormcellar::web {
namespace {

using namespace std::chrono_literals;

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

TEST_F(WebServer, AnswersWithWhatEveryAnswerHas) {
    start();
    const std::string answer = get("/a/b?c=d");
    EXPECT_EQ(status_in(answer), 200);
    EXPECT_EQ(body_in(answer), "at /a/b");
    for (const char* header : {"X-Content-Type-Options: nosniff",
                               "Cross-Origin-Resource-Policy: same-origin", "Content-Length: 7"})
        EXPECT_NE(answer.find(header), std::string::npos) << header;
    EXPECT_EQ(answer.find("Access-Control-Allow-Origin"), std::string::npos);
}

// 2026-11-29: MHD_quiesce_daemon() ended the program in one of some thousand stops.
TEST_F(WebServer, StopsWhileClientsComeAndGo) {
    for (int round = 0; round < 60; ++round) {
        start();
        std::atomic<bool> ends{false};
        std::thread client([&, port = port_] {
            while (!ends) {
                const RawClient connected(port);
                (void)connected;
            }
        });
        server_.reset();
        ends = true;
        client.join();
    }
}

// The page assumes that a refusal without this header comes from a proxy whose server is gone.
TEST_F(WebServer, ARefusalOfItsOwnSaysSo) {
    add("/gone", [](const Request&) { return json_error(404, "no such grid"); });
    add("/there", [](const Request&) { return text_answer(200, "image/png", "a tile"); });
    start();
    EXPECT_NE(get("/gone").find("Stormcellar-Status: 404"), std::string::npos);
    EXPECT_EQ(get("/there").find("Stormcellar-Status"), std::string::npos);
}

// 2026-11-28: a tile of 600 bytes carried 593 bytes of headers, most of them for pages.
TEST_F(WebServer, DataHasNoHeadersOfPages) {
    add("/tile", [](const Request&) { return text_answer(200, "image/png", "a tile"); });
    add("/sentence", [](const Request&) { return text_answer(404, "text/plain", "nothing"); });
    add("/page", [](const Request&) { return text_answer(200, "text/html", "a page"); });
    add("/drawing", [](const Request&) { return text_answer(200, "image/svg+xml", "may run"); });
    start();
    const std::string tile = get("/tile");
    EXPECT_LT(tile.size(), 250u) << tile;
    for (const char* header :
         {"X-Content-Type-Options: nosniff", "Cross-Origin-Resource-Policy: same-origin"})
        EXPECT_NE(tile.find(header), std::string::npos) << header;
    EXPECT_EQ(get("/sentence").find("Content-Security-Policy"), std::string::npos);
    for (const char* path : {"/page", "/drawing"}) {
        EXPECT_NE(get(path).find("frame-ancestors 'none'"), std::string::npos);
        for (const char* header :
             {"Content-Security-Policy", "Cross-Origin-Opener-Policy: same-origin",
              "Cross-Origin-Embedder-Policy: require-corp", "Referrer-Policy: no-referrer"})
            EXPECT_NE(get(path).find(header), std::string::npos) << path << header;
    }
}

TEST_F(WebServer, LetsNamedOriginsEmbedItsPagesAlone) {
    options_.origins.embed_in = {"https://a.example", "http://b.example:8080"};
    add("/page", [](const Request&) { return text_answer(200, "text/html", "a page"); });
    add("/tile", [](const Request&) { return text_answer(200, "image/png", "a tile"); });
    start();
    const std::string page = get("/page");
    EXPECT_NE(page.find("frame-ancestors https://a.example http://b.example:8080; form-action"),
              std::string::npos);
    EXPECT_NE(page.find("Cross-Origin-Resource-Policy: cross-origin"), std::string::npos)
        << "else a page with an embedder policy could not show our page";
    EXPECT_EQ(page.find("Access-Control-Allow-Origin"), std::string::npos);
    EXPECT_NE(get("/tile").find("Cross-Origin-Resource-Policy: same-origin"), std::string::npos);
}

TEST_F(WebServer, LetsOtherPagesReadIfThatWasChosen) {
    options_.origins.any_may_read = true;
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
    EXPECT_EQ(status_in(get("/", "Host: evil.example\r\n")), 400)
        << "the request has two Host fields";
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
    EXPECT_LT(sent, 10'000'000u) << "the server closes the connection long before the end";
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
    EXPECT_TRUE(
        testing::eventually([&] { return stream->is_left() && server_->facts().streams == 0; }));
}

TEST_F(WebServer, AStreamWhoseClientIsGoneIsLeft) {
    const auto stream = std::make_shared<TestStream>();
    add_body("/events", stream);
    start();
    {
        RawClient client(port_);
        client.send("GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n");
        stream->put(":\n");
        EXPECT_NE(client.read_until(":\n").find(":\n"), std::string::npos);
    }
    EXPECT_TRUE(testing::eventually([&] {
        stream->put(":\n");
        return stream->is_left();
    }));
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
        EXPECT_LE(body_in(cut).size(), 1004u) << "fewer bytes come than Content-Length says";
        EXPECT_NE(cut.find("Content-Length: 1048"), std::string::npos);
    }
}

TEST_F(WebServer, StopsSoonWhateverIsOpen) {
    const auto stream = std::make_shared<TestStream>();
    add_body("/events", stream);
    start();
    RawClient idle(port_), half(port_), streaming(port_);
    half.send("GET / HT");
    streaming.send("GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n");
    ASSERT_TRUE(testing::eventually([&] { return server_->facts().streams == 1; }));
    server_.reset();
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
