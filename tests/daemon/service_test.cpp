#include "daemon/service/service.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <fstream>
#include <functional>
#include <future>
#include <memory>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/inotify.h>

#include "tests/daemon/fake_sink.h"
#include "tests/daemon/made_config.h"
#include "tests/daemon/write_file.h"
#include "tests/service/fake_notifier.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;
using pipeline::IngestResult;

// Runs a whole service on a real directory, with a sink that acts as the test says.
class ServiceTest : public ::testing::Test {
  protected:
    ServiceTest() {
        config_.reloadable.workers = 2;
        config_.reloadable.quiet = std::chrono::milliseconds{1000};
        config_.reloadable.reread = std::chrono::milliseconds{0};
    }
    ~ServiceTest() override { stop(); }

    void start(FakeSink::Answer answer, std::unique_ptr<EventSource> events = nullptr) {
        sink_ = std::make_unique<FakeSink>(std::move(answer));
        sink_->looks = looks_;
        sink_->rolls = rolls_;
        events_ = events ? std::move(events) : *open_inotify();
        service_ = std::make_unique<Service>(
            config_, root_ / "stormcellard.toml",
            ServiceParts{*sink_, *events_, notifier_, real_file_system(), signals_, clock_});
        if (needs_) service_->need(needs_);
        thread_ = std::thread([this] { stopped_ = service_->run(); });
    }
    Stopped stop() {
        if (service_) service_->request_stop();
        if (thread_.joinable()) thread_.join();
        return stopped_;
    }
    [[nodiscard]] bool has_message(const std::string& start) const {
        const auto sent = notifier_.sent();
        return std::any_of(sent.begin(), sent.end(),
                           [&](const auto& text) { return text.starts_with(start); });
    }
    bool wait_for_message(const std::string& start) {
        return testing::eventually([&] { return has_message(start); });
    }
    [[nodiscard]] nlohmann::json status() const {
        std::ifstream file(root_ / "state/status.json");
        return nlohmann::json::parse(file);
    }
    static FakeSink::Answer always(IngestResult result) {
        return [result](const auto&, bool) { return outcome_of(result); };
    }

    testing::TemporaryDirectory root_;
    Config config_ = config_in(root_.path());
    FakeNotifier notifier_;
    const Signals* signals_ = nullptr;
    Clock clock_ = real_clock();
    std::function<void(const Sink::OnStep&)> looks_, rolls_;
    Readiness::Check needs_;
    std::unique_ptr<FakeSink> sink_;
    std::unique_ptr<EventSource> events_;
    std::unique_ptr<Service> service_;
    std::thread thread_;
    Stopped stopped_ = Stopped::with_jobs;
};

TEST_F(ServiceTest, TakesWhatStoodThereAndWhatComes) {
    write_file(config_.fixed.paths.drop / "before", "1");
    start(always(IngestResult::gridded));
    ASSERT_TRUE(wait_for_message("READY=1"));
    ASSERT_TRUE(sink_->wait_for_calls(1));
    write_file(config_.fixed.paths.drop / "during", "1");
    ASSERT_TRUE(sink_->wait_for_calls(2));
    EXPECT_EQ(stop(), Stopped::cleanly);
    EXPECT_EQ(sink_->calls(), (std::vector<std::string>{"before", "during"}));
    EXPECT_EQ(status()["state"], "stopped");
    EXPECT_EQ(status()["ingested"], 2);
    EXPECT_EQ(status()["latency_s"]["count"], 1) << "nobody saw the close of the first file";
    EXPECT_TRUE(wait_for_message("STOPPING=1"));
}

TEST_F(ServiceTest, FilesAreTakenInWhileAScanGoesOn) {
    // A file that was just written waits for further writes, so make these files older.
    const auto before = fs::file_time_type::clock::now() - std::chrono::hours{1};
    for (int i = 0; i < 20'000; ++i) {
        const fs::path file = config_.fixed.paths.drop / std::to_string(i);
        write_file(file, "1");
        fs::last_write_time(file, before);
    }
    std::atomic<bool> began_before_the_end = false;
    start([&](const auto&, bool) {
        if (!has_message("READY=1")) began_before_the_end = true;
        return outcome_of(IngestResult::gridded);
    });
    ASSERT_TRUE(wait_for_message("READY=1"));
    EXPECT_TRUE(began_before_the_end) << "READY must come after the first scan";
    EXPECT_TRUE(sink_->wait_for_calls(1));
}

// Slow files of unknown stations occupy two of three workers; the last worker is reserved for
// stations.
TEST_F(ServiceTest, WhatHasToWaitIsRegisteredMeanwhile) {
    config_.reloadable.workers = 3;
    std::atomic<int> held = 0;
    std::promise<void> go_on;
    const std::shared_future<void> released = go_on.get_future().share();
    start([&](const auto& path, bool) {
        if (path.filename().native().starts_with("slow")) {
            ++held;
            released.wait();
        }
        return outcome_of(IngestResult::gridded);
    });
    ASSERT_TRUE(wait_for_message("READY=1"));
    write_file(config_.fixed.paths.drop / "slow1", "1");
    write_file(config_.fixed.paths.drop / "slow2", "1");
    ASSERT_TRUE(testing::eventually([&] { return held == 2; }));
    write_file(config_.fixed.paths.drop / "waits1", "1");
    write_file(config_.fixed.paths.drop / "waits2", "1");
    EXPECT_EQ(sink_->wait_for_noted(2), (std::vector<std::string>{"waits1", "waits2"}));
    EXPECT_TRUE(sink_->calls().empty());
    go_on.set_value();
    EXPECT_TRUE(sink_->wait_for_calls(4));
    EXPECT_EQ(stop(), Stopped::cleanly);
    EXPECT_EQ(sink_->wait_for_noted(2).size(), 2U)
        << "each waiting file once, and the slow files not at all";
}

TEST_F(ServiceTest, FinishesAnIncompleteFileThatStaysQuiet) {
    start([](const auto&, bool finish) {
        return outcome_of(finish ? IngestResult::gridded : IngestResult::incomplete);
    });
    ASSERT_TRUE(wait_for_message("READY=1"));
    write_file(config_.fixed.paths.drop / "a", "1");
    ASSERT_TRUE(sink_->wait_for_calls(2));
    stop();
    EXPECT_EQ(sink_->calls(), (std::vector<std::string>{"a", "a!"}));
}

TEST_F(ServiceTest, TriesAgainWhatCouldNotBeStored) {
    std::atomic<int> attempts = 0;
    start([&](const auto&, bool) -> Result<pipeline::IngestOutcome> {
        if (++attempts < 3) return fail(ErrorCode::no_space, "cache: full");
        return outcome_of(IngestResult::gridded);
    });
    write_file(config_.fixed.paths.drop / "a", "1");
    ASSERT_TRUE(sink_->wait_for_calls(3));
    stop();
    EXPECT_EQ(status()["failures"], 2);
    EXPECT_EQ(status()["ingested"], 1);
}

TEST_F(ServiceTest, LivesOnRescansWhereThereAreNoEvents) {
    config_.reloadable.rescan = std::chrono::milliseconds{200};
    start(always(IngestResult::gridded), no_events());
    ASSERT_TRUE(wait_for_message("READY=1"));
    fs::create_directory(config_.fixed.paths.drop / "day");
    write_file(config_.fixed.paths.drop / "day/a", "1");
    EXPECT_TRUE(sink_->wait_for_calls(1));
}

// On NFS no events come, so the service must poll.
TEST_F(ServiceTest, PollsWhereChangesComeWithoutEvents) {
    class Silent final : public EventSource {
      public:
        [[nodiscard]] int descriptor() const override { return -1; }
        Result<int> watch(const fs::path&) override { return ++watches_; }
        void unwatch(int) override {}
        std::vector<DirectoryEvent> read() override { return {}; }
        std::optional<std::string> silence(const fs::path& directory) override {
            return directory.native() + ": lies on NFS";
        }

      private:
        int watches_ = 0;
    };
    config_.reloadable.rescan = std::chrono::hours{1};
    config_.reloadable.poll = std::chrono::milliseconds{100};
    start(always(IngestResult::gridded), std::make_unique<Silent>());
    ASSERT_TRUE(wait_for_message("READY=1"));
    for (int i = 1; i <= 3; ++i) {
        write_file(config_.fixed.paths.drop / std::to_string(i), "1");
        ASSERT_TRUE(sink_->wait_for_calls(static_cast<std::size_t>(i)));
    }
    EXPECT_EQ(sink_->missing_looks(), 1) << "polls do not look at every row of the catalog";
}

// The kernel drops every event, so only the next scan can find the files.
TEST_F(ServiceTest, ScansWhenEventsWereLost) {
    class Overflowing final : public EventSource {
      public:
        Overflowing() : real_(std::move(*open_inotify())) {}
        [[nodiscard]] int descriptor() const override { return real_->descriptor(); }
        Result<int> watch(const fs::path& directory) override { return real_->watch(directory); }
        void unwatch(int watch) override { real_->unwatch(watch); }
        std::vector<DirectoryEvent> read() override {
            if (real_->read().empty()) return {};
            return {{-1, IN_Q_OVERFLOW, ""}};
        }

      private:
        std::unique_ptr<EventSource> real_;
    };
    start(always(IngestResult::gridded), std::make_unique<Overflowing>());
    ASSERT_TRUE(wait_for_message("READY=1"));
    for (int i = 0; i < 100; ++i)
        write_file(config_.fixed.paths.drop / std::to_string(i), "1");
    ASSERT_TRUE(sink_->wait_for_calls(100));
    stop();
    std::vector<std::string> calls = sink_->calls();
    std::sort(calls.begin(), calls.end());
    EXPECT_EQ(std::unique(calls.begin(), calls.end()), calls.end()) << "each file is ingested once";
    EXPECT_GE(status()["overflows"], 1);
}

TEST_F(ServiceTest, ASmallQueueLosesNothing) {
    config_.fixed.queue_limit = 16;
    for (int i = 0; i < 200; ++i)
        write_file(config_.fixed.paths.drop / std::to_string(i), "1");
    start(always(IngestResult::gridded));
    EXPECT_TRUE(sink_->wait_for_calls(200));
}

TEST_F(ServiceTest, GoesOnWhenTheDropDirectoryVanishesAndReturns) {
    config_.reloadable.rescan = std::chrono::milliseconds{200};
    start(always(IngestResult::gridded));
    ASSERT_TRUE(wait_for_message("READY=1"));
    fs::remove_all(config_.fixed.paths.drop);
    ASSERT_TRUE(testing::eventually([&] { return !status()["drop_lost"].is_null(); }));
    fs::create_directory(config_.fixed.paths.drop);
    write_file(config_.fixed.paths.drop / "a", "1");
    EXPECT_TRUE(sink_->wait_for_calls(1));
    EXPECT_EQ(stop(), Stopped::cleanly);
}

// 2026-11-22: the status showed the number of directories at the last scan, up to a minute ago.
TEST_F(ServiceTest, DirectoriesAreCountedAsTheyCome) {
    config_.reloadable.rescan = std::chrono::hours{1};
    start(always(IngestResult::gridded));
    ASSERT_TRUE(wait_for_message("READY=1"));
    ASSERT_TRUE(testing::eventually([&] { return status()["directories"] == 1; }));
    fs::create_directories(config_.fixed.paths.drop / "KTLX/494");
    EXPECT_TRUE(testing::eventually([&] { return status()["directories"] == 3; }));
    fs::remove_all(config_.fixed.paths.drop / "KTLX");
    EXPECT_TRUE(testing::eventually([&] { return status()["directories"] == 1; }));
}

// 2026-11-22: the start failed if the drop directory was mounted late or became readable late, and
// systemd gave up after ten starts. 2026-11-28: READY waited for the drop directory. The data
// server, the loops, an upgrade of the package and the machine's boot waited for READY.
TEST_F(ServiceTest, StartsBeforeItsDropDirectoryIsThere) {
    fs::remove(config_.fixed.paths.drop);
    start(always(IngestResult::gridded));
    const std::string why = config_.fixed.paths.drop.native() + ": No such file or directory";
    EXPECT_TRUE(wait_for_message("READY=1"));
    EXPECT_TRUE(wait_for_message("STATUS=waiting for the drop directory " + why + "; ingested 0"));
    ASSERT_TRUE(testing::eventually([&] { return status()["state"] == "running"; }));
    EXPECT_EQ(status()["drop_lost"], why);
    EXPECT_FALSE(fs::exists(config_.fixed.paths.drop))
        << "the service must not make LDM's directory";
    EXPECT_EQ(sink_->missing_looks(), 0)
        << "a missing directory does not mean that its files are gone";
    fs::create_directory(root_ / "made");
    write_file(root_ / "made/a", "1");
    fs::rename(root_ / "made", config_.fixed.paths.drop);
    EXPECT_TRUE(sink_->wait_for_calls(1));
    write_file(config_.fixed.paths.drop / "b", "1");
    EXPECT_TRUE(sink_->wait_for_calls(2));
    EXPECT_EQ(stop(), Stopped::cleanly);
    EXPECT_TRUE(status()["drop_lost"].is_null());
}

// 2026-11-25: the service reported READY while every socket, the state and the cache failed.
TEST_F(ServiceTest, IsReadyWhenAllThatItNeedsAnswers) {
    fs::remove_all(config_.fixed.paths.state);
    write_file(config_.fixed.paths.state, "no directory");
    std::atomic<bool> answers = false;
    needs_ = [&]() -> Status {
        if (answers) return {};
        return fail(ErrorCode::io, "the socket is taken");
    };
    start(always(IngestResult::gridded));
    EXPECT_TRUE(wait_for_message("STATUS=waiting: " + config_.fixed.paths.state.native()));
    EXPECT_FALSE(has_message("READY=1"));
    fs::remove(config_.fixed.paths.state);
    fs::create_directory(config_.fixed.paths.state);
    EXPECT_TRUE(wait_for_message("STATUS=waiting: the socket is taken"));
    write_file(config_.fixed.paths.drop / "a", "1");
    EXPECT_TRUE(sink_->wait_for_calls(1)) << "files that can be ingested must be ingested";
    EXPECT_FALSE(has_message("READY=1"));
    answers = true;
    EXPECT_TRUE(wait_for_message("READY=1"));
    EXPECT_EQ(stop(), Stopped::cleanly);
}

// The drop directory may be a link whose target appears later, for example /srv/drop ->
// /mnt/spool/nexrad2 if /mnt/spool is mounted late.
TEST_F(ServiceTest, StartsBeforeWhatItsDropDirectoryLinksTo) {
    config_.reloadable.rescan = std::chrono::milliseconds{200};
    fs::remove(config_.fixed.paths.drop);
    fs::create_directory_symlink(root_ / "spool", config_.fixed.paths.drop);
    start(always(IngestResult::gridded));
    ASSERT_TRUE(wait_for_message("STATUS=waiting for the drop directory "));
    fs::create_directory(root_ / "spool");
    write_file(root_ / "spool/a", "1");
    EXPECT_TRUE(sink_->wait_for_calls(1));
    EXPECT_EQ(stop(), Stopped::cleanly);
}

TEST_F(ServiceTest, AFileInPlaceOfTheDropDirectoryIsWaitedOutToo) {
    config_.reloadable.rescan = std::chrono::milliseconds{200};
    fs::remove(config_.fixed.paths.drop);
    write_file(config_.fixed.paths.drop, "1");
    start(always(IngestResult::gridded));
    EXPECT_TRUE(wait_for_message("STATUS=waiting for the drop directory " +
                                 config_.fixed.paths.drop.native() + ": Not a directory; "));
    EXPECT_EQ(stop(), Stopped::cleanly);
}

TEST_F(ServiceTest, StopsWithoutTakingTheRestOfTheQueue) {
    for (int i = 0; i < 50; ++i)
        write_file(config_.fixed.paths.drop / std::to_string(i), "1");
    // Each worker holds its file until the service reports that it is stopping. Files of unknown
    // stations may use only one of the two workers.
    std::atomic<int> held = 0;
    start([&](const auto&, bool) {
        ++held;
        wait_for_message("STOPPING=1");
        return outcome_of(IngestResult::gridded);
    });
    ASSERT_TRUE(testing::eventually([&] { return held > 0; }));
    EXPECT_EQ(stop(), Stopped::cleanly);
    EXPECT_LE(sink_->calls().size(), 2U) << "a worker ends its job and begins no other job";
    EXPECT_EQ(status()["ingested"], sink_->calls().size())
        << "jobs that ended during the stop count";
}

TEST_F(ServiceTest, FeedsTheWatchdogWhenIdle) {
    notifier_.period = std::chrono::milliseconds{200};
    start(always(IngestResult::gridded));
    EXPECT_TRUE(wait_for_message("WATCHDOG=1"));
}

// Returns how often the watchdog was fed.
std::ptrdiff_t meals(const FakeNotifier& notifier) {
    const auto sent = notifier.sent();
    return std::count(sent.begin(), sent.end(), "WATCHDOG=1");
}

// One of the service's own threads hangs until the test releases it. Meanwhile the service must not
// feed the watchdog. It must feed the watchdog if a thread is slow but makes steps.
class HangingThread : public ServiceTest, public ::testing::WithParamInterface<const char*> {
  protected:
    std::atomic<bool> hangs_{true};
    std::atomic<bool> hung_{false};
    void hold(const Sink::OnStep& step, bool moves_on) {
        hung_ = true;
        EXPECT_TRUE(testing::eventually([&] {
            if (moves_on) step();
            return !hangs_;
        }));
    }
    bool wait_until_it_hangs() {
        return testing::eventually([&] { return hung_.load(); });
    }
};

// The main loop of the service makes a pass (a turn) whenever the watchdog is due, and reads its
// clock several times in each turn.
TEST_P(HangingThread, StarvesTheWatchdog) {
    constexpr std::chrono::milliseconds period{200};
    constexpr int a_turn = 50, many_turns = 150;  // readings of the clock
    notifier_.period = period;
    std::atomic<int> readings = 0;
    std::atomic<std::chrono::milliseconds> ahead{};
    clock_.steady = [&] {
        ++readings;
        return steady_now() + ahead.load();
    };
    const auto reads = [&](int times) {
        return testing::eventually([&, until = readings + times] { return readings >= until; });
    };
    const std::string who = GetParam();
    const bool ingests = who == "ingest";
    if (ingests) write_file(config_.fixed.paths.drop / "file", "1");
    looks_ = [&](const Sink::OnStep& step) {
        if (who == "missing") hold(step, false);
    };
    rolls_ = [&](const Sink::OnStep& step) {
        if (who == "cache") hold(step, false);
    };
    start([&](const auto&, bool) {
        if (ingests) hold([] {}, false);
        return outcome_of(IngestResult::gridded);
    });
    EXPECT_TRUE(wait_until_it_hangs());
    ahead = 2 * period;
    EXPECT_TRUE(reads(a_turn)) << "a turn may have begun before the hang";
    const std::ptrdiff_t before = meals(notifier_);
    EXPECT_TRUE(reads(many_turns));
    EXPECT_EQ(meals(notifier_), before) << "the watchdog must not be fed";
    hangs_ = false;
    EXPECT_TRUE(testing::eventually([&] { return meals(notifier_) > before; }))
        << "the watchdog must be fed again";
    stop();  // the service refers to the clock above
}

// Tests the threads that make steps. Workers are left out, because ingesting a file is a single
// step.
class SteppingThread : public HangingThread {};

TEST_P(SteppingThread, DoesNot) {
    const std::string who = GetParam();
    notifier_.period = std::chrono::milliseconds{400};
    looks_ = [&](const Sink::OnStep& step) {
        if (who == "missing") hold(step, true);
    };
    rolls_ = [&](const Sink::OnStep& step) {
        if (who == "cache") hold(step, true);
    };
    start(always(IngestResult::gridded));
    EXPECT_TRUE(wait_until_it_hangs());
    // The watchdog is fed four times a period.
    EXPECT_TRUE(testing::eventually([&, before = meals(notifier_)] {
        return meals(notifier_) >= before + 12;
    })) << "a thread that makes steps does not hang";
    hangs_ = false;
}

std::string name_of_thread(const ::testing::TestParamInfo<const char*>& tested) {
    return tested.param;
}
INSTANTIATE_TEST_SUITE_P(All, HangingThread, ::testing::Values("ingest", "missing", "cache"),
                         name_of_thread);
INSTANTIATE_TEST_SUITE_P(All, SteppingThread, ::testing::Values("missing", "cache"),
                         name_of_thread);

// This thread blocks the signals, so that only the service receives signals to the process.
TEST_F(ServiceTest, ReloadsOnHangUpAndStopsOnTermination) {
    const Result<Signals> signals = Signals::open();
    ASSERT_TRUE(signals);
    signals_ = &*signals;
    write_file(root_ / "stormcellard.toml",
               "[paths]\ndrop = \"drop\"\nstate = \"state\"\ncache = \"elsewhere\"\n"
               "[ingest]\nworkers = 3\n[log]\nlevel = \"warning\"\n");
    start(always(IngestResult::gridded));
    ASSERT_TRUE(wait_for_message("READY=1"));
    ::pthread_kill(thread_.native_handle(), SIGHUP);
    ASSERT_TRUE(wait_for_message("RELOADING=1\nMONOTONIC_USEC="));
    EXPECT_TRUE(testing::eventually([&] {
        const auto sent = notifier_.sent();
        return std::count(sent.begin(), sent.end(), "READY=1") == 2;
    })) << "the reload has ended";
    ::pthread_kill(thread_.native_handle(), SIGTERM);
    thread_.join();
    EXPECT_EQ(stopped_, Stopped::cleanly);
    set_log_level("info");
}

}  // namespace
}  // namespace stormcellar::daemon
