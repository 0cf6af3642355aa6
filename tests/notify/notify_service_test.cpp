// Tests the way from grids in a cache to a server and a broker, with restarts and full disks.
#include "notify/notify_service.h"

#include <csignal>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/fetch/scripted_server.h"
#include "tests/notify/broker.h"
#include "tests/notify/storm_grids.h"
#include "tests/testing/power_cut_file_system.h"

namespace stormcellar::notify {
namespace {

using nlohmann::json;
using std::chrono::minutes;
using testing::Asked;
using testing::Reply;
using testing::ScriptedServer;

class NotifyOfAStorm : public ::testing::Test {
  protected:
    NotifyOfAStorm() {
        config_.cache = directory_ / "cache";
        config_.directory = directory_ / "notify";
        testing::commit_moving_storm(config_.cache, "KTLX", now_, 3, 0);
    }
    NotifyRule rule(const std::string& name, const std::string& url) {
        return {.name = name,
                .area = "KTLX",
                .latitude_deg = testing::storm_center.latitude_deg,
                .longitude_deg = testing::storm_center.longitude_deg,
                .radius_km = 20,
                .thresholds = {.max_dbz = 55},
                .url = url};
    }
    std::unique_ptr<NotifyService> open(FileSystem& file_system = real_file_system()) {
        auto opened = NotifyService::open(file_system, config_);
        EXPECT_TRUE(opened) << opened.error().message;
        return opened ? std::move(*opened) : nullptr;
    }
    // Adds the next grid of the storm, which stays near the place.
    void commit_next(minutes later) {
        testing::commit_storm(config_.cache, "KTLX", now_ + later, {.east_km = 1});
    }
    static json sent(const ScriptedServer& server, std::size_t number) {
        return json::parse(server.asked()[number].body, nullptr, false);
    }
    static bool has_asked(const ScriptedServer& server, std::size_t count) {
        return testing::eventually([&] { return server.asked().size() >= count; });
    }
    // Waits until no message waits in a directory.
    bool all_settled(const std::string& name) {
        return testing::eventually([&] {
            for (const auto& file : std::filesystem::directory_iterator(config_.directory / name))
                if (file.path().extension() == ".json") return false;
            return true;
        });
    }

    const UtcTime now_ = std::chrono::floor<std::chrono::seconds>(now_utc()) - minutes{1};
    testing::TemporaryDirectory directory_;
    NotifyConfig config_;
};

TEST_F(NotifyOfAStorm, TheWebhookGetsOneMessageInTheTime) {
    ScriptedServer server([](const Asked&) { return Reply{}; });
    config_.rules = {rule("moore", server.url()), rule("far", server.url())};
    config_.rules[1].latitude_deg += 1;
    const auto service = open();
    ASSERT_TRUE(service->turn(now_));
    ASSERT_TRUE(has_asked(server, 1));
    ASSERT_TRUE(service->turn(now_));
    commit_next(minutes{5});
    ASSERT_TRUE(service->turn(now_ + minutes{5}));
    commit_next(minutes{15});
    ASSERT_TRUE(service->turn(now_ + minutes{15}));
    ASSERT_TRUE(has_asked(server, 2));
    ASSERT_TRUE(all_settled("moore"));
    ASSERT_EQ(server.asked().size(), 2U)
        << "no other message came, and no message of the other rule";
    EXPECT_EQ(sent(server, 0)["rule"], "moore");
    EXPECT_EQ(sent(server, 0)["time"], format_utc(now_));
    EXPECT_EQ(sent(server, 1)["time"], format_utc(now_ + minutes{15}));
    EXPECT_EQ(sent(server, 0)["cell"]["id"], sent(server, 1)["cell"]["id"]);
}

TEST_F(NotifyOfAStorm, ARestartNeitherLosesNorDoublesAMessage) {
    std::atomic<int> status{503};
    ScriptedServer server([&](const Asked&) { return Reply{status}; });
    config_.rules = {rule("moore", server.url())};
    auto service = open();
    ASSERT_TRUE(service->turn(now_));
    ASSERT_TRUE(has_asked(server, 1));
    service.reset();
    const json first = sent(server, 0);
    server.forget_asked();
    status = 200;
    service = open();
    ASSERT_TRUE(has_asked(server, 1)) << "the message is sent before the service looks at any grid";
    EXPECT_EQ(sent(server, 0)["id"], first["id"]);
    ASSERT_TRUE(all_settled("moore"));
    ASSERT_TRUE(service->turn(now_));
    service = open();
    commit_next(minutes{5});
    ASSERT_TRUE(service->turn(now_ + minutes{5}));
    commit_next(minutes{15});
    ASSERT_TRUE(service->turn(now_ + minutes{15}));
    ASSERT_TRUE(has_asked(server, 2));
    EXPECT_EQ(sent(server, 1)["time"], format_utc(now_ + minutes{15}))
        << "the earlier grids are within the time without another message";
}

TEST_F(NotifyOfAStorm, AFullDiskDelaysAMessage) {
    ScriptedServer server([](const Asked&) { return Reply{}; });
    config_.rules = {rule("moore", server.url())};
    testing::PowerCutFileSystem files;
    const auto service = open(files);
    files.set_space(0);
    const Status full = service->turn(now_);
    ASSERT_FALSE(full);
    EXPECT_EQ(full.error().code, ErrorCode::no_space);
    EXPECT_TRUE(server.asked().empty());
    files.set_space(1'000'000);
    ASSERT_TRUE(service->turn(now_));
    ASSERT_TRUE(has_asked(server, 1));
    ASSERT_TRUE(all_settled("moore"));
}

TEST_F(NotifyOfAStorm, AServerThatHangsDelaysNoOther) {
    ScriptedServer hangs([](const Asked&) {
        return Reply{500, "{\"a\":1}", "", Reply::Way::hangs};
    });
    ScriptedServer answers([](const Asked&) { return Reply{}; });
    config_.rules = {rule("hangs", hangs.url()), rule("answers", answers.url())};
    auto service = open();
    ASSERT_TRUE(service->turn(now_));
    EXPECT_TRUE(has_asked(hangs, 1));
    EXPECT_TRUE(has_asked(answers, 1));
    EXPECT_LT(service->longest_silence(), minutes{1});
    service.reset();  // must not wait for the server
}

TEST_F(NotifyOfAStorm, AMissingCacheIsAnError) {
    config_.cache = directory_ / "missing";
    config_.rules = {rule("moore", "http://127.0.0.1:1")};
    const auto service = open();
    EXPECT_FALSE(service->turn(now_));
}

TEST_F(NotifyOfAStorm, APasswordFileThatIsMissingStopsTheStart) {
    config_.rules = {rule("moore", "")};
    config_.rules[0].mqtt = {"127.0.0.1", 1, "storms"};
    config_.rules[0].password_file = directory_ / "missing";
    EXPECT_FALSE(NotifyService::open(real_file_system(), config_));
}

TEST_F(NotifyOfAStorm, TheProgramReloads) {
    ScriptedServer server([](const Asked&) { return Reply{}; });
    const std::filesystem::path file = directory_ / "s.toml";
    const std::string common = "[paths]\ncache = \"cache\"\n[notify]\ndirectory = \"notify\"\n";
    std::ofstream(file) << common;
    testing::RunningProgram program(STORMCELLAR_NOTIFY, {"--config", file});
    const auto has_said = [&](const std::string& text) {
        return testing::eventually([&] { return program.err().find(text) != std::string::npos; });
    };
    ASSERT_TRUE(has_said("0 rules")) << program.err();
    std::ofstream(file) << common << "[[notify.rule]]\n";
    ::kill(program.id(), SIGHUP);
    ASSERT_TRUE(has_said("the configuration stays as it was")) << program.err();
    std::ofstream(file) << common << "[[notify.rule]]\nname = \"moore\"\narea = \"KTLX\"\n"
                        << "place = [35.0, -97.0]\nradius_km = 20\nmax_dbz = 55\nurl = \""
                        << server.url() << "\"\n";
    ::kill(program.id(), SIGHUP);
    ASSERT_TRUE(has_said("reloaded")) << program.err();
    EXPECT_TRUE(has_asked(server, 1)) << program.err();
    EXPECT_EQ(program.end(SIGTERM), 0);
}

// Runs the real program. The broker starts only after the first try.
TEST_F(NotifyOfAStorm, TheProgramPublishesToABrokerThatComesBack) {
    STORMCELLAR_NEED_BROKER();
    testing::Broker broker;
    broker.stop();
    const std::filesystem::path file = directory_ / "s.toml";
    std::ofstream(file) << "[paths]\ncache = \"cache\"\n[notify]\ndirectory = \"notify\"\n"
                        << "[[notify.rule]]\nname = \"moore\"\narea = \"KTLX\"\n"
                        << "place = [35.0, -97.0]\nradius_km = 20\nmax_dbz = 55\n"
                        << "mqtt = \"mqtt://127.0.0.1:" << broker.port() << "/storms/moore\"\n";
    testing::RunningProgram program(STORMCELLAR_NOTIFY, {"--config", file});
    ASSERT_TRUE(testing::eventually([&] {
        return program.err().find("will be tried again") != std::string::npos;
    })) << program.err();
    broker.start();
    testing::MqttListener listener(broker.port());
    ASSERT_TRUE(listener.has(1)) << program.err();
    EXPECT_EQ(listener.messages()[0].topic, "storms/moore");
    const json text = json::parse(listener.messages()[0].text, nullptr, false);
    EXPECT_EQ(text["event"], "cell");
    EXPECT_EQ(text["time"], format_utc(now_));
    EXPECT_EQ(program.end(SIGTERM), 0);
}

}  // namespace
}  // namespace stormcellar::notify
