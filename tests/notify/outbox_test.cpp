// Tests that messages on disk survive restarts, full disks and power cuts.
#include "notify/outbox.h"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/testing/power_cut_file_system.h"

namespace stormcellar::notify {
namespace {

const UtcTime scan_time = *parse_utc("2024-06-01T22:00:00.123Z", UtcTime{});
const std::string first_cell = "20240601T215500Z_35.32N_97.51W";

class OutboxOnDisk : public ::testing::Test {
  protected:
    std::unique_ptr<Outbox> open() { return std::move(*Outbox::open(files_, directory_ / "box")); }
    MessageName name(int minute, const std::string& cell = first_cell) {
        return {scan_time + std::chrono::minutes{minute}, cell};
    }
    testing::TemporaryDirectory directory_;
    testing::PowerCutFileSystem files_;
};

TEST(MessageNames, RoundTripAndRefuse) {
    const MessageName name{scan_time, first_cell};
    EXPECT_EQ(name.id(), "20240601_220000_123_20240601T215500Z_35.32N_97.51W");
    EXPECT_EQ(parse_id(name.id()), name);
    for (const char* id :
         {"", "20240601_220000_123_", "20240601_220000_12x_a", "20240601_220000-123_a",
          "20241301_220000_123_a", "readme", "20240601_220000_123_a/b", "20240601_220000_123_..\n"})
        EXPECT_FALSE(parse_id(id)) << id;
}

TEST_F(OutboxOnDisk, ARestartNeitherLosesNorDoubles) {
    {
        const auto outbox = open();
        ASSERT_TRUE(outbox->put(name(0), "{\"n\":0}"));
        ASSERT_TRUE(outbox->put(name(5), "{\"n\":5}"));
        ASSERT_TRUE(outbox->settle(name(0)));
    }
    files_.power_cut();
    const auto outbox = open();
    EXPECT_EQ(outbox->waiting(), 1U);
    EXPECT_EQ(outbox->oldest(), name(5));
    EXPECT_EQ(*outbox->read(name(5)), "{\"n\":5}");
    EXPECT_EQ(outbox->last_of(first_cell), scan_time + std::chrono::minutes{5});
    ASSERT_TRUE(outbox->settle(name(5)));
    files_.power_cut();
    const auto later = open();
    EXPECT_EQ(later->waiting(), 0U);
    EXPECT_EQ(later->last_of(first_cell), scan_time + std::chrono::minutes{5})
        << "the limit of messages survives a restart, too";
    EXPECT_FALSE(later->last_of("another"));
}

TEST_F(OutboxOnDisk, AFullDiskLeavesNoMessageAndNoRest) {
    const auto outbox = open();
    files_.set_space(3);
    const auto put = outbox->put(name(0), "{\"n\":0}");
    ASSERT_FALSE(put);
    EXPECT_EQ(put.error().code, ErrorCode::no_space);
    EXPECT_EQ(outbox->waiting(), 0U);
    EXPECT_FALSE(outbox->last_of(first_cell)) << "the next turn tries the message again";
    EXPECT_TRUE(std::filesystem::is_empty(directory_ / "box"));
    files_.set_space(1000);
    EXPECT_TRUE(outbox->put(name(0), "{\"n\":0}"));
}

TEST_F(OutboxOnDisk, ADiskThatFailsDoesNotDeliverForEver) {
    const auto outbox = open();
    ASSERT_TRUE(outbox->put(name(0), "{}"));
    files_.fail_from(files_.operation_count());
    EXPECT_FALSE(outbox->settle(name(0)));
    EXPECT_FALSE(outbox->oldest());
}

TEST_F(OutboxOnDisk, TheOldestMakeRoom) {
    std::filesystem::create_directories(directory_ / "box");
    for (int i = 0; i < static_cast<int>(Outbox::most_waiting); ++i)
        std::ofstream(directory_ / "box" / (name(i).id() + ".json")) << "{}";
    const auto outbox = open();
    EXPECT_EQ(outbox->waiting(), Outbox::most_waiting);
    EXPECT_EQ(*outbox->put(name(5000), "{}"), 1U);
    EXPECT_EQ(outbox->waiting(), Outbox::most_waiting);
    EXPECT_EQ(outbox->oldest(), name(1));
}

TEST_F(OutboxOnDisk, ForgetsOldMessagesThatWereSettled) {
    const auto outbox = open();
    for (const int minute : {0, 5, 10})
        ASSERT_TRUE(outbox->put(name(minute, fmt::format("cell-{}", minute)), "{}"));
    ASSERT_TRUE(outbox->settle(name(0, "cell-0")));
    ASSERT_TRUE(outbox->settle(name(10, "cell-10")));
    outbox->forget_before(scan_time + std::chrono::minutes{8});
    EXPECT_FALSE(outbox->last_of("cell-0"));
    EXPECT_TRUE(outbox->last_of("cell-10"));
    EXPECT_EQ(outbox->waiting(), 1U) << "a message that waits is never forgotten";
    const auto later = open();
    EXPECT_FALSE(later->last_of("cell-0"));
    EXPECT_TRUE(later->last_of("cell-5"));
}

TEST_F(OutboxOnDisk, ForeignFilesAreLeftAlone) {
    std::filesystem::create_directories(directory_ / "box");
    std::ofstream(directory_ / "box" / "readme.json") << "{}";
    std::ofstream(directory_ / "box" / "20240601_220000_123_a.txt") << "{}";
    const auto outbox = open();
    EXPECT_EQ(outbox->waiting(), 0U);
    EXPECT_TRUE(std::filesystem::exists(directory_ / "box" / "readme.json"));
    EXPECT_FALSE(outbox->read(name(0)));
}

}  // namespace
}  // namespace stormcellar::notify
