// If the watcher cannot examine a file because descriptors have run out, the intake requests a scan
// that finds the file again.
#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "daemon/queue/intake.h"
#include "tests/daemon/write_file.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;

// While this object lives, no file can be opened; open files stay open.
class WithoutDescriptors {
  public:
    WithoutDescriptors() {
        EXPECT_EQ(::getrlimit(RLIMIT_NOFILE, &before_), 0);
        const rlimit none{3, before_.rlim_max};
        EXPECT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
    }
    WithoutDescriptors(const WithoutDescriptors&) = delete;
    WithoutDescriptors& operator=(const WithoutDescriptors&) = delete;
    ~WithoutDescriptors() { ::setrlimit(RLIMIT_NOFILE, &before_); }

  private:
    rlimit before_{};
};

class ScarceDescriptors : public ::testing::Test {
  protected:
    void SetUp() override {
#if defined(STORMCELLAR_SANITIZED)
        GTEST_SKIP() << "without a pipe, the sanitizer takes all memory for damaged";
#endif
        config_.fixed.paths.drop = directory_.path();
        events_ = std::move(*open_inotify());
        const Clock clock{[this] { return now_; }, [this] { return wall_ns_; }};
        intake_ = std::make_unique<Intake>(config_, clock);
        watcher_ = std::make_unique<Watcher>(config_.fixed.paths.drop, *events_, *intake_);
        ASSERT_TRUE(scan());
    }
    bool scan() {
        intake_->begin_scan();
        const Status scanned = watcher_->scan();
        intake_->end_scan(scanned.has_value());
        return scanned.has_value();
    }
    std::set<std::string> jobs() {
        std::set<std::string> names;
        while (const auto job = intake_->next_job())
            names.insert(job->path.lexically_relative(config_.fixed.paths.drop).native());
        return names;
    }

    testing::TemporaryDirectory directory_;
    Config config_;
    SteadyTime now_ = SteadyTime{} + std::chrono::hours{1};
    std::int64_t wall_ns_ = 4'000'000'000'000'000'000;
    std::unique_ptr<EventSource> events_;
    std::unique_ptr<Intake> intake_;
    std::unique_ptr<Watcher> watcher_;
};

TEST_F(ScarceDescriptors, AFileOfWhichAnEventToldIsFoundSoon) {
    write_file(config_.fixed.paths.drop / "a", "1");
    {
        const WithoutDescriptors none;
        watcher_->read_events();
    }
    EXPECT_GE(intake_->take_unseen(), 1U);
    EXPECT_EQ(jobs(), std::set<std::string>{});
    ASSERT_EQ(intake_->look_again_at(), now_ + seconds{1});
    now_ += seconds{1};
    ASSERT_TRUE(intake_->needs_scan());
    {
        const WithoutDescriptors none;
        EXPECT_FALSE(scan());
    }
    EXPECT_EQ(intake_->look_again_at(), now_ + seconds{2});
    EXPECT_TRUE(scan());
    EXPECT_EQ(jobs(), std::set<std::string>{"a"});
    EXPECT_FALSE(intake_->look_again_at());
}

TEST_F(ScarceDescriptors, ADirectoryOfWhichAnEventToldIsReadSoon) {
    fs::create_directory(config_.fixed.paths.drop / "day");
    write_file(config_.fixed.paths.drop / "day/a", "1");
    {
        const WithoutDescriptors none;
        watcher_->read_events();
    }
    EXPECT_EQ(intake_->take_unseen(), 1U);
    EXPECT_EQ(intake_->look_again_at(), now_ + seconds{1});
    EXPECT_TRUE(scan());
    EXPECT_EQ(jobs(), std::set<std::string>{"day/a"});
}

}  // namespace
}  // namespace stormcellar::daemon
