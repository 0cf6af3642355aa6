#include "stormcellar/fetch/fetch.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "fetch/bucket/bucket_listing.h"
#include "tests/fetch/mock_bucket.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/text_bytes.h"

namespace stormcellar::fetch {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;
using Fault = MockBucket::Fault;

UtcTime at(const std::string& text) {
    return parse_utc(text, {}).value();
}

TEST(BucketListing, AddressesAreThoseOfTheBucket) {
    EXPECT_EQ(listing_url("https://bucket/", "2017/01/01/KTLX/", "a+b/c="),
              "https://bucket/?list-type=2&prefix=2017%2F01%2F01%2FKTLX%2F&continuation-token="
              "a%2Bb%2Fc%3D");
    EXPECT_EQ(object_url("http://host/bucket", "2017/01/01/KTLX/a b"),
              "http://host/bucket/2017/01/01/KTLX/a%20b");
    EXPECT_EQ(prefixes_of({"KFDR", "KTLX"}, at("2016-12-31T23:00Z"), at("2017-01-01T01:00Z")),
              (std::vector<std::string>{"2016/12/31/KFDR/", "2016/12/31/KTLX/", "2017/01/01/KFDR/",
                                        "2017/01/01/KTLX/"}));
    EXPECT_EQ(start_in_name("KTLX20170101_030027_V06"), at("2017-01-01T03:00:27Z"));
    EXPECT_FALSE(start_in_name("index.html"));
}

TEST(BucketListing, WhatIsNoneIsRefused) {
    for (const char* text :
         {"", "nothing", "<html/>", "<ListBucketResult><Contents><Key>a</Key></Contents>",
          "<ListBucketResult><Contents><Key>a</Key><Size>-1</Size></Contents></ListBucketResult>",
          "<ListBucketResult><IsTruncated>true</IsTruncated></ListBucketResult>"}) {
        EXPECT_FALSE(parse_listing(testing::text_bytes(text))) << text;
    }
}

class FetchTest : public ::testing::Test {
  protected:
    FetchTest() {
        for (int i = 0; i < 25; ++i) {
            const std::string name =
                fmt::format("KTLX20170101_{:02}{:02}27_V06", i / 6, i % 6 * 10);
            contents_[name] =
                std::string(1000 + 777 * static_cast<std::size_t>(i), static_cast<char>('a' + i));
            bucket_.put("2017/01/01/KTLX/" + name, contents_[name]);
        }
        bucket_.put("2017/01/01/KTLX/KTLX20170101_000027_V06_MDM", "metadata");
        bucket_.put("2017/01/01/KTLX/index.html", "nothing of ours");
        request_.source = bucket_.address();
        request_.stations = {"KTLX"};
        request_.from = at("2017-01-01T00:00Z");
        request_.to = at("2017-01-01T23:59Z");
        request_.directory = directory_ / "files";
        request_.first_wait = std::chrono::milliseconds{1};
        request_.stall = std::chrono::seconds{1};
    }
    [[nodiscard]] static std::string key(const std::string& name) {
        return "2017/01/01/KTLX/" + name;
    }
    [[nodiscard]] std::string read(const std::string& name) const {
        std::ifstream file(request_.directory / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    void expect_all_there() const {
        std::size_t count = 0;
        for (const auto& entry : fs::directory_iterator(request_.directory)) {
            ++count;
            const auto wanted = contents_.find(entry.path().filename());
            ASSERT_NE(wanted, contents_.end()) << entry.path();
            EXPECT_TRUE(read(wanted->first) == wanted->second) << wanted->first;
        }
        EXPECT_EQ(count, contents_.size());
    }

    MockBucket bucket_;
    testing::TemporaryDirectory directory_;
    std::map<std::string, std::string> contents_;
    FetchRequest request_;
    const std::string first_ = "KTLX20170101_000027_V06";
};

TEST_F(FetchTest, BringsAllOfTheStationAndTimesWithTheirTimes) {
    bucket_.set_page(10);
    const auto report = fetch(request_);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->found, 25U);
    EXPECT_EQ(report->fetched, 25U);
    EXPECT_EQ(report->without_radials, 1U);
    EXPECT_THAT(report->failures, IsEmpty());
    EXPECT_EQ(bucket_.asked("2017/01/01/KTLX/"), 3U) << "the list has three pages";
    EXPECT_EQ(bucket_.asked(key(first_ + "_MDM")), 0U);
    expect_all_there();
    struct stat facts {};
    ASSERT_EQ(::stat((request_.directory / first_).c_str(), &facts), 0);
    EXPECT_EQ(facts.st_mtim.tv_sec, at("2017-01-01T03:07:30Z").time_since_epoch().count() / 1000);
}

TEST_F(FetchTest, TakesNoMoreThanTheTimesAskedForAndTransfersAllowed) {
    request_.from = at("2017-01-01T01:00Z");
    request_.to = at("2017-01-01T01:59Z");
    request_.parallel = 2;
    const auto report = fetch(request_);
    ASSERT_TRUE(report);
    EXPECT_EQ(report->found, 6U);
    EXPECT_LE(bucket_.most_at_once(), 2U);
}

TEST_F(FetchTest, WhatIsThereIsNotFetchedAgain) {
    ASSERT_TRUE(fetch(request_));
    const auto again = fetch(request_);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->present, 25U);
    EXPECT_EQ(again->fetched, 0U);
    EXPECT_EQ(bucket_.asked(key(first_)), 1U);
}

TEST_F(FetchTest, WhatGoesWrongIsTriedAgain) {
    bucket_.fail_next("2017/01/01/KTLX/", {Fault::unavailable, Fault::no_xml});
    bucket_.fail_next(key(first_), {Fault::unavailable, Fault::cut, Fault::longer, Fault::shorter});
    const auto report = fetch(request_);
    ASSERT_TRUE(report);
    EXPECT_THAT(report->failures, IsEmpty());
    EXPECT_EQ(report->fetched, 25U);
    expect_all_there();
}

TEST_F(FetchTest, ACutFileGoesOnWhereItEnded) {
    request_.tries = 1;
    bucket_.fail_next(key(first_), {Fault::cut});
    const auto report = fetch(request_);
    ASSERT_TRUE(report);
    ASSERT_EQ(report->failures.size(), 1U);
    EXPECT_EQ(report->failures[0].what, key(first_));
    EXPECT_FALSE(fs::exists(request_.directory / first_))
        << "an incomplete file must not have its final name";
    const auto again = fetch(request_);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->fetched, 1U);
    EXPECT_EQ(bucket_.last_from(key(first_)), 500U);
    expect_all_there();
}

// 2026-11-25: if a file had changed during a download, the rest of the new file was appended to the
// beginning of the old file.
TEST_F(FetchTest, APartOfOtherContentsIsNotGoneOnWith) {
    request_.tries = 1;
    bucket_.fail_next(key(first_), {Fault::cut});
    ASSERT_TRUE(fetch(request_));
    contents_[first_] = std::string(contents_[first_].size(), 'Z');
    bucket_.put(key(first_), contents_[first_]);
    ASSERT_TRUE(fetch(request_));
    EXPECT_EQ(bucket_.last_from(key(first_)), 0U);
    EXPECT_TRUE(read(first_) == contents_[first_]);
}

TEST_F(FetchTest, APartThatTheServerDoesNotGoOnWithIsFetchedAnew) {
    for (const Fault fault : {Fault::changed, Fault::other_part}) {
        fs::remove(request_.directory / first_);
        bucket_.fail_next(key(first_), {Fault::cut, fault});
        const auto report = fetch(request_);
        ASSERT_TRUE(report);
        EXPECT_THAT(report->failures, IsEmpty());
        EXPECT_EQ(bucket_.last_from(key(first_)), 0U);
        EXPECT_TRUE(read(first_) == contents_[first_]);
    }
}

TEST_F(FetchTest, AnErrorWithoutAnEndEnds) {
    bucket_.fail_next(key(first_), {Fault::endless_error});
    const auto report = fetch(request_);
    ASSERT_TRUE(report);
    ASSERT_EQ(report->failures.size(), 1U);
    EXPECT_THAT(report->failures[0].reason, HasSubstr("403"));
}

TEST_F(FetchTest, ATransferThatStandsStillIsGivenUpAndTriedAgain) {
    bucket_.fail_next(key(first_), {Fault::stalled});
    const auto report = fetch(request_);
    ASSERT_TRUE(report);
    EXPECT_THAT(report->failures, IsEmpty());
    expect_all_there();
}

TEST_F(FetchTest, WhatFailsForGoodIsNamedAndStopsNothingElse) {
    request_.tries = 2;
    bucket_.fail_next(key(first_), {Fault::missing, Fault::missing});
    const auto report = fetch(request_);
    ASSERT_TRUE(report);
    ASSERT_EQ(report->failures.size(), 1U);
    EXPECT_THAT(report->failures[0].reason, HasSubstr("404"));
    EXPECT_EQ(report->fetched, 24U);
    EXPECT_EQ(bucket_.asked(key(first_)), 1U) << "another try would fail, too";
}

TEST_F(FetchTest, StopsWhenItIsTold) {
    std::atomic<bool> stop{false};
    request_.stop = &stop;
    request_.parallel = 1;
    request_.progress = [&](const FetchProgress& now) { stop = now.done >= 3; };
    const auto report = fetch(request_);
    ASSERT_TRUE(report);
    EXPECT_TRUE(report->stopped);
    EXPECT_LT(report->fetched, 25U);
    request_.stop = nullptr;
    request_.progress = {};
    ASSERT_TRUE(fetch(request_));
    expect_all_there();
}

TEST_F(FetchTest, WhatMakesNoSenseIsRefused) {
    request_.source = "file:///etc";
    EXPECT_EQ(fetch(request_).error().code, ErrorCode::bad_argument);
    request_.source = "http://127.0.0.1:1";
    request_.tries = 2;
    const auto nobody = fetch(request_);
    ASSERT_TRUE(nobody);
    EXPECT_EQ(nobody->failures.size(), 1U);
}

}  // namespace
}  // namespace stormcellar::fetch
