// Tests the stream of events over sockets.
#include "web/doors/events/events.h"

#include <gtest/gtest.h>

#include "tests/testing/waiting.h"
#include "tests/web/asked.h"
#include "tests/web/raw_client.h"
#include "web/doors/api/door.h"
#include "web/doors/api/operations.h"
#include "web/http/server.h"

namespace stormcellar::web {
namespace {

using namespace std::chrono_literals;

Event event_of(const std::string& station) {
    return {EventType::sweep_gridded, station, station, level2::Moment::ref,
            "{\"station\":\"" + station + "\"}"};
}

class EventsOverHttp : public ::testing::Test {
  protected:
    void start(EventsOptions options = {}) {
        options.hub = hub_;
        door_ = std::make_shared<EventsDoor>(options);
        const auto doors = std::make_shared<Doors>();
        doors->add("/api/v1/events", door_);
        auto opened = Server::open(server_, doors);
        ASSERT_TRUE(opened) << opened.error().message;
        running_ = std::move(*opened);
        const std::string url = running_->addresses().at(0);
        port_ = std::stoi(url.substr(url.rfind(':') + 1));
    }
    // Connects and sends the request.
    std::unique_ptr<RawClient> listener(const std::string& query = "",
                                        const std::string& headers = "",
                                        const std::string& from = {}) {
        auto client = std::make_unique<RawClient>(port_, 0, from);
        client->send("GET /api/v1/events" + query + " HTTP/1.1\r\nHost: localhost\r\n" + headers +
                     "\r\n");
        return client;
    }

    const std::shared_ptr<EventHub> hub_ = EventHub::make({.kept = 16, .run = "abc"});
    ServerOptions server_;
    std::shared_ptr<EventsDoor> door_;
    std::unique_ptr<Server> running_;
    int port_ = 0;
};

TEST_F(EventsOverHttp, SendsWhatAClientWants) {
    start();
    const auto client = listener("?station=KTLX,KLOT&station=KOUN&kind=sweep_gridded&moment=REF");
    const std::string head = client->read_until("id: abc-0\n\n");
    EXPECT_EQ(status_in(head), 200);
    for (const char* header : {"Content-Type: text/event-stream", "Cache-Control: no-store",
                               "X-Accel-Buffering: no", "retry: 3000"})
        EXPECT_NE(head.find(header), std::string::npos) << header;
    for (const char* station : {"KABR", "KLOT", "KTLX"})
        hub_->publish(event_of(station));
    const std::string heard = client->read_until("\"KTLX\"}");
    EXPECT_NE(heard.find("id: abc-2\nevent: sweep_gridded\ndata: {\"station\":\"KLOT\"}\n\n"),
              std::string::npos);
    EXPECT_EQ(heard.find("KABR"), std::string::npos);
}

TEST_F(EventsOverHttp, GoesOnWhereAClientWas) {
    for (const char* station : {"KABR", "KLOT", "KTLX"})
        hub_->publish(event_of(station));
    start();
    const auto by_header = listener("", "Last-Event-ID: abc-2\r\n");
    EXPECT_EQ(by_header->read_until("KTLX\"}").find("KLOT"), std::string::npos);
    const auto by_parameter = listener("?last_event_id=abc-2");
    EXPECT_EQ(by_parameter->read_until("KTLX\"}").find("KLOT"), std::string::npos);
    const auto both = listener("?last_event_id=abc-1", "Last-Event-ID: abc-2\r\n");
    EXPECT_EQ(both->read_until("KTLX\"}").find("KLOT"), std::string::npos)
        << "the header takes precedence over the parameter";
    const auto other = listener("", "Last-Event-ID: \xff\xfe{}\r\n");
    EXPECT_NE(other->read_until("event: reset").find("event: reset"), std::string::npos);
}

TEST_F(EventsOverHttp, HeadIsAnsweredWithoutAStream) {
    start({.most_streams = 0});
    RawClient client(port_);
    client.send("HEAD /api/v1/events HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    const std::string answer = client.read_to_end();
    EXPECT_EQ(status_in(answer), 200);
    EXPECT_NE(answer.find("Content-Type: text/event-stream"), std::string::npos);
    EXPECT_EQ(body_in(answer), "");
    EXPECT_EQ(hub_->listeners(), 0u);
}

TEST_F(EventsOverHttp, WhatMakesNoSenseIsRefused) {
    start();
    for (const char* query :
         {"?station=", "?station=TULSA", "?station=KTLX,", "?domain=../x", "?domain=a.KTLX",
          "?moment=XYZ", "?kind=reset", "?kind=mosaic,tea", "?colour=red"})
        EXPECT_EQ(asked(*door_, std::string("/api/v1/events") + query).status, 400u) << query;
    std::string many = "/api/v1/events?station=K000";
    for (int i = 1; i < 65; ++i)
        many += ",K0" + std::to_string(10 + i);
    EXPECT_EQ(asked(*door_, many).status, 400u) << "65 stations";
    EXPECT_EQ(asked(*door_, "/api/v1/events/more").status, 404u);
    EXPECT_EQ(hub_->listeners(), 0u);
}

TEST_F(EventsOverHttp, StreamsHaveLimitsOfTheirOwn) {
    server_.limits.most_connections = 8;
    server_.limits.most_connections_of_address = 3;
    start({.most_streams = 6, .most_of_client = 5});
    std::vector<std::unique_ptr<RawClient>> open;
    for (int i = 0; i < 5; ++i) {
        open.push_back(listener());
        EXPECT_EQ(status_in(open.back()->read_until("id: abc-0\n\n")), 200) << i;
    }
    EXPECT_EQ(status_in(listener()->read_until("\r\n\r\n")), 503)
        << "the sixth stream of this client";
    open.push_back(listener("", "", "127.0.0.2"));
    EXPECT_EQ(status_in(open.back()->read_until("id: abc-0\n\n")), 200);
    const std::string refused = listener("", "", "127.0.0.3")->read_until("\r\n\r\n");
    EXPECT_EQ(status_in(refused), 503) << "the seventh stream of all clients";
    EXPECT_NE(refused.find("Retry-After: 10"), std::string::npos);
    EXPECT_EQ(door_->refused(), 2u);
    // Six streams are open, and this client has room for three other connections.
    for (int i = 0; i < 3; ++i) {
        open.push_back(std::make_unique<RawClient>(port_));
        open.back()->send("HEAD /api/v1/events HTTP/1.1\r\nHost: localhost\r\n\r\n");
        EXPECT_EQ(status_in(open.back()->read_until("\r\n\r\n")), 200) << i;
    }
    // A stream that ends makes room.
    open.erase(open.begin());
    ASSERT_TRUE(testing::eventually([&] { return hub_->listeners() == 5; }));
    open.push_back(listener("", "", "127.0.0.2"));
    EXPECT_EQ(status_in(open.back()->read_until("id: abc-0\n\n")), 200);
    open.clear();
    EXPECT_TRUE(testing::eventually(
        [&] { return hub_->listeners() == 0 && running_->facts().connections == 0; }));
}

TEST_F(EventsOverHttp, AClientThatReadsNothingHoldsNoEvents) {
    start();
    auto slow = std::make_unique<RawClient>(port_, 4096);
    slow->send("GET /api/v1/events HTTP/1.1\r\nHost: localhost\r\n\r\n");
    ASSERT_TRUE(testing::eventually([&] { return hub_->listeners() == 1; }));
    const auto quick = listener();
    (void)quick->read_until("id: abc-0\n\n");
    Event event = event_of("KTLX");
    event.json = "\"" + std::string(60'000, 'x') + "\"";
    for (int i = 1; i <= 200; ++i) {
        hub_->publish(event);
        (void)quick->read_until("id: abc-" + std::to_string(i) + "\n");
    }
    // The hub has published 12 MB of events, and keeps the last 16 events. The slow client reads
    // the events that the kernel holds, and then a reset, because other events are lost.
    const std::string heard = slow->read_until("event: reset");
    EXPECT_NE(heard.find("event: reset"), std::string::npos);
    EXPECT_GE(hub_->resets(), 1u);
}

TEST(EventsOfTheApi, AreDescribed) {
    const auto document = openapi_document("http://h");
    const auto& get = document["paths"]["/api/v1/events"]["get"];
    EXPECT_TRUE(get["responses"]["200"]["content"].contains("text/event-stream"));
    const std::string parameters = get["parameters"].dump();
    for (const EventTypeFacts& facts : event_types) {
        if (facts.type == EventType::reset) continue;
        EXPECT_NE(parameters.find(facts.name), std::string::npos) << facts.name;
    }
    ApiDoor without({});
    EXPECT_EQ(asked(without, "/api/v1/events").status, 404u);
}

}  // namespace
}  // namespace stormcellar::web
