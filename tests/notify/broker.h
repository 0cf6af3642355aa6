// tests/notify/broker.h -- the broker mosquitto on loopback, and a client that receives messages.
#pragma once

#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <mosquitto.h>

#include "tests/testing/loopback.h"
#include "tests/testing/program.h"
#include "tests/testing/waiting.h"

namespace stormcellar::testing {

inline constexpr const char* mosquitto_program = "/usr/sbin/mosquitto";

// Skips a test if the broker is missing. CI installs it (scripts/packages).
#define STORMCELLAR_NEED_BROKER()                             \
    if (!std::filesystem::exists(testing::mosquitto_program)) \
    GTEST_SKIP() << "the broker mosquitto is not installed (package mosquitto)"

// A self-signed certificate for 127.0.0.1, and its key.
class BrokerCertificate {
  public:
    BrokerCertificate() {
        const auto made = run_program(
            "/usr/bin/openssl",
            {"req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes",
             "-days", "2", "-subj", "/CN=broker", "-addext", "subjectAltName=IP:127.0.0.1",
             "-keyout", key(), "-out", file()});
        EXPECT_EQ(made.status, 0) << made.err;
    }
    [[nodiscard]] std::string file() const { return directory_ / "certificate.pem"; }
    [[nodiscard]] std::string key() const { return directory_ / "key.pem"; }

  private:
    TemporaryDirectory directory_;
};

class Broker {
  public:
    // With a password, the broker admits only the user "storm". With a certificate, it speaks TLS.
    explicit Broker(const std::string& password = {},
                    const BrokerCertificate* certificate = nullptr) {
        std::ofstream config(directory_ / "mosquitto.conf");
        config << "listener " << port_ << " 127.0.0.1\nuser root\npersistence false\n";
        config << "allow_anonymous " << (password.empty() ? "true\n" : "false\n");
        if (certificate != nullptr)
            config << "certfile " << certificate->file() << "\nkeyfile " << certificate->key()
                   << "\n";
        if (!password.empty()) {
            const std::string file = directory_ / "users";
            config << "password_file " << file << "\n";
            EXPECT_EQ(
                run_program("/usr/bin/mosquitto_passwd", {"-b", "-c", file, "storm", password})
                    .status,
                0);
        }
        config.close();
        start();
    }
    [[nodiscard]] int port() const { return port_; }
    void start() {
        program_.emplace(mosquitto_program,
                         std::vector<std::string>{"-c", directory_ / "mosquitto.conf"});
        EXPECT_TRUE(eventually([&] { return connection_to(port_).is_open(); }));
    }
    void stop() { program_.reset(); }

  private:
    TemporaryDirectory directory_;
    const int port_ = free_port();
    std::optional<RunningProgram> program_;
};

// Receives the messages of all topics.
class MqttListener {
  public:
    struct Message {
        std::string topic, text;
    };
    explicit MqttListener(int port, const std::string& user = {}, const std::string& password = {})
        : client_(mosquitto_new(nullptr, true, this), &mosquitto_destroy) {
        mosquitto_message_callback_set(client_.get(), &MqttListener::take);
        mosquitto_subscribe_callback_set(client_.get(), &MqttListener::note_subscribed);
        if (!user.empty()) mosquitto_username_pw_set(client_.get(), user.c_str(), password.c_str());
        EXPECT_EQ(mosquitto_connect(client_.get(), "127.0.0.1", port, 60), MOSQ_ERR_SUCCESS);
        EXPECT_EQ(mosquitto_subscribe(client_.get(), nullptr, "#", 1), MOSQ_ERR_SUCCESS);
        EXPECT_TRUE(eventually([&] { return look() && is_subscribed_; }));
    }
    // Waits until at least `count` messages have come.
    bool has(std::size_t count) {
        return eventually([&] { return look() && messages_.size() >= count; });
    }
    [[nodiscard]] const std::vector<Message>& messages() const { return messages_; }

  private:
    bool look() { return mosquitto_loop(client_.get(), 10, 10) == MOSQ_ERR_SUCCESS; }
    static void take(mosquitto*, void* self, const mosquitto_message* message) {
        static_cast<MqttListener*>(self)->messages_.push_back(
            {message->topic, std::string(static_cast<const char*>(message->payload),
                                         static_cast<std::size_t>(message->payloadlen))});
    }
    static void note_subscribed(mosquitto*, void* self, int, int, const int*) {
        static_cast<MqttListener*>(self)->is_subscribed_ = true;
    }

    std::vector<Message> messages_;
    bool is_subscribed_ = false;
    std::unique_ptr<mosquitto, decltype(&mosquitto_destroy)> client_;
};

}  // namespace stormcellar::testing
