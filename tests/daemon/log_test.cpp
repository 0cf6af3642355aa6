#include "daemon/log/log.h"

#include <cstdlib>
#include <functional>
#include <optional>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/daemon/journal_socket.h"
#include "tests/daemon/steady_start.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

using std::chrono::seconds;

const About ktlx_rejected{.event = Event::rejected, .station = "KTLX"};

TEST(JournalStream, IsRecognisedByWhatItNames) {
    struct stat facts {};
    ASSERT_EQ(::fstat(STDERR_FILENO, &facts), 0);
    ::setenv("JOURNAL_STREAM", fmt::format("{}:{}", facts.st_dev, facts.st_ino).c_str(), 1);
    EXPECT_TRUE(stderr_is_journal());
    EXPECT_EQ(usual_outlet().journal, "/run/systemd/journal/socket");
    ::setenv("JOURNAL_STREAM", fmt::format("{}:{}", facts.st_dev, facts.st_ino + 1).c_str(), 1);
    EXPECT_FALSE(stderr_is_journal());
    EXPECT_EQ(usual_outlet().journal, "");
    ::unsetenv("JOURNAL_STREAM");
    EXPECT_FALSE(stderr_is_journal());
}

class LogTest : public ::testing::Test {
  protected:
    void begin(const std::string& level) {
        set_up_logging(level, {.journal = socket_->path(), .clock = [this] { return now_; }});
    }
    void TearDown() override {
        set_up_logging("info");
        ::unsetenv("JOURNAL_STREAM");
    }
    int count() {
        int entries = 0;
        while (socket_->receive())
            ++entries;
        return entries;
    }
    // Logs this many lines and returns how many entries arrive. Reads them as they arrive, because
    // a socket may queue only ten entries.
    int count_of(int lines, const std::function<void(int)>& log_line) {
        int entries = 0;
        for (int i = 0; i < lines; ++i) {
            log_line(i);
            entries += count();
        }
        return entries;
    }

    testing::TemporaryDirectory directory_;
    std::optional<JournalSocket> socket_{directory_ / "journal"};
    SteadyTime now_ = t0;
};

TEST_F(LogTest, ALineBringsWhatItIsAbout) {
    begin("info");
    log_info({.event = Event::gridded,
              .station = "KTLX",
              .volume = UtcTime{std::chrono::milliseconds{1'647'475'722'000}},
              .file = "/d/a\nb\xff",
              .latency_s = 0.0851,
              .took_s = 0.0804,
              .loop = "l",
              .domain = "d",
              .reason = "corrupt"},
             "gridded {}", 1);
    EXPECT_EQ(socket_->receive_fields(),
              (JournalFields{{"MESSAGE", "gridded 1"},
                             {"PRIORITY", "6"},
                             {"SYSLOG_IDENTIFIER", "stormcellard"},
                             {"STORMCELLAR_EVENT", "gridded"},
                             {"STORMCELLAR_STATION", "KTLX"},
                             {"STORMCELLAR_VOLUME", "2022-03-17T00:08:42Z"},
                             {"STORMCELLAR_FILE", "/d/a\nb\xff"},
                             {"STORMCELLAR_LATENCY_S", "0.085"},
                             {"STORMCELLAR_TOOK_S", "0.080"},
                             {"STORMCELLAR_LOOP", "l"},
                             {"STORMCELLAR_DOMAIN", "d"},
                             {"STORMCELLAR_REASON", "corrupt"}}));
    log_error({Event::reload_failed}, "no");
    EXPECT_EQ(socket_->receive_fields(), (JournalFields{{"MESSAGE", "no"},
                                                        {"PRIORITY", "3"},
                                                        {"SYSLOG_IDENTIFIER", "stormcellard"},
                                                        {"STORMCELLAR_EVENT", "reload_failed"}}))
        << "unknown fields are left out";
}

TEST_F(LogTest, TheLevelCounts) {
    begin("warning");
    log_debug({Event::unchanged}, "x");
    log_info({Event::gridded}, "x");
    EXPECT_EQ(count(), 0);
    log_warning({Event::rejected}, "x");
    log_error({Event::drop_lost}, "x");
    EXPECT_EQ(count(), 2);
    set_log_level("debug");
    log_debug({Event::unchanged}, "x");
    EXPECT_EQ(socket_->receive_fields()->at("PRIORITY"), "7");
}

TEST_F(LogTest, AFloodIsSummedUpOnceAMinute) {
    begin("info");
    EXPECT_EQ(count_of(1254, [](int i) { log_warning(ktlx_rejected, "rejected {}", i); }), 20);
    now_ = t0 + seconds{59};
    log_held_back();
    EXPECT_EQ(count(), 0);
    now_ = t0 + seconds{60};
    log_held_back();
    EXPECT_EQ(socket_->receive_fields(),
              (JournalFields{
                  {"MESSAGE",
                   "rejected KTLX: 1234 more lines like this were not logged in the last minute"},
                  {"PRIORITY", "4"},
                  {"SYSLOG_IDENTIFIER", "stormcellard"},
                  {"STORMCELLAR_EVENT", "rejected"},
                  {"STORMCELLAR_STATION", "KTLX"},
                  {"STORMCELLAR_HELD_BACK", "1234"}}));
    log_held_back();
    EXPECT_EQ(count(), 0);
}

TEST_F(LogTest, AtTheEndNothingHeldBackIsForgotten) {
    begin("info");
    EXPECT_EQ(count_of(25, [](int i) { log_warning(ktlx_rejected, "rejected {}", i); }), 20);
    log_held_back();
    EXPECT_EQ(count(), 0) << "the minute is not over";
    log_all_held_back();
    const auto fields = socket_->receive_fields();
    ASSERT_TRUE(fields);
    EXPECT_EQ(fields->at("STORMCELLAR_HELD_BACK"), "5");
}

TEST_F(LogTest, OfALoopTheLoopIsNamed) {
    begin("info");
    const auto say = [](int) { log_info({.event = Event::loop_said, .loop = "plains"}, "x"); };
    EXPECT_EQ(count_of(21, say), 20);
    now_ = t0 + seconds{60};
    log_held_back();
    const auto fields = socket_->receive_fields();
    ASSERT_TRUE(fields);
    EXPECT_EQ(fields->at("STORMCELLAR_LOOP"), "plains");
    EXPECT_EQ(fields->at("PRIORITY"), "6") << "the priority of the lines that were held back";
}

// Whoever sets the level to debug wants all lines.
TEST_F(LogTest, LinesForDebuggingAreNotHeldBack) {
    begin("debug");
    for (int i = 0; i < 300; ++i) {
        log_debug({.event = Event::incomplete, .station = "KTLX"}, "x");
        EXPECT_EQ(count(), 1) << i;
    }
}

TEST_F(LogTest, WhereTheJournalIsGoneLinesGoToStderr) {
    socket_.reset();
    struct stat facts {};
    ASSERT_EQ(::fstat(STDERR_FILENO, &facts), 0);
    ::testing::internal::CaptureStderr();
    ASSERT_EQ(::fstat(STDERR_FILENO, &facts), 0);
    ::setenv("JOURNAL_STREAM", fmt::format("{}:{}", facts.st_dev, facts.st_ino).c_str(), 1);
    set_up_logging("info", {.journal = directory_ / "journal", .clock = {}});
    log_warning({.event = Event::rejected, .station = "KTLX"}, "rejected {}", "x");
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "<4>rejected x\n");
}

TEST_F(LogTest, WithoutAJournalLinesAreForPeople) {
    ::testing::internal::CaptureStderr();
    set_up_logging("info");
    log_warning({.event = Event::rejected, .station = "KTLX"}, "rejected {}", "x");
    const std::string line = ::testing::internal::GetCapturedStderr();
    EXPECT_EQ(line.find("Z warning: rejected x\n"), line.size() - 22) << line;
    EXPECT_EQ(count(), 0);
}

}  // namespace
}  // namespace stormcellar::daemon
