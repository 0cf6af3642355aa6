// Publishes to a real broker, and to peers that are no brokers.
#include "notify/mqtt.h"

#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/notify/broker.h"

namespace stormcellar::notify {
namespace {

using ::testing::HasSubstr;

// A listening socket that closes each connection at once, or never answers.
class MqttPeer {
  public:
    explicit MqttPeer(bool closes) : closes_(closes) {
        EXPECT_EQ(::listen(listener_.number(), 8), 0);
        if (closes_) thread_ = std::thread([this] { close_all(); });
    }
    MqttPeer(const MqttPeer&) = delete;
    MqttPeer& operator=(const MqttPeer&) = delete;
    ~MqttPeer() {
        ::shutdown(listener_.number(), SHUT_RDWR);
        if (thread_.joinable()) thread_.join();
    }
    [[nodiscard]] MqttAddress address() const {
        return {"127.0.0.1", testing::port_of(listener_), "storms"};
    }

  private:
    void close_all() const {
        for (;;) {
            const Descriptor connection(::accept(listener_.number(), nullptr, nullptr));
            if (!connection.is_open()) return;
        }
    }
    const bool closes_;
    const Descriptor listener_ = testing::bound_socket();
    std::thread thread_;
};

TEST(Mqtt, ABrokerFromDebianReceivesTheMessage) {
    STORMCELLAR_NEED_BROKER();
    const testing::Broker broker;
    testing::MqttListener listener(broker.port());
    const std::string text = R"({"event":"cell","id":"20240601_220000_123_a"})";
    const Status done = publish_by_mqtt({"127.0.0.1", broker.port(), "storms/moore"}, text, {});
    ASSERT_TRUE(done) << done.error().message;
    ASSERT_TRUE(listener.has(1));
    EXPECT_EQ(listener.messages()[0].topic, "storms/moore");
    EXPECT_EQ(listener.messages()[0].text, text);
}

TEST(Mqtt, ABrokerThatChecksPasswords) {
    STORMCELLAR_NEED_BROKER();
    const testing::Broker broker("cumulonimbus");
    const MqttAddress address{"127.0.0.1", broker.port(), "storms"};
    EXPECT_TRUE(publish_by_mqtt(address, "{}", {.user = "storm", .password = "cumulonimbus"}));
    for (const MqttOptions& options :
         {MqttOptions{}, MqttOptions{.user = "storm", .password = "cirrus"}}) {
        const Status refused = publish_by_mqtt(address, "{}", options);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, ErrorCode::busy);
        EXPECT_THAT(refused.error().message, HasSubstr("uthori"));
        EXPECT_THAT(refused.error().message, Not(HasSubstr("cirrus")));
    }
}

TEST(Mqtt, NobodyListens) {
    const Status done = publish_by_mqtt({"127.0.0.1", testing::free_port(), "storms"}, "{}", {});
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::busy);
    EXPECT_THAT(done.error().message, HasSubstr("mqtt://127.0.0.1:"));
}

TEST(Mqtt, APeerThatClosesAtOnce) {
    const MqttPeer peer(true);
    const Status done = publish_by_mqtt(peer.address(), "{}", {});
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::busy);
}

TEST(Mqtt, APeerThatNeverAnswersIsLeft) {
    const MqttPeer peer(false);
    const Status done = publish_by_mqtt(peer.address(), "{}", {.longest = std::chrono::seconds{0}});
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::busy);
    EXPECT_THAT(done.error().message, HasSubstr("no answer"));
    std::atomic<bool> stop{false};
    int beats = 0;
    const Status stopped = publish_by_mqtt(
        peer.address(), "{}",
        {.longest = std::chrono::hours{1}, .stop = &stop, .beat = [&] { stop = ++beats == 3; }});
    ASSERT_FALSE(stopped);
    EXPECT_THAT(stopped.error().message, HasSubstr("stopped"));
}

TEST(Mqtt, AnInvalidTopicIsFinal) {
    STORMCELLAR_NEED_BROKER();
    const testing::Broker broker;
    const Status done = publish_by_mqtt({"127.0.0.1", broker.port(), "storms/#"}, "{}", {});
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace stormcellar::notify
