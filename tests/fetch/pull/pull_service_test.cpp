// Pulls from several machines at once, and tests the status file.
#include "fetch/pull/pull_service.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/fetch/scripted_server.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"

namespace stormcellar::pull {
namespace {

using nlohmann::json;
using testing::Asked;
using testing::Reply;
using testing::ScriptedServer;

json status_of(const std::filesystem::path& directory) {
    const auto bytes = read_file(directory / "status.json");
    if (!bytes) return {};
    const auto* const begin = reinterpret_cast<const char*>(bytes->data());
    return json::parse(begin, begin + bytes->size(), nullptr, false);
}

// Waits until the state of a machine is as expected, at most ten seconds. Returns the state.
std::string state_of(PullService& service, const std::filesystem::path& directory,
                     std::size_t number, const std::string& expected) {
    std::string state;
    (void)testing::eventually([&] {
        EXPECT_TRUE(service.publish());
        state = status_of(directory)["sources"][number]["state"];
        return state == expected;
    });
    return state;
}

TEST(PullService, OneMachineThatHangsHoldsUpNoOther) {
    const testing::TemporaryDirectory directory;
    ScriptedServer hangs([](const Asked&) {
        return Reply{200, "{\"grids\":[]}", "", Reply::Way::hangs};
    });
    ScriptedServer answers([](const Asked&) { return Reply{200, "{\"grids\":[]}"}; });
    PullConfig config;
    config.directory = directory / "pull";
    config.stall = std::chrono::hours{1};
    config.every = std::chrono::milliseconds{100};
    config.sources = {{"hangs", hangs.url(), {}}, {"answers", answers.url(), {}}};
    auto service = PullService::open(real_file_system(), config);
    ASSERT_TRUE(service) << service.error().message;
    EXPECT_EQ(state_of(**service, config.directory, 1, "answering"), "answering");
    EXPECT_EQ(state_of(**service, config.directory, 0, "starting"), "starting");
    auto silence = (*service)->longest_silence();
    EXPECT_TRUE(testing::eventually([&] {
        const auto now = (*service)->longest_silence();
        return std::exchange(silence, now) > now;
    })) << "the thread still takes steps while a transfer hangs";
    service->reset();  // must not wait for the machine, which would take an hour
}

TEST(PullService, AMachineThatIsAwayIsNamedAndAskedAgain) {
    const testing::TemporaryDirectory directory;
    std::atomic<bool> is_away{true};
    ScriptedServer server([&](const Asked&) {
        return is_away ? Reply{500, ""} : Reply{200, "{\"grids\":[]}"};
    });
    PullConfig config;
    config.directory = directory / "pull";
    config.sources = {{"north", server.url(), {}}};
    auto service = PullService::open(real_file_system(), config);
    ASSERT_TRUE(service);
    EXPECT_EQ(state_of(**service, config.directory, 0, "failing"), "failing");
    const json failing = status_of(config.directory)["sources"][0];
    EXPECT_NE(std::string(failing["error"]).find("500"), std::string::npos);
    EXPECT_TRUE(failing["next_try"].is_string());
    is_away = false;
    EXPECT_EQ(state_of(**service, config.directory, 0, "answering"), "answering");
}

}  // namespace
}  // namespace stormcellar::pull
