// Tests when RowKeeper looks for missing files and deletes their rows, and what it logs.
#include "daemon/care/row_keeper.h"

#include <atomic>
#include <optional>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

#include "daemon/log/log.h"
#include "tests/daemon/fake_sink.h"
#include "tests/daemon/journal_socket.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;

class RowSink final : public IdleSink {
  public:
    Result<int> mark_missing(const OnStep& /*step*/) override {
        is_held = hold.load();
        EXPECT_TRUE(testing::eventually([this] { return !hold; }));
        if (throws) throw std::runtime_error("no memory");
        ++looks;
        return 0;
    }
    Result<int> forget_gone(UtcTime before, const OnStep& /*step*/) override {
        kept = now_utc() - before;
        if (++deletions == 3) return fail(ErrorCode::no_space, "disk full");
        return 12;
    }
    std::atomic<int> looks{0}, deletions{0};
    std::atomic<bool> hold{false}, is_held{false}, throws{false};
    std::atomic<milliseconds> kept{};
};

class RowKeeperTest : public ::testing::Test {
  protected:
    void SetUp() override {
        set_up_logging("info",
                       {.journal = journal_.path(), .clock = std::chrono::steady_clock::now});
    }
    void TearDown() override { set_up_logging("info"); }
    // Makes the keeper look again and again until it has looked `looks` times.
    void look(int looks, milliseconds gone_rows_kept_for = {}) {
        EXPECT_TRUE(testing::eventually([&] {
            keeper_->look(now_, gone_rows_kept_for);
            return sink_.looks >= looks;
        }));
        wait_for_rest();
    }
    void wait_for_rest() {
        EXPECT_TRUE(testing::eventually([this] { return !keeper_->pulse().since(); }));
    }
    // Returns the next line of the log; "" if none comes.
    std::string next_line() {
        std::string line;
        (void)testing::eventually([&] {
            const auto fields = journal_.receive_fields();
            if (fields) line = fields->at("MESSAGE");
            return fields.has_value();
        });
        return line;
    }
    testing::TemporaryDirectory directory_;
    JournalSocket journal_{directory_ / "journal"};
    RowSink sink_;
    std::atomic<milliseconds> ahead_{};  // added to the clock that measures the work
    std::optional<RowKeeper> keeper_{std::in_place, sink_,
                                     [this] { return steady_now() + ahead_.load(); }};
    SteadyTime now_{seconds{100'000}};
};

TEST_F(RowKeeperTest, ForgetsNothingUnlessAsked) {
    look(1);
    now_ += hours{2};
    look(2);
    EXPECT_EQ(sink_.deletions, 0);
}

TEST_F(RowKeeperTest, ForgetsOnceAnHour) {
    look(1, hours{48});
    EXPECT_EQ(sink_.deletions, 1);
    EXPECT_NEAR(std::chrono::duration<double>(sink_.kept.load()).count(), 48 * 3600, 60);
    EXPECT_EQ(next_line(),
              "deleted the catalog rows of 12 files marked as gone: they were older than [catalog] "
              "gone_days");
    now_ += RowKeeper::between_deletions - seconds{1};
    look(2, hours{48});
    EXPECT_EQ(sink_.deletions, 1);
    now_ += seconds{2};
    look(3, hours{48});
    EXPECT_EQ(sink_.deletions, 2);
    EXPECT_EQ(next_line(),
              "deleted the catalog rows of 12 files marked as gone: they were older than [catalog] "
              "gone_days");
    now_ += RowKeeper::between_deletions;
    look(4, hours{48});
    EXPECT_EQ(next_line(), "cannot delete the catalog rows of files that are gone: disk full");
}

TEST_F(RowKeeperTest, TakesATenthOfTheTimeAtMost) {
    sink_.hold = true;
    keeper_->look(now_, {});
    EXPECT_TRUE(testing::eventually([this] { return sink_.is_held.load(); }));
    ahead_ = milliseconds{200};
    keeper_->look(now_ + seconds{60}, {});
    sink_.hold = false;
    wait_for_rest();
    EXPECT_EQ(sink_.looks, 1) << "the keeper must not look while it works";
    keeper_->look(now_ + seconds{1}, {});
    keeper_->look(now_ + milliseconds{2199}, {});
    keeper_.reset();  // waits for the end of the work
    EXPECT_EQ(sink_.looks, 1) << "the keeper must not look while it rests";
}

TEST_F(RowKeeperTest, GoesOnWhenALookFails) {
    sink_.throws = true;
    keeper_->look(now_, {});
    EXPECT_EQ(next_line(), "cannot check which cataloged files are gone: no memory");
    sink_.throws = false;
    now_ += hours{1};
    look(1);
    EXPECT_EQ(sink_.looks, 1);
}

}  // namespace
}  // namespace stormcellar::daemon
