#include "daemon/loops/others_loops.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "daemon/status/status.h"
#include "tests/daemon/write_file.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

const UtcTime made_at = *parse_utc("2022-03-17T00:08:42Z", UtcTime{});

std::vector<LoopState> two_loops() {
    return {{"a", true, 2, 10, made_at, 24, ""}, {"b", false, 1, 0, std::nullopt, 0, "signal 9"}};
}

// Returns the status document of a process that runs loops.
std::string document(const char* state = "running") {
    return loops_json(two_loops(), state, made_at, made_at);
}

LoopConfig named(const char* name) {
    LoopConfig loop;
    loop.name = name;
    return loop;
}

TEST(OthersLoops, AreReadAsTheyAreWritten) {
    EXPECT_EQ(loops_of(document()), two_loops());
}

TEST(OthersLoops, DoNotRunWhenTheirProcessIsGone) {
    const auto has_running = [](const std::string& text) { return loops_of(text)[0].is_running; };
    EXPECT_FALSE(has_running(document("stopped")));
    std::string text = document();
    const std::string pid = std::to_string(::getpid());
    text.replace(text.find(pid), pid.size(), "99999999");  // above the largest process id
    EXPECT_FALSE(has_running(text));
}

TEST(OthersLoops, OfAnythingElseThereAreNone) {
    for (const char* text :
         {"", "{", "[]", "7", "null", "{}", R"({"loops":[]})", R"({"loops":{"each":7}})",
          R"({"loops":{"each":[7,"x",[]]}})", R"({"loops":"each","pid":"x","state":1})"})
        EXPECT_TRUE(loops_of(text).empty()) << text;
    const auto odd = loops_of(
        R"({"state":"running","pid":-1,"loops":{"each":[{"name":5,"running":"yes","made":-3,)"
        R"("restarts":1e300,"last_made":"soon"}]}})");
    EXPECT_EQ(odd, (std::vector<LoopState>{LoopState{}}));
}

TEST(OthersLoops, EachConfiguredOneIsThereAndNoOther) {
    const testing::TemporaryDirectory state;
    const std::vector<LoopConfig> configured = {named("c"), named("a")};
    const auto names_running = [&] {
        std::vector<std::pair<std::string, bool>> found;
        for (const LoopState& loop : others_loops(state.path(), configured))
            found.emplace_back(loop.name, loop.is_running);
        return found;
    };
    using Found = std::vector<std::pair<std::string, bool>>;
    EXPECT_EQ(names_running(), (Found{{"c", false}, {"a", false}})) << "there is no status file";
    std::filesystem::create_directory(state / "loops");
    write_file(state / "loops/status.json", document());
    EXPECT_EQ(names_running(), (Found{{"c", false}, {"a", true}}));
    EXPECT_TRUE(others_loops(state.path(), {}).empty());
}

}  // namespace
}  // namespace stormcellar::daemon
