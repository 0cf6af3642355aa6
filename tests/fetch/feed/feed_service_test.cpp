// Follows a bucket over HTTP. Chunks must arrive whole, and faults of the bucket must do no harm.
#include "fetch/feed/feed_service.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/fetch/feed/running_feed.h"
#include "tests/testing/power_cut_file_system.h"
#include "tests/testing/waiting.h"

namespace stormcellar::feed {
namespace {

using std::chrono::minutes;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Reply;

UtcTime on_a_second(UtcTime time) {
    return std::chrono::floor<std::chrono::seconds>(time);
}
const UtcTime recent = on_a_second(now_utc() - minutes{6});

class FeedingFrom : public ::testing::Test {
  protected:
    void put_two_volumes() {
        bucket_.put_volume("KTLX", 493, recent - minutes{5}, 6);
        bucket_.put_volume("KTLX", 494, recent, 6);
    }
    static std::string key(int number, char kind = 'I') {
        return key_of("KTLX", 494, recent, number, kind);
    }
    ChunkBucket bucket_;
    RunningFeed feed_{bucket_};
};

TEST_F(FeedingFrom, EverythingArrivesWithItsNames) {
    put_two_volumes();
    feed_.start();
    ASSERT_TRUE(feed_.wait_for_files(12));
    bucket_.put_volume("KTLX", 495, recent + minutes{5}, 3, false);
    ASSERT_TRUE(feed_.wait_for_files(15));
    EXPECT_EQ(feed_.files(), bucket_.objects());
    EXPECT_EQ(feed_.station().written, 15U);
    EXPECT_EQ(feed_.station().refused, 0U);
    EXPECT_EQ(bucket_.count("GET "), 15U) << "each chunk is fetched once";
}

TEST_F(FeedingFrom, ListingsOfManyPagesAreRead) {
    bucket_.set_page(50);
    bucket_.put_volume("KTLX", 494, recent, 180);
    bucket_.put_volume("KTLX", 494, recent - std::chrono::hours{90}, 10);  // an older volume
    feed_.start();
    ASSERT_TRUE(feed_.wait_for_files(180));
    EXPECT_EQ(bucket_.count("GET "), 180U);
}

TEST_F(FeedingFrom, AfterARestartNothingIsLostAndNothingFetchedAgain) {
    bucket_.put_volume("KTLX", 493, recent - minutes{5}, 6);
    bucket_.put_volume("KTLX", 494, recent, 4, false);
    feed_.start();
    ASSERT_TRUE(feed_.wait_for_files(10));
    feed_.stop();
    std::filesystem::remove(feed_.config.drop / key(2));  // as after a kill between two chunks
    std::ofstream(feed_.config.drop / key(3)) << "cut";   // as after a power cut
    bucket_.put_volume("KTLX", 494, recent, 6);
    feed_.start();
    ASSERT_TRUE(testing::eventually([&] { return feed_.files() == bucket_.objects(); }));
    EXPECT_EQ(bucket_.count("GET "), 14U);
    EXPECT_EQ(bucket_.count("LIST KTLX/494/2"), 0U);
    ASSERT_TRUE(testing::eventually([&] { return feed_.station().present >= 2; }));
}

TEST_F(FeedingFrom, AServerThatIsBusyIsAskedLater) {
    put_two_volumes();
    std::atomic<int> refusals{2};
    bucket_.change = [&](const std::string& asked, Reply reply) {
        const bool is_refused = asked.starts_with("GET") && refusals-- > 0;
        return is_refused ? Reply{503, "slow down", "", Reply::Way::whole} : reply;
    };
    feed_.start();
    ASSERT_TRUE(feed_.wait_for_files(12));
    EXPECT_EQ(feed_.station().failures, 2U);
    EXPECT_EQ(feed_.station().refused, 0U);
}

TEST_F(FeedingFrom, ABucketThatForbidsOrIsGoneIsNamed) {
    std::atomic<int> status{403};
    bucket_.change = [&](const std::string&, Reply reply) {
        return status ? Reply{status, "no", "", Reply::Way::whole} : reply;
    };
    put_two_volumes();
    feed_.start();
    ASSERT_TRUE(testing::eventually([&] { return feed_.station().failures > 0; }));
    EXPECT_THAT(feed_.station().error, HasSubstr("the server answered 403"));
    EXPECT_TRUE(feed_.station().next_try);
    status = 404;
    ASSERT_TRUE(testing::eventually(
        [&] { return feed_.station().error.find("404") != std::string::npos; }));
    status = 0;
    ASSERT_TRUE(feed_.wait_for_files(12));
    EXPECT_EQ(feed_.station().error, "");
}

// Each of these faults affects every request for chunk 3 of the newest volume; the other chunks
// must arrive.
TEST_F(FeedingFrom, AChunkThatIsNoGoodIsGivenUpAndHoldsUpNoOther) {
    put_two_volumes();
    const Reply faults[] = {{403, "no", "", Reply::Way::whole},
                            {404, "no", "", Reply::Way::whole},
                            {200, "short", "", Reply::Way::whole},
                            {200, std::string(1'000'000, 'x'), "", Reply::Way::whole},
                            {200, "x", "", Reply::Way::endless},
                            {302, "", "Location: /KTLX/494/x\r\n", Reply::Way::whole}};
    for (const Reply& fault : faults) {
        ChunkBucket bucket;
        bucket.change = [&](const std::string& asked, Reply reply) {
            return asked == "GET " + key(3) ? fault : reply;
        };
        bucket.put_volume("KTLX", 494, recent, 6);
        RunningFeed feed(bucket);
        feed.start();
        ASSERT_TRUE(feed.wait_for_files(5)) << fault.status;
        auto expected = bucket.objects();
        expected.erase(key(3));
        EXPECT_EQ(feed.files(), expected) << fault.status;
        EXPECT_EQ(feed.station().refused, 1U);
        EXPECT_EQ(bucket.count("GET " + key(3)), 3U);
    }
}

TEST_F(FeedingFrom, AChunkThatIsCutOrHangsComesAtTheNextTry) {
    for (const Reply::Way way : {Reply::Way::cut, Reply::Way::hangs}) {
        ChunkBucket bucket;
        std::atomic<int> faults{1};
        bucket.change = [&](const std::string& asked, Reply reply) {
            if (asked == "GET " + key(3) && faults-- > 0) reply.way = way;
            return reply;
        };
        bucket.put_volume("KTLX", 494, recent, 6);
        RunningFeed feed(bucket);
        feed.start();
        ASSERT_TRUE(feed.wait_for_files(6));
        EXPECT_EQ(feed.files(), bucket.objects());
    }
}

TEST_F(FeedingFrom, SizesThatNoChunkHasAreNotAskedFor) {
    put_two_volumes();
    bucket_.say_size(key(2), 0);
    bucket_.say_size(key(3), std::uint64_t{1} << 40);
    feed_.start();
    ASSERT_TRUE(feed_.wait_for_files(10));
    ASSERT_TRUE(testing::eventually([&] { return feed_.station().refused == 2; }));
    EXPECT_EQ(bucket_.count("GET " + key(2)) + bucket_.count("GET " + key(3)), 0U);
}

// The server gives one of these answers instead of a listing, and a good listing at the next
// attempt.
TEST_F(FeedingFrom, ListingsThatAreNoneAreAskedForAgain) {
    std::string many;
    for (int i = 0; i < 1100; ++i)
        many += "<Contents><Key>KTLX/494/x</Key><Size>1</Size></Contents>";
    const Reply faults[] = {
        {200, "<html>not now</html>", "", Reply::Way::whole},
        {200,
         "<ListBucketResult><Contents><Key>KTLX/1/x</Key><Size>-1</Size></Contents>"
         "</ListBucketResult>",
         "", Reply::Way::whole},
        {200, std::string("\0\xff<>&", 5), "", Reply::Way::whole},
        {200, "", "", Reply::Way::whole},
        {200, "<ListBucketResult>", "", Reply::Way::endless},
        {200, "<ListBucketResult>" + many + "</ListBucketResult>", "", Reply::Way::whole},
        {200, "<ListBucketResult><IsTruncated>true</IsTruncated></ListBucketResult>", "",
         Reply::Way::whole},
        {200,
         "<ListBucketResult><IsTruncated>true</IsTruncated><NextContinuationToken>more"
         "</NextContinuationToken></ListBucketResult>",
         "", Reply::Way::whole},
        {200, "<ListBucketResult></ListBucketResult>", "", Reply::Way::cut}};
    for (const Reply& fault : faults) {
        ChunkBucket bucket;
        std::atomic<int> listings{0};
        bucket.change = [&](const std::string& asked, Reply reply) {
            // The listing of endless pages answers four requests; every other fault answers one
            // request.
            return asked.starts_with("LIST") &&
                           ++listings <=
                               1 + 3 * (fault.body.find("more") != std::string::npos ? 1 : 0)
                       ? fault
                       : reply;
        };
        bucket.put_volume("KTLX", 494, recent, 6);
        RunningFeed feed(bucket);
        feed.start();
        ASSERT_TRUE(feed.wait_for_files(6)) << fault.body.substr(0, 80);
        EXPECT_EQ(feed.files(), bucket.objects());
        EXPECT_EQ(feed.station().failures, 1U) << fault.body.substr(0, 80);
    }
}

TEST_F(FeedingFrom, KeysThatLeadOutLeadNowhere) {
    put_two_volumes();
    bucket_.put("KTLX/494/../../../../escaped", "evil");
    bucket_.put("KTLX/494/..%2f..%2fescaped", "evil");
    bucket_.put("KTLX/../494/20261128-120000-001-S", "evil");
    feed_.start();
    ASSERT_TRUE(feed_.wait_for_files(12));
    for (const auto& [name, contents] : files_below(feed_.config.drop.parent_path()))
        EXPECT_NE(contents, "evil") << name;
    EXPECT_EQ(bucket_.count("GET "), 12U);
}

TEST_F(FeedingFrom, OneStationThatFailsHoldsUpNoOther) {
    bucket_.change = [&](const std::string& asked, Reply reply) {
        if (asked.find("KFDR") != std::string::npos) reply.way = Reply::Way::hangs;
        return reply;
    };
    bucket_.put_volume("KTLX", 494, recent, 6);
    bucket_.put_volume("KFDR", 7, recent, 6);
    feed_.config.stations = {"KFDR", "KTLX", "KVNX"};
    feed_.start();
    ASSERT_TRUE(feed_.wait_for_files(6));
    ASSERT_TRUE(testing::eventually([&] { return feed_.station(0).failures > 0; }));
    EXPECT_THAT(feed_.station(0).error, HasSubstr("too slow"));
    EXPECT_TRUE(feed_.station(2).is_searching) << "the bucket has nothing of KVNX";
}

TEST_F(FeedingFrom, AStationThatFallsSilentIsNamedUntilItSendsAgain) {
    feed_.config.silent_after = std::chrono::milliseconds{500};
    feed_.config.stations = {"KTLX", "KVNX"};
    put_two_volumes();
    feed_.start();
    ASSERT_TRUE(feed_.wait_for_files(12));
    ASSERT_TRUE(testing::eventually(
        [&] { return feed_.station(0).is_silent && feed_.station(1).is_silent; }));
    EXPECT_EQ(feed_.station(0).error, "") << "silence is not a failure";
    bucket_.put_volume("KTLX", 495, recent + minutes{30}, 3, false);
    ASSERT_TRUE(feed_.wait_for_files(15));
    ASSERT_TRUE(testing::eventually([&] { return !feed_.station(0).is_silent; }));
    EXPECT_TRUE(feed_.station(1).is_silent) << "the bucket has nothing of this station";
}

// 2026-11-28: after an outage at the start, the feed took the first answer of a search as a sign
// that the bucket has no volume of the station.
TEST_F(FeedingFrom, AnOutageIsNoSilenceOfAStation) {
    feed_.config.silent_after = std::chrono::seconds{3};
    std::atomic<bool> is_down{true};
    bucket_.change = [&](const std::string&, Reply reply) {
        return is_down ? Reply{503, "down", "", Reply::Way::whole} : reply;
    };
    feed_.start();
    const SteadyTime until = steady_now() + feed_.config.silent_after;
    ASSERT_TRUE(testing::eventually([&] { return steady_now() > until; }));
    is_down = false;
    ASSERT_TRUE(testing::eventually([&] { return feed_.station().error.empty(); }));
    EXPECT_FALSE(feed_.station().is_silent);
}

// 2026-11-28: the feed checked the bytes only every 20 s, and a bucket that kept listing new
// volumes brought three times as many bytes as the limit allows.
TEST_F(FeedingFrom, TheLimitOfBytesHoldsBetweenTwoLooksAtAges) {
    feed_.config.bytes = 8 * 16'384;
    feed_.config.between_prunes = std::chrono::hours{1};
    feed_.start();
    ASSERT_TRUE(testing::eventually([&] { return feed_.station().listings > 0; }));
    put_two_volumes();
    EXPECT_TRUE(testing::eventually(
        [&] { return feed_.station().written == 12 && feed_.files().size() <= 6; }));
}

TEST_F(FeedingFrom, AFullDiskIsNamedAndLosesNothing) {
    testing::PowerCutFileSystem disk;
    disk.set_space(100);
    put_two_volumes();
    feed_.start(disk);
    ASSERT_TRUE(testing::eventually([&] { return feed_.station().failures > 0; }));
    EXPECT_THAT(feed_.station().error, HasSubstr("space"));
    // 2026-11-28: each listing logged that the bucket answers again, although the disk was still
    // full.
    ::testing::internal::CaptureStderr();
    ASSERT_TRUE(testing::eventually([&] { return feed_.station().failures > 2; }));
    EXPECT_THAT(::testing::internal::GetCapturedStderr(), Not(HasSubstr("again")));
    feed_.stop();
    feed_.start();
    ASSERT_TRUE(feed_.wait_for_files(12));
    EXPECT_EQ(feed_.files(), bucket_.objects());
}

TEST_F(FeedingFrom, AfterALongOutageTheNewestComesFirst) {
    bucket_.put_volume("KTLX", 400, recent - minutes{480}, 3);
    feed_.start();
    ASSERT_TRUE(feed_.wait_for_files(3));
    feed_.stop();
    for (int i = 401; i <= 494; ++i)
        bucket_.put_volume("KTLX", i, recent - minutes{5 * (494 - i)}, 3);
    feed_.start();
    ASSERT_TRUE(feed_.wait_for_files(9));
    EXPECT_EQ(bucket_.count("GET KTLX/493/"), 3U);
    EXPECT_EQ(bucket_.count("GET KTLX/494/"), 3U);
    EXPECT_EQ(bucket_.count("GET "), 9U);
}

TEST_F(FeedingFrom, TheStatusSaysHowEachStationFares) {
    put_two_volumes();
    feed_.start();
    ASSERT_TRUE(feed_.wait_for_files(12));
    feed_.stop();
    auto service = FeedService::open(real_file_system(), feed_.config);
    ASSERT_TRUE(service);
    ASSERT_TRUE((*service)->publish());
    std::ifstream file(feed_.config.state / "status.json");
    const auto status = nlohmann::json::parse(file);
    EXPECT_EQ(status["bucket"], bucket_.url());
    EXPECT_EQ(status["volumes"], 2);
    EXPECT_EQ(status["stations"][0]["station"], "KTLX");
    EXPECT_EQ(status["stations"][0]["state"], "starting");
    EXPECT_EQ(status["stations"][0]["volume"], 494);
    EXPECT_EQ(status["stations"][0]["volume_time"], format_utc(recent));
}

}  // namespace
}  // namespace stormcellar::feed
