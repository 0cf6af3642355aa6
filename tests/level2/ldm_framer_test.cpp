#include "level2/containers/ldm_framer.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/level2/wire.h"

namespace stormcellar::level2 {
namespace {

std::vector<LdmPart> parts_of(std::span<const std::byte> bytes) {
    LdmFramer framer{bytes};
    std::vector<LdmPart> parts;
    std::size_t at = 0;
    while (auto part = framer.next()) {
        EXPECT_GE(part->position, at) << "parts go forward";
        at = part->position;
        parts.push_back(*part);
        if (parts.size() > 1000) break;
    }
    return parts;
}

const wire::Bytes one = wire::ldm_record(wire::frame(2));
const wire::Bytes last = wire::ldm_record(wire::frame(2), true);

TEST(LdmFramer, CutsRecordsAndReadsTheSign) {
    const wire::Bytes bytes = wire::join({one, last});
    const auto parts = parts_of(bytes);
    ASSERT_EQ(parts.size(), 2);
    EXPECT_EQ(parts[0].bytes.size(), one.size() - 4);
    EXPECT_FALSE(parts[0].negative);
    EXPECT_TRUE(parts[1].negative);
    EXPECT_EQ(parts[1].position, one.size());
    EXPECT_FALSE(parts[1].cut || parts[1].bad_length);
}

TEST(LdmFramer, GivesTheStreamsOfAFileThatBeginsWithOne) {
    const wire::Bytes header = wire::archive_header("AR2V0006.117");
    const wire::Bytes file = wire::join({header, one, wire::Bytes(12), one, header, last});
    const auto records = ldm_records(file);
    ASSERT_EQ(records.size(), 3);
    EXPECT_EQ(records[0].data(), file.data() + header.size() + 4);
    EXPECT_EQ(records[0].size(), one.size() - 4);
    EXPECT_EQ(ldm_records(wire::join({one, last})).size(), 2);
    EXPECT_TRUE(ldm_records(wire::join({header, wire::Bytes(64), one})).empty());
    EXPECT_TRUE(ldm_records(header).empty());
    EXPECT_TRUE(ldm_records({}).empty());
}

TEST(LdmFramer, GoesOnBehindANegativeWord) {
    const wire::Bytes bytes = wire::join({last, last, one});
    EXPECT_EQ(parts_of(bytes).size(), 3);
}

TEST(LdmFramer, AHeaderBetweenRecordsIsOne) {
    const wire::Bytes bytes = wire::join({one, wire::archive_header("AR2V0006.117"), one});
    const auto parts = parts_of(bytes);
    ASSERT_EQ(parts.size(), 3);
    EXPECT_EQ(parts[1].kind, LdmPart::Kind::header);
    EXPECT_EQ(parts[1].header.filename, "AR2V0006.117");
}

TEST(LdmFramer, AWrongLengthReachesToTheNextRecord) {
    for (const std::uint32_t length : {0U, 10U, 0x7FFFFFFFU, 0x80000000U}) {
        wire::Bytes bytes = wire::join({one, one});
        wire::overwrite_u32(bytes, 0, length);
        const auto parts = parts_of(bytes);
        ASSERT_EQ(parts.size(), 2) << length;
        EXPECT_EQ(parts[0].bytes.size(), one.size() - 4) << length;
        EXPECT_TRUE(parts[0].bad_length) << length;
        EXPECT_FALSE(parts[1].bad_length) << length;
    }
}

TEST(LdmFramer, ACutRecordSaysSo) {
    wire::Bytes bytes = wire::join({one, one});
    bytes.resize(bytes.size() - 5);
    const auto parts = parts_of(bytes);
    ASSERT_EQ(parts.size(), 2);
    EXPECT_TRUE(parts[1].cut);
    EXPECT_EQ(parts[1].bytes.size(), one.size() - 4 - 5);
}

TEST(LdmFramer, GarbageBetweenRecordsIsSteppedOver) {
    const wire::Bytes garbage =
        wire::Writer{}.text("some forty bytes that are no record at all").bytes;
    const wire::Bytes bytes = wire::join({one, garbage, one, wire::Bytes(100)});
    const auto parts = parts_of(bytes);
    std::size_t records = 0;
    std::size_t dropped = 0;
    std::size_t padding = 0;
    for (const LdmPart& part : parts) {
        if (part.kind == LdmPart::Kind::record) {
            ++records;
        } else if (part.kind == LdmPart::Kind::padding) {
            padding += part.bytes.size();
        } else {
            dropped += part.bytes.size();
        }
    }
    EXPECT_EQ(records, 2);
    EXPECT_EQ(padding, 100);
    // The length of the first record is wrong, so the framer may take the bytes after it for a part
    // of the record.
    EXPECT_TRUE(dropped == garbage.size() ||
                parts[0].bytes.size() == one.size() - 4 + garbage.size());
}

TEST(LdmFramer, AControlWordThatLostBytesCostsNothing) {
    for (std::ptrdiff_t lost = 1; lost <= 4; ++lost) {
        wire::Bytes bytes = wire::join({one, one, one});
        const auto second = bytes.begin() + static_cast<std::ptrdiff_t>(one.size());
        bytes.erase(second, second + lost);
        const auto parts = parts_of(bytes);
        ASSERT_EQ(parts.size(), 3U) << lost;
        EXPECT_TRUE(parts[1].bad_length) << lost;
        EXPECT_TRUE(std::equal(parts[1].bytes.begin(), parts[1].bytes.end(), one.begin() + 4))
            << lost;
        EXPECT_FALSE(parts[2].bad_length) << lost;
    }
}

}  // namespace
}  // namespace stormcellar::level2
