// Runs the real program with few watches or no inotify instance, and on files that vanish at any
// moment.

#include "tests/daemon/hostile_drop.h"
#include "tests/testing/program.h"
#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;
namespace wire = level2::wire;
using nlohmann::json;
using wire::Bytes;

// Runs the daemon in a user namespace of its own, in which the test may limit watches and
// instances.
class FewWatches : public HostileDrop {
  protected:
    // Sets a limit of this user namespace. Returns false if the system does not allow this.
    bool limit(const std::string& name, int value) {
        const std::string set =
            "echo " + std::to_string(value) + " > /proc/sys/user/max_inotify_" + name;
        if (testing::run_program("/usr/bin/unshare", {"-Ur", "sh", "-c", set}).status != 0)
            return false;
        daemon_.run_under({"unshare", "-Ur", "sh", "-c", set + " && exec \"$@\"", "sh"});
        return true;
    }
    void expect_polling() {
        for (const char* name : {"a", "b", "c"}) {
            put(drop() / name / "KTLX_new", volume());
            ASSERT_TRUE(wait_until_gridded(std::string{name} + "/KTLX_new")) << daemon_.log();
        }
        EXPECT_EQ(daemon_.terminate(), 0);
    }
};

constexpr const char* polled =
    "[ingest]\nspacing_km = 4\n[watch]\nrescan_seconds = 86400\npoll_seconds = 1\n";

TEST_F(FewWatches, WithoutWatchesTheRestIsPolled) {
    if (!limit("watches", 2)) GTEST_SKIP() << "limits of watches cannot be set here";
    for (const char* name : {"a", "b", "c"})
        fs::create_directory(drop() / name);
    daemon_.start(polled);
    ASSERT_TRUE(
        was_said("no inotify watch is left; raise the sysctl user.max_inotify_watches (now 2); the "
                 "service polls the drop directory"));
    expect_polling();
    const std::string log = daemon_.log();
    EXPECT_EQ(log.find("no inotify watch is left"), log.rfind("no inotify watch is left"))
        << "the lack of watches is reported once";
}

TEST_F(FewWatches, WithoutAnInstanceEverythingIsPolled) {
    if (!limit("instances", 0)) GTEST_SKIP() << "limits of instances cannot be set here";
    daemon_.start(polled);
    ASSERT_TRUE(was_said("raise the sysctl user.max_inotify_instances (now 0)"));
    expect_polling();
}

using WatchFacts = HostileDrop;

// LDM's scour deletes old files, even while the service handles them.
TEST_F(WatchFacts, FilesMayGoAtAnyMoment) {
    start();
    const Bytes bytes = volume();
    for (int i = 0; i < 150; ++i) {
        const fs::path directory = drop() / ("day" + std::to_string(i / 30));
        put(directory / ("KTLX_" + std::to_string(i)), bytes);
        testing::pass_time(std::chrono::milliseconds{i % 7 * 3});
        if (i >= 2)
            fs::remove(drop() / ("day" + std::to_string((i - 2) / 30)) /
                       ("KTLX_" + std::to_string(i - 2)));
        if (i % 30 == 29) fs::remove_all(directory);
    }
    put(drop() / "KTLX_good", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_good")) << daemon_.log();
    const std::uint64_t scans = daemon_.status()["scans"];
    ASSERT_TRUE(daemon_.wait_for([&](const json& s) {
        return s["scans"] >= scans + 2 && s["pending"]["waiting"] == 0 &&
               s["pending"]["running"] == 0 && s["pending"]["growing"] == 0;
    })) << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0);
    EXPECT_EQ(daemon_.status()["failures"], 0) << daemon_.log();
    EXPECT_EQ(daemon_.status()["rejected"], 0) << daemon_.log();
    auto catalog = catalog::CatalogReader::open(daemon_.catalog());
    const auto entries = catalog->list("KTLX", {std::nullopt, std::nullopt, true});
    ASSERT_TRUE(entries);
    for (const catalog::CatalogEntry& entry : *entries) {
        const bool stands = fs::exists(entry.path);
        EXPECT_EQ(entry.state == catalog::FileState::gone, !stands) << entry.path;
    }
}

}  // namespace
}  // namespace stormcellar::daemon
