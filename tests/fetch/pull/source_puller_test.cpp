// Pulls from one machine. Its grids must arrive whole, and its faults must do no harm.
#include "fetch/pull/source_puller.h"

#include <algorithm>
#include <fstream>
#include <new>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/cache/store.h"
#include "tests/cache/made_grids.h"
#include "tests/fetch/scripted_server.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"

namespace stormcellar::pull {
namespace {

namespace fs = std::filesystem;
using testing::Asked;
using ::testing::HasSubstr;
using testing::Reply;
using testing::ScriptedServer;

std::string text_of(const fs::path& path) {
    const auto bytes = read_file(path);
    return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "";
}

// A machine that has two partials of the domain "us", and answers as a data server does.
class OtherMachine {
  public:
    OtherMachine() : server_([this](const Asked& asked) { return answer(asked); }) {
        add(std::chrono::minutes{30}, 0);
        add(std::chrono::minutes{10}, 1);
    }
    [[nodiscard]] std::string url() const { return server_.url(); }
    [[nodiscard]] ScriptedServer& server() { return server_; }
    [[nodiscard]] const cache::GridName& name(std::size_t number) const {
        return names_.at(number);
    }
    [[nodiscard]] std::string file(std::size_t number) const {
        return text_of(store_.directory() / cache::relative_path(name(number)));
    }
    void add(std::chrono::minutes age, int shift) {
        names_.push_back({"us.KBGM", level2::Moment::ref, now_utc() - age});
        write(names_.back(), shift);
    }
    // Makes grid `number` again with other cells.
    void make_again(std::size_t number) { write(names_.at(number), 5); }
    // The next functions change the answers to requests for files, for lists, and for missing
    // files.
    std::function<Reply(Reply)> of_files = [](Reply reply) { return reply; };
    std::function<Reply(Reply)> of_lists = [](Reply reply) { return reply; };
    std::function<Reply(Reply)> of_missing = [](Reply reply) { return reply; };

  private:
    void write(const cache::GridName& name, int shift) {
        grid::Grid grid = testing::small_grid();
        grid.time = grid.start_time = name.time;
        grid.end_time = grid.time + std::chrono::minutes{5};
        for (float& value : grid.values)
            value += static_cast<float>(shift);
        const auto bricks =
            grid::BrickGrid::from(grid, grid::default_quantization(level2::Moment::ref));
        EXPECT_TRUE(store_.commit(name.domain, cache::describe(grid), bricks.view()));
    }
    Reply answer(const Asked& asked) {
        if (asked.path.starts_with("/api/v1/grids?")) return of_lists(list(asked));
        for (const cache::GridName& name : names_) {
            if (asked.path != file_url_of(name)) continue;
            const fs::path path = store_.directory() / cache::relative_path(name);
            const auto file = cache::GridFile::open(path);
            const std::string tag = fmt::format("\"{:016x}\"", file->checksum());
            Reply reply{200, text_of(path), "ETag: " + tag + "\r\n", Reply::Way::whole};
            if (asked.header("If-None-Match") == tag)
                reply = {304, "", "ETag: " + tag + "\r\n", Reply::Way::whole};
            return of_files(std::move(reply));
        }
        return of_missing({404, "no"});
    }
    [[nodiscard]] Reply list(const Asked& asked) const {
        std::string text;
        for (const cache::GridName& name : names_)
            text += fmt::format("{}{{\"domain\":\"{}\",\"moment\":\"REF\",\"time\":\"{}\"}}",
                                text.empty() ? "" : ",", name.domain, format_utc(name.time));
        const std::string tag = "\"of-the-list\"";
        if (asked.header("If-None-Match") == tag) return {304, ""};
        return {200, "{\"grids\":[" + text + "]}", "ETag: " + tag + "\r\n", Reply::Way::whole};
    }
    [[nodiscard]] static std::string file_url_of(const cache::GridName& name) {
        return fmt::format("/api/v1/grids/{}/REF/{}/file", name.domain, format_utc(name.time));
    }

    testing::TemporaryDirectory directory_;
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", false);
    std::vector<cache::GridName> names_;
    ScriptedServer server_;  // last, because it uses the members above
};

class Pulling : public ::testing::Test {
  protected:
    Pulling() { config_.stall = std::chrono::seconds{1}; }
    [[nodiscard]] fs::path north() const { return directory_ / "north"; }
    std::unique_ptr<SourcePuller> puller() {
        auto grids =
            PulledGrids::open(real_file_system(), north(), {config_.bytes_a_source, config_.age});
        EXPECT_TRUE(grids) << grids.error().message;
        return std::make_unique<SourcePuller>(PullSource{"north", other_.url(), {"us"}}, config_,
                                              std::move(*grids), stop_);
    }
    // Sets the limit to the bytes that the directory now has, and offers two more grids.
    void reach_the_limit() {
        const auto north = puller();
        ASSERT_TRUE(north->turn());
        config_.bytes_a_source = north->status().bytes;
        other_.add(std::chrono::minutes{5}, 2);
        other_.add(std::chrono::minutes{4}, 3);
    }
    [[nodiscard]] std::string pulled(std::size_t number) const {
        return text_of(north() / cache::relative_path(other_.name(number)));
    }
    // Returns all files below the directory.
    [[nodiscard]] std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::recursive_directory_iterator(north()))
            if (entry.is_regular_file()) names.push_back(entry.path().filename().native());
        return names;
    }
    testing::TemporaryDirectory directory_;
    OtherMachine other_;
    PullConfig config_;
    std::atomic<bool> stop_{false};
};

TEST_F(Pulling, BringsWhatIsMissingAndAsksForNothingTwice) {
    const auto north = puller();
    const Status done = north->turn();
    ASSERT_TRUE(done) << done.error().message;
    for (const std::size_t number : {0U, 1U}) {
        EXPECT_FALSE(pulled(number).empty());
        EXPECT_TRUE(pulled(number) == other_.file(number));
    }
    EXPECT_EQ(north->status().pulled, 2U);
    EXPECT_EQ(north->status().newest, other_.name(1).time);
    EXPECT_EQ(north->pause(), config_.every);
    other_.server().forget_asked();
    ASSERT_TRUE(north->turn());
    // The second turn requests the short list, which has another URL. The third turn sends the tag
    // of the short list.
    ASSERT_TRUE(north->turn());
    const auto asked = other_.server().asked();
    ASSERT_EQ(asked.size(), 2U);
    EXPECT_EQ(asked[1].path, asked[0].path);
    EXPECT_EQ(asked[1].header("If-None-Match"), "\"of-the-list\"");
}

TEST_F(Pulling, AYoungGridThatWasMadeAgainComesAgain) {
    ASSERT_TRUE(puller()->turn());
    const std::string before = pulled(1);
    other_.server().forget_asked();
    const auto restarted = puller();
    ASSERT_TRUE(restarted->turn());
    EXPECT_EQ(restarted->status().pulled, 0U) << "the tags say that nothing is new";
    other_.make_again(1);
    ASSERT_TRUE(puller()->turn());
    EXPECT_FALSE(pulled(1) == before);
    EXPECT_TRUE(pulled(1) == other_.file(1));
}

// 2026-11-28: a turn (one list and the grids in it) fetched up to 1,000 young grids again without
// checking the limit of bytes. A machine that made its grids again, but larger, filled the disk.
TEST_F(Pulling, GridsThatWereMadeLargerEndATurn) {
    other_.add(std::chrono::minutes{5}, 2);
    ASSERT_TRUE(puller()->turn());
    ASSERT_EQ(files().size(), 3U);
    config_.bytes_a_source = 1;
    other_.server().forget_asked();
    ASSERT_TRUE(puller()->turn());
    const auto is_file = [](const Asked& asked) { return asked.path.ends_with("/file"); };
    EXPECT_EQ(std::ranges::count_if(other_.server().asked(), is_file), 1)
        << "only one of two young grids is fetched";
}

// 2026-11-28: at the limit of bytes, each turn fetched one new grid and replaced one grid, so the
// puller fell behind for good.
TEST_F(Pulling, AtItsLimitAllThatIsNewComesAndTheOldestGo) {
    reach_the_limit();
    ASSERT_TRUE(puller()->turn());
    for (const std::size_t number : {0U, 1U, 2U, 3U})
        EXPECT_EQ(pulled(number).empty(), number < 2) << number;
}

// 2026-11-28: at the limit, each turn fetched the same grid and removed it again.
TEST_F(Pulling, AtItsLimitNothingIsFetchedInVainAgain) {
    reach_the_limit();
    const auto north = puller();
    ASSERT_TRUE(north->turn());
    const auto first = north->status();
    for (int turn = 0; turn < 3; ++turn)
        ASSERT_TRUE(north->turn());
    EXPECT_EQ(north->status().removed, first.removed);
    EXPECT_EQ(north->status().pulled, first.pulled);
}

TEST_F(Pulling, WhatComesCutOrChangedIsRefusedAndComesLater) {
    const std::vector<std::function<Reply(Reply)>> faults = {
        [](Reply reply) { return reply.way = Reply::Way::cut, reply; },
        [](Reply reply) { return reply.body.resize(reply.body.size() - 4096), reply; },
        [](Reply reply) { return reply.body.back() ^= 1, reply; },
        [](Reply reply) { return reply.body.at(300) ^= 1, reply; },
        [](Reply reply) { return reply.headers = "ETag: \"0123456789abcdef\"\r\n", reply; },
        [](Reply reply) { return reply.headers.clear(), reply; },
        [](Reply reply) { return reply.body = "<html>", reply; },
        [](Reply reply) { return reply.body.clear(), reply; },
        // Returns a whole grid whose name is not the requested name.
        [&](Reply) {
            return Reply{200, other_.file(0), "ETag: \"x\"\r\n", Reply::Way::whole};
        },
    };
    for (std::size_t i = 0; i < faults.size(); ++i) {
        SCOPED_TRACE(i);
        other_.of_files = faults[i];
        const auto north = puller();
        const Status done = north->turn();
        EXPECT_TRUE(done) << done.error().message;
        EXPECT_EQ(north->status().refused, 2U);
        EXPECT_THAT(files(), ::testing::IsEmpty());
    }
    other_.of_files = [](Reply reply) { return reply; };
    const auto north = puller();
    ASSERT_TRUE(north->turn());
    EXPECT_EQ(files().size(), 2U);
}

TEST_F(Pulling, ABadGridWaitsAndHoldsUpNoOther) {
    other_.of_files = [&](Reply reply) {
        if (reply.body == other_.file(0)) reply.body.back() ^= 1;
        return reply;
    };
    const auto north = puller();
    ASSERT_TRUE(north->turn());
    ASSERT_TRUE(north->turn());
    EXPECT_EQ(north->status().pulled, 1U);
    EXPECT_EQ(north->status().refused, 1U) << "the grid is not requested again at once";
    EXPECT_TRUE(pulled(1) == other_.file(1));
}

// 2026-11-28: a machine listed 10,000 new names each turn and answered each request with junk. In
// half a minute this made 165,000 directories and as many log lines, and the names stayed in memory
// for hours.
TEST_F(Pulling, AMachineOfJunkIsLeftAloneAndLeavesNothing) {
    int turn = 0;
    other_.of_lists = [&](Reply reply) {
        std::string text;
        for (int i = 0; i < 2000; ++i)
            text += fmt::format(
                "{}{{\"domain\":\"us.K{}{}{}\",\"moment\":\"REF\",\"time\":\"{}\"}}",
                text.empty() ? "" : ",", char('A' + turn), char('A' + i / 26 % 26),
                char('A' + i % 26), format_utc(now_utc() - std::chrono::seconds{60 + i / 676}));
        return reply.body = "{\"grids\":[" + text + "]}", reply.status = 200,
               reply.headers = fmt::format("ETag: \"{}\"\r\n", turn++), reply;
    };
    other_.of_missing = [](Reply) {
        return Reply{200, std::string(200, 'j'), "ETag: \"j\"\r\n", Reply::Way::whole};
    };
    const auto north = puller();
    ::testing::internal::CaptureStderr();
    for (int i = 0; i < 3; ++i) {
        const Status done = north->turn();
        ASSERT_FALSE(done);
        EXPECT_THAT(done.error().message, HasSubstr("16 grids in a row were refused"));
    }
    const std::string log = ::testing::internal::GetCapturedStderr();
    EXPECT_EQ(std::ranges::count(log, '\n'), 20) << "the limit of lines in a minute";
    EXPECT_EQ(north->status().refused, 48U);
    EXPECT_EQ(north->remembered(), 16U) << "grids that are no longer listed are forgotten";
    EXPECT_EQ(north->pause(), std::chrono::milliseconds{4000});
    EXPECT_TRUE(fs::is_empty(this->north())) << "directories are made only for kept grids";
}

TEST_F(Pulling, StationsThatAreNotItsAreNotPulled) {
    auto grids = PulledGrids::open(real_file_system(), north(), {1'000'000, config_.age});
    ASSERT_TRUE(grids);
    SourcePuller north({"north", other_.url(), {"us"}, {"KENX"}}, config_, std::move(*grids),
                       stop_);
    ASSERT_TRUE(north.turn());
    EXPECT_EQ(north.status().pulled, 0U);
}

TEST_F(Pulling, AMachineThatIsBusyIsLeftAloneForLongerAndLonger) {
    other_.of_files = [](Reply) { return Reply{503, "later"}; };
    const auto north = puller();
    const Status done = north->turn();
    ASSERT_FALSE(done);
    EXPECT_THAT(done.error().message, HasSubstr("the server answered 503"));
    EXPECT_EQ(north->pause(), std::chrono::seconds{1});
    EXPECT_FALSE(north->turn());
    EXPECT_EQ(north->pause(), std::chrono::seconds{2});
    EXPECT_EQ(north->status().failures, 2U);
    EXPECT_THAT(north->status().error, HasSubstr("503"));
    EXPECT_EQ(pause_after(100), std::chrono::seconds{60});

    other_.of_lists = [](Reply) {
        return Reply{503, "later", "Retry-After: 17\r\n", Reply::Way::whole};
    };
    EXPECT_FALSE(north->turn());
    EXPECT_EQ(north->pause(), std::chrono::seconds{17});
    other_.of_lists = other_.of_files = [](Reply reply) { return reply; };
    ASSERT_TRUE(north->turn());
    EXPECT_EQ(north->pause(), config_.every);
    EXPECT_EQ(north->status().error, "");
    EXPECT_EQ(files().size(), 2U);
}

TEST_F(Pulling, AMachineThatHangsIsGivenUpAndATransferEndsWhenItMust) {
    other_.of_files = [](Reply reply) { return reply.way = Reply::Way::hangs, reply; };
    const auto north = puller();
    EXPECT_FALSE(north->turn());
    EXPECT_NE(north->status().error, "");
    EXPECT_THAT(files(), ::testing::IsEmpty());

    config_.stall = std::chrono::hours{1};  // so that only stop_ ends the transfer
    other_.server().forget_asked();
    const auto patient = puller();
    std::thread stopper([&] {
        EXPECT_TRUE(testing::eventually([&] {
            return std::ranges::any_of(other_.server().asked(), [](const Asked& asked) {
                return asked.path.ends_with("/file");
            });
        }));
        stop_ = true;
    });
    EXPECT_TRUE(patient->turn());
    stopper.join();
    EXPECT_THAT(files(), ::testing::IsEmpty());
}

TEST_F(Pulling, NobodyElseIsAsked) {
    ScriptedServer elsewhere([](const Asked&) { return Reply{}; });
    other_.of_files = other_.of_lists = [&](Reply) {
        return Reply{302, "", "Location: " + elsewhere.url() + "/x\r\n", Reply::Way::whole};
    };
    const Status done = puller()->turn();
    ASSERT_FALSE(done);
    EXPECT_THAT(done.error().message, HasSubstr("the server answered 302"));
    EXPECT_TRUE(elsewhere.asked().empty());
}

TEST_F(Pulling, AnAnswerWithoutEndEnds) {
    other_.of_lists = [](Reply reply) { return reply.way = Reply::Way::endless, reply; };
    const Status done = puller()->turn();
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::over_budget);
}

TEST_F(Pulling, TheOldestGiveWay) {
    ASSERT_TRUE(puller()->turn());
    ASSERT_EQ(files().size(), 2U);
    config_.age = std::chrono::minutes{20};
    const auto strict = puller();
    ASSERT_TRUE(strict->turn());
    EXPECT_EQ(strict->status().removed, 1U);
    EXPECT_EQ(pulled(0), "");
    EXPECT_FALSE(pulled(1).empty());
    auto few = PulledGrids::open(real_file_system(), north(),
                                 {config_.bytes_a_source, std::chrono::hours{1}, 0});
    ASSERT_TRUE(few);
    EXPECT_EQ(few->prune(now_utc()), 1U) << "the limit of the number of grids";
    ASSERT_TRUE(puller()->turn());
    config_.bytes_a_source = 100;
    auto grids = PulledGrids::open(real_file_system(), north(), {100, std::chrono::hours{1}});
    ASSERT_TRUE(grids);
    EXPECT_EQ(grids->prune(now_utc()), 1U);
    EXPECT_EQ(grids->bytes(), 0U);
    EXPECT_TRUE(fs::is_empty(north())) << "directories without grids are removed, too";
}

// 2026-11-28: after memory had run out once, the client never made another request.
TEST(HttpClient, GoesOnWhereMemoryWasShort) {
    const ScriptedServer server([](const Asked&) {
        Reply reply;
        reply.body = "a body";
        return reply;
    });
    const std::atomic<bool> stop = false;
    HttpClient client({.stop = &stop, .beat = {}});
    const auto none =
        client.get({server.url(), {}, 100, [](auto) -> Status { throw std::bad_alloc(); }});
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::exhausted);
    const auto again = client.get({server.url(), {}, 100, [](auto) { return Status{}; }});
    EXPECT_TRUE(again) << again.error().message;
}

TEST_F(Pulling, WhatAKilledProgramLeftIsRemoved) {
    ASSERT_TRUE(puller()->turn());
    const fs::path day = (north() / cache::relative_path(other_.name(0))).parent_path();
    std::ofstream(day / ".stormcellar-tmp-other-1-1") << "half of a grid";
    const auto north = puller();
    EXPECT_EQ(files().size(), 2U);
}

}  // namespace
}  // namespace stormcellar::pull
