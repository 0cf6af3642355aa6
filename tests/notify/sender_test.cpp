// Sends to a server on loopback, and reads password files.
#include "notify/sender.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fetch/scripted_server.h"
#include "tests/notify/broker.h"

namespace stormcellar::notify {
namespace {

namespace fs = std::filesystem;
using testing::Asked;
using ::testing::HasSubstr;
using testing::Reply;
using testing::ScriptedServer;
using ::testing::StartsWith;

class SenderOfARule : public ::testing::Test {
  protected:
    Status send_to(const ScriptedServer& server) {
        const auto sender = make_sender({.url = server.url() + "/hook"}, stop_, [] {});
        return sender ? (*sender)("{\"a\":1}") : tl::unexpected(sender.error());
    }
    fs::path password_file(const std::string& text, int rights = 0640) {
        const fs::path file = directory_ / "password";
        std::ofstream(file) << text;
        fs::permissions(file, fs::perms(rights));
        return file;
    }
    std::string complaint(const fs::path& file) {
        const auto sender = make_sender({.password_file = file}, stop_, [] {});
        return sender ? "it was taken" : sender.error().message;
    }
    testing::TemporaryDirectory directory_;
    std::atomic<bool> stop_{false};
};

TEST_F(SenderOfARule, PostsJson) {
    ScriptedServer server([](const Asked&) { return Reply{204, ""}; });
    ASSERT_TRUE(send_to(server));
    const auto asked = server.asked();
    ASSERT_EQ(asked.size(), 1U);
    EXPECT_THAT(asked[0].head, StartsWith("POST /hook HTTP/1.1"));
    EXPECT_EQ(asked[0].header("Content-Type"), "application/json");
    EXPECT_THAT(asked[0].header("User-Agent"), StartsWith("stormcellar-notify/"));
    EXPECT_EQ(asked[0].body, "{\"a\":1}");
}

TEST_F(SenderOfARule, TellsFinalAnswersFromThoseThatMayPass) {
    int status = 0;
    ScriptedServer server([&](const Asked&) { return Reply{status, "text"}; });
    for (const int good : {200, 201, 202, 299}) {
        status = good;
        EXPECT_TRUE(send_to(server)) << good;
    }
    for (const int passing : {408, 429, 500, 502, 503, 599}) {
        status = passing;
        const Status done = send_to(server);
        ASSERT_FALSE(done) << passing;
        EXPECT_TRUE(may_pass(done.error())) << passing;
    }
    for (const int final : {301, 307, 400, 401, 403, 404, 410, 413, 499}) {
        status = final;
        const Status done = send_to(server);
        ASSERT_FALSE(done) << final;
        EXPECT_FALSE(may_pass(done.error())) << final;
        EXPECT_THAT(done.error().message, HasSubstr(std::to_string(final)));
    }
}

// A server that has accepted the message must not get it again, however its answer ends.
TEST_F(SenderOfARule, TheStatusDecides) {
    Reply reply{200, "accepted", "", Reply::Way::cut};
    ScriptedServer server([&](const Asked&) { return reply; });
    EXPECT_TRUE(send_to(server));
    reply.way = Reply::Way::endless;
    EXPECT_TRUE(send_to(server));
    reply = {400, std::string(100'000, ' '), ""};
    const Status refused = send_to(server);
    ASSERT_FALSE(refused);
    EXPECT_FALSE(may_pass(refused.error()));
}

TEST_F(SenderOfARule, NobodyListens) {
    const auto sender = make_sender(
        {.url = fmt::format("http://127.0.0.1:{}", testing::free_port())}, stop_, [] {});
    ASSERT_TRUE(sender);
    const Status done = (*sender)("{}");
    ASSERT_FALSE(done);
    EXPECT_TRUE(may_pass(done.error()));
}

TEST_F(SenderOfARule, PasswordFiles) {
    EXPECT_EQ(complaint(password_file("storm:a:b\n")), "it was taken");
    EXPECT_THAT(complaint(password_file("storm:a", 0644)), HasSubstr("every user"));
    EXPECT_THAT(complaint(password_file("storm")), HasSubstr("USER:PASSWORD"));
    EXPECT_THAT(complaint(password_file(":a")), HasSubstr("USER:PASSWORD"));
    EXPECT_THAT(complaint(password_file("")), HasSubstr("USER:PASSWORD"));
    EXPECT_THAT(complaint(directory_ / "missing"), HasSubstr("missing"));
}

TEST_F(SenderOfARule, ThePasswordReachesTheBroker) {
    STORMCELLAR_NEED_BROKER();
    const testing::Broker broker("cumulonimbus");
    testing::MqttListener listener(broker.port(), "storm", "cumulonimbus");
    const auto sender = make_sender({.mqtt = {"127.0.0.1", broker.port(), "storms"},
                                     .password_file = password_file("storm:cumulonimbus\n")},
                                    stop_, [] {});
    ASSERT_TRUE(sender);
    EXPECT_TRUE((*sender)("{}"));
    EXPECT_TRUE(listener.has(1));
}

}  // namespace
}  // namespace stormcellar::notify
