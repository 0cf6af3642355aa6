#include "daemon/status/rejected_paths.h"

#include <gtest/gtest.h>

#include "tests/daemon/fake_sink.h"

namespace stormcellar::daemon {
namespace {

using pipeline::IngestResult;

pipeline::IngestOutcome rejected(const std::string& reason, ErrorCode code = ErrorCode::corrupt) {
    pipeline::IngestOutcome outcome = outcome_of(IngestResult::rejected);
    outcome.reason = reason;
    outcome.ending = pipeline::ended::Rejected{code};
    return outcome;
}

TEST(RejectedPaths, APathIsNewsOnceForAReason) {
    RejectedPaths paths;
    EXPECT_TRUE(paths.is_news("/d/a", rejected("not a Level II file")));
    EXPECT_FALSE(paths.is_news("/d/a", rejected("not a Level II file")));
    EXPECT_TRUE(paths.is_news("/d/b", rejected("not a Level II file")))
        << "the path is of another file";
    EXPECT_TRUE(paths.is_news("/d/a", rejected("record 3 is damaged")))
        << "the reason has another text";
    EXPECT_FALSE(paths.is_news("/d/a", rejected("record 17 is damaged")))
        << "only a number in the text differs";
    EXPECT_TRUE(paths.is_news("/d/a", rejected("record 17 is damaged", ErrorCode::truncated)));
    EXPECT_EQ(paths.count(), 2U);
}

TEST(RejectedPaths, WhatWasGriddedOrWentIsNewsAgain) {
    for (const IngestResult result : {IngestResult::gridded, IngestResult::vanished}) {
        RejectedPaths paths;
        EXPECT_TRUE(paths.is_news("/d/a", rejected("bad")));
        EXPECT_TRUE(paths.is_news("/d/a", outcome_of(result))) << "this outcome is always news";
        EXPECT_TRUE(paths.is_news("/d/a", rejected("bad")));
    }
    RejectedPaths paths;
    EXPECT_TRUE(paths.is_news("/d/a", rejected("bad")));
    EXPECT_TRUE(paths.is_news("/d/a", outcome_of(IngestResult::incomplete)));
    EXPECT_FALSE(paths.is_news("/d/a", rejected("bad")));
}

TEST(RejectedPaths, RemembersNoMoreThanItMay) {
    RejectedPaths paths(100);
    for (int i = 0; i < 1000; ++i)
        EXPECT_TRUE(paths.is_news("/d/" + std::to_string(i), rejected("bad")));
    EXPECT_EQ(paths.count(), 100U);
    EXPECT_FALSE(paths.is_news("/d/999", rejected("bad")));
    EXPECT_TRUE(paths.is_news("/d/0", rejected("bad"))) << "the oldest path was forgotten";
    for (int i = 0; i < 1000; ++i) {
        EXPECT_TRUE(paths.is_news("/d/x", rejected("bad")));
        EXPECT_TRUE(paths.is_news("/d/x", outcome_of(IngestResult::vanished)));
    }
    EXPECT_LE(paths.count(), 100U);
}

}  // namespace
}  // namespace stormcellar::daemon
