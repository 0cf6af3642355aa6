#include "level2/messages/message_header.h"

#include <gtest/gtest.h>

#include "tests/level2/wire.h"

namespace stormcellar::level2 {
namespace {

TEST(MessageHeader, FramesHaveOneLengthAndMessage31ItsOwn) {
    const auto frame = read_message_header(wire::message_header(2, 48));
    EXPECT_EQ(frame.type, 2);
    EXPECT_EQ(frame.date, wire::day);
    EXPECT_EQ(frame.ms, 3'600'000);
    EXPECT_EQ(frame.length_bytes(), 2432);
    EXPECT_EQ(read_message_header(wire::message_header(31, 3000)).length_bytes(), 6012);
}

TEST(MessageHeader, ASizeOf65535HasTheBytesInTheSegmentFields) {
    const auto header = read_message_header(wire::message_header(29, 65535, 2, 5));
    EXPECT_EQ(header.length_bytes(), 12 + 2 * 65536 + 5);
}

TEST(MessageHeader, FieldsOutOfTheirRangesAreImplausible) {
    EXPECT_TRUE(is_plausible(read_message_header(wire::message_header(15, 1208, 14, 14))));
    EXPECT_FALSE(is_plausible(read_message_header(wire::message_header(15, 1208, 14, 15))));
    EXPECT_FALSE(is_plausible(read_message_header(wire::message_header(15, 1211))));
    EXPECT_FALSE(is_plausible(read_message_header(wire::message_header(15, 7))));
    wire::Bytes late = wire::message_header(15, 1208);
    wire::overwrite_u32(late, 20, 86'401'000);
    EXPECT_FALSE(is_plausible(read_message_header(late)));
}

TEST(MessageHeader, RadialsAreSureAndTheirHeadersAloneAreNot) {
    EXPECT_TRUE(is_surely_message(wire::message_1({})));
    EXPECT_TRUE(is_surely_message(wire::message_31({})));
    EXPECT_FALSE(is_surely_message(wire::frame(1)));
    EXPECT_FALSE(is_surely_message(wire::message_header(31, 3000)));
    EXPECT_FALSE(is_surely_message({}));
}

TEST(MessageHeader, ABodyThatDisagreesWithItsHeaderIsNotSure) {
    wire::Bytes other_day = wire::message_31({});
    wire::overwrite_u16(other_day, 28 + 8, wire::day + 2);
    EXPECT_FALSE(is_surely_message(other_day));
    wire::Bytes not_a_number = wire::message_31({});
    wire::overwrite_u32(not_a_number, 28 + 12, 0x7FC00000);
    EXPECT_FALSE(is_surely_message(not_a_number));
}

TEST(MessageHeader, AMessageIsFoundAtAnyOffset) {
    for (const std::size_t offset : {0U, 1U, 744U, 5000U}) {
        const wire::Bytes bytes = wire::join({wire::Bytes(offset), wire::message_1({})});
        EXPECT_EQ(find_message(bytes, 0), offset);
        EXPECT_EQ(find_message(bytes, offset + 1), std::nullopt);
    }
}

}  // namespace
}  // namespace stormcellar::level2
