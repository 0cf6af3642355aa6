// Publishes to a real broker, and to peers that are no brokers.
#include "notify/mqtt.h"

#include <cstdlib>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/notify/broker.h"

namespace stormcellar::notify {
namespace {

using ::testing::HasSubstr;

// A listening socket that never answers, or sends a text to each connection and closes it.
class MqttPeer {
  public:
    explicit MqttPeer(std::optional<std::string> text) : text_(std::move(text)) {
        EXPECT_EQ(::listen(listener_.number(), 8), 0);
        if (text_) thread_ = std::thread([this] { answer_all(); });
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
    void answer_all() const {
        for (;;) {
            const Descriptor connection(::accept(listener_.number(), nullptr, nullptr));
            if (!connection.is_open()) return;
            (void)::send(connection.number(), text_->data(), text_->size(), MSG_NOSIGNAL);
        }
    }
    const std::optional<std::string> text_;
    const Descriptor listener_ = testing::bound_socket();
    std::thread thread_;
};

// Makes OpenSSL trust only the certificates of a file.
class TrustedCertificates {
  public:
    explicit TrustedCertificates(const std::string& file) {
        ::setenv("SSL_CERT_FILE", file.c_str(), 1);
    }
    TrustedCertificates(const TrustedCertificates&) = delete;
    TrustedCertificates& operator=(const TrustedCertificates&) = delete;
    ~TrustedCertificates() { ::unsetenv("SSL_CERT_FILE"); }
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

TEST(Mqtt, WithTlsTheBrokerMustHaveACertificateThatTheSystemTrusts) {
    STORMCELLAR_NEED_BROKER();
    const testing::BrokerCertificate certificate;
    const testing::Broker broker({}, &certificate);
    const MqttAddress address{"127.0.0.1", broker.port(), "storms", true};
    const Status unknown = publish_by_mqtt(address, "{}", {});
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().code, ErrorCode::busy);
    EXPECT_THAT(unknown.error().message, HasSubstr("mqtts://127.0.0.1:"));
    {
        const TrustedCertificates trusted(certificate.file());
        const Status done = publish_by_mqtt(address, "{}", {});
        EXPECT_TRUE(done) << done.error().message;
        EXPECT_FALSE(publish_by_mqtt({"localhost", broker.port(), "storms", true}, "{}", {}))
            << "the certificate is of another host";
        EXPECT_FALSE(publish_by_mqtt({"127.0.0.1", broker.port(), "storms", false}, "{}",
                                     {.longest = std::chrono::seconds{1}}));
    }
    const testing::Broker plain;
    EXPECT_FALSE(publish_by_mqtt({"127.0.0.1", plain.port(), "storms", true}, "{}", {}));
}

TEST(Mqtt, NobodyListens) {
    const Status done = publish_by_mqtt({"127.0.0.1", testing::free_port(), "storms"}, "{}", {});
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::busy);
    EXPECT_THAT(done.error().message, HasSubstr("mqtt://127.0.0.1:"));
}

TEST(Mqtt, APeerThatClosesAtOnce) {
    const MqttPeer peer("");
    const Status done = publish_by_mqtt(peer.address(), "{}", {});
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::busy);
}

TEST(Mqtt, APeerThatSendsJunk) {
    // The second text promises a packet of 256 MB, and the third acknowledges a message that was
    // not sent.
    for (const std::string& text :
         {std::string("HTTP/1.1 400 Bad Request\r\n\r\n"), std::string("\x30\xff\xff\xff\x7f", 5),
          std::string("\x40\x02\x00\x01", 4), std::string(10'000, '\xff')}) {
        const MqttPeer peer(text);
        const Status done = publish_by_mqtt(peer.address(), "{}", {});
        ASSERT_FALSE(done);
        EXPECT_EQ(done.error().code, ErrorCode::busy) << done.error().message;
    }
}

TEST(Mqtt, APeerThatNeverAnswersIsLeft) {
    const MqttPeer peer(std::nullopt);
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
