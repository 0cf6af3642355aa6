// Runs `stormcellar fetch` as a user does, with a bucket on loopback.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_stormcellar.h"
#include "tests/fetch/mock_bucket.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

using ::testing::HasSubstr;
using testing::ProgramResult;
using Fault = fetch::MockBucket::Fault;

class FetchCommand : public ::testing::Test {
  protected:
    FetchCommand() {
        bucket_.put("2017/01/01/KTLX/KTLX20170101_030027_V06", std::string(5000, 'a'));
        bucket_.put("2017/01/01/KTLX/KTLX20170101_030627_V06", std::string(6000, 'b'));
        bucket_.put("2017/01/01/KFDR/KFDR20170101_030127_V06", std::string(7000, 'c'));
    }
    ProgramResult fetch(Words more) {
        more.insert(more.begin(),
                    {"fetch", "--from", "2017-01-01T03:00", "--to", "2017-01-01T03:30", "--source",
                     bucket_.address(), "-o", (directory_ / "files").string()});
        return run(more);
    }
    fetch::MockBucket bucket_;
    testing::TemporaryDirectory directory_;
};

TEST_F(FetchCommand, BringsStationsByNameAndByBounds) {
    EXPECT_EQ(json_of(fetch({"--stations", "KTLX", "--json"}))["fetched"], 2);
    EXPECT_TRUE(fs::exists(directory_ / "files/KTLX20170101_030627_V06"));
    const ProgramResult within = fetch({"--bounds=-100,34,-97,36"});
    ASSERT_EQ(within.status, 0) << within.err;
    EXPECT_THAT(within.err, HasSubstr("2 were there already"));
    EXPECT_TRUE(fs::exists(directory_ / "files/KFDR20170101_030127_V06"));
}

TEST_F(FetchCommand, SaysWhatFailedAndWhatWasNotThere) {
    bucket_.fail_next("2017/01/01/KTLX/KTLX20170101_030027_V06", {Fault::missing});
    const ProgramResult some = fetch({"--stations", "KTLX"});
    EXPECT_EQ(some.status, 1);
    EXPECT_THAT(some.err, HasSubstr("KTLX20170101_030027_V06: the server answered 404"));
    EXPECT_THAT(some.err, HasSubstr("the same command tries them again"));
    EXPECT_EQ(fetch({"--stations", "KABR"}).status, 3);
}

TEST_F(FetchCommand, WhatMakesNoSenseIsBadUsage) {
    EXPECT_EQ(fetch({}).status, 2);
    EXPECT_EQ(fetch({"--stations", "KTLX", "--bounds=-100,34,-97,36"}).status, 2);
    EXPECT_EQ(fetch({"--stations", "KT"}).status, 2);
    EXPECT_EQ(fetch({"--bounds=0,0,1,1"}).status, 2) << "no station is within these bounds";
    EXPECT_EQ(run({"fetch", "--stations", "KTLX", "-o", "/tmp/x"}).status, 2)
        << "the times are missing";
}

}  // namespace
}  // namespace stormcellar::cli
