#include "level2/decode/message_reader.h"

#include <gtest/gtest.h>

#include "level2/decode/volume_builder.h"
#include "tests/level2/no_limits.h"
#include "tests/level2/same_volume.h"
#include "tests/level2/wire.h"

namespace stormcellar::level2 {
namespace {

struct Outcome {
    Volume volume;
    DecodeReport report;
};

Outcome outcome_of(MessageReader& reader) {
    std::optional<Fragment> fragment = reader.take_fragment();
    EXPECT_TRUE(fragment);
    Outcome outcome;
    outcome.report = fragment->report;
    VolumeBuilder volume{ample};
    EXPECT_TRUE(volume.append(std::move(*fragment)));
    auto decoded = volume.finish("");
    if (decoded) outcome.volume = std::move(decoded->volume);
    return outcome;
}

Outcome read_whole(std::span<const std::byte> bytes) {
    ArrayRoom room{ample};
    FragmentBuilder builder{room, 8, everything};
    MessageReader reader{builder};
    EXPECT_EQ(reader.read(bytes, true), bytes.size());
    EXPECT_EQ(reader.offset(), bytes.size());
    return outcome_of(reader);
}

Outcome read_in_pieces(std::span<const std::byte> bytes, std::size_t piece) {
    ArrayRoom room{ample};
    FragmentBuilder builder{room, 8, everything};
    MessageReader reader{builder};
    MessageFeed feed{reader};
    for (std::size_t at = 0; at < bytes.size(); at += piece)
        feed.append(bytes.subspan(at, std::min(piece, bytes.size() - at)));
    feed.end();
    return outcome_of(reader);
}

std::vector<int> azimuth_numbers(const Volume& volume) {
    std::vector<int> numbers;
    for (const Sweep& sweep : volume.sweeps) {
        for (const Radial& radial : sweep.radials)
            numbers.push_back(radial.azimuth_number);
    }
    return numbers;
}

wire::Bytes ray_1(unsigned number) {
    wire::Ray ray{.azimuth_number = number};
    return wire::message_1(ray);
}

wire::Bytes ray_31(unsigned number) {
    wire::Ray ray{.azimuth_number = number};
    return wire::message_31(ray);
}

TEST(MessageReader, CountsEveryMessageAndSkipsWhatItDoesNotNeed) {
    const wire::Bytes bytes = wire::join(
        {wire::frame(15), wire::frame(0), ray_31(1), wire::frame(2), ray_31(2), wire::frame(32)});
    const Outcome outcome = read_whole(bytes);
    const std::map<int, std::uint64_t> expected = {{0, 1}, {2, 1}, {15, 1}, {31, 2}, {32, 1}};
    EXPECT_EQ(outcome.report.message_counts, expected);
    EXPECT_EQ(outcome.report.message_bytes, bytes.size());
    EXPECT_EQ(outcome.report.bytes_dropped, 0);
    EXPECT_TRUE(outcome.report.problems.empty());
    EXPECT_EQ(azimuth_numbers(outcome.volume), (std::vector<int>{1, 2}));
}

TEST(MessageReader, PiecesOfAnySizeGiveTheSame) {
    wire::Bytes bytes = wire::radial_messages(2, 20);
    bytes.insert(bytes.begin() + 3000, 77, std::byte{0x55});  // damage somewhere
    const Outcome whole = read_whole(bytes);
    for (const std::size_t piece : {1000U, 2432U, 9999U}) {
        const Outcome pieces = read_in_pieces(bytes, piece);
        EXPECT_EQ(azimuth_numbers(pieces.volume), azimuth_numbers(whole.volume)) << piece;
        EXPECT_EQ(pieces.report.bytes_dropped, whole.report.bytes_dropped) << piece;
        EXPECT_EQ(pieces.report.corruption->offset, whole.report.corruption->offset) << piece;
    }
}

TEST(MessageReader, BytesAddedBetweenMessagesAreDroppedAndNamed) {
    const wire::Bytes extra = wire::Writer{}.text(std::string(100, 'x')).bytes;
    const wire::Bytes bytes = wire::join({ray_1(1), ray_1(2), extra, ray_1(3)});
    const Outcome outcome = read_whole(bytes);
    EXPECT_EQ(azimuth_numbers(outcome.volume), (std::vector<int>{1, 2, 3}));
    EXPECT_EQ(outcome.report.bytes_dropped, 100);
    ASSERT_TRUE(outcome.report.corruption);
    EXPECT_EQ(outcome.report.corruption->offset, 2 * 2432);
    ASSERT_EQ(outcome.report.problems.size(), 1);
    EXPECT_EQ(outcome.report.problems[0].offset, 2 * 2432);
    EXPECT_EQ(outcome.report.problems[0].severity, Severity::error);
}

// A radial that has lost bytes is dropped as a whole, whichever bytes are lost.
TEST(MessageReader, ARadialThatLostBytesIsDropped) {
    for (const std::size_t lost : {1U, 200U, 1000U, 2000U}) {
        for (const auto& make : {ray_1, ray_31}) {
            wire::Bytes middle = make(2);
            if (lost + 100 > middle.size()) continue;
            middle.resize(middle.size() - lost);
            const Outcome outcome = read_whole(wire::join({make(1), middle, make(3), make(4)}));
            EXPECT_EQ(azimuth_numbers(outcome.volume), (std::vector<int>{1, 3, 4})) << lost;
            EXPECT_EQ(outcome.report.bytes_dropped, middle.size()) << lost;
        }
    }
}

// In clear air, a radial is mostly zeros, which look like a fill frame.
TEST(MessageReader, ZerosOfALostRadialAreNoFillFrames) {
    wire::Ray clear{.gates = 1800, .fill = 0};
    wire::Bytes second = wire::message_31(clear);
    second.erase(second.begin() + 400, second.begin() + 2000);
    const Outcome outcome =
        read_whole(wire::join({ray_31(1), second, wire::message_31(clear), ray_31(4)}));
    EXPECT_EQ(outcome.volume.radial_count(), 3);
    EXPECT_FALSE(outcome.report.message_counts.contains(0));
}

TEST(MessageReader, AMessageCutByTheEndIsDropped) {
    wire::Bytes bytes = wire::join({ray_31(1), ray_31(2)});
    const std::size_t second = bytes.size() / 2;
    for (std::size_t size = second + 1; size < bytes.size(); size += 7) {
        const Outcome outcome = read_whole(std::span{bytes}.first(size));
        EXPECT_EQ(azimuth_numbers(outcome.volume), (std::vector<int>{1})) << size;
        if (size < second + 28 && all_zero(std::span{bytes}.subspan(second, size - second))) {
            continue;  // a few zeros count as padding
        }
        EXPECT_EQ(outcome.report.bytes_dropped, size - second);
        EXPECT_EQ(outcome.report.corruption->offset, second);
    }
}

// The second radial has lost bytes, so by its length it ends inside the third radial, a few bytes
// before the end of the data. These few bytes are not a message, so they do not prove that the
// second radial ends there.
TEST(MessageReader, AFewBytesBehindARadialDoNotProveItsEnd) {
    wire::Ray large{.azimuth_number = 2, .gates = 600};
    const wire::Bytes third = ray_31(3);
    for (const std::size_t behind : {1U, 10U, 27U}) {
        wire::Bytes second = wire::message_31(large);
        wire::overwrite_u16(second, 28 + 18, static_cast<unsigned>(second.size() - 28));
        second.resize(second.size() - third.size() + behind);
        const Outcome outcome = read_whole(wire::join({ray_31(1), second, third}));
        EXPECT_EQ(azimuth_numbers(outcome.volume), (std::vector<int>{1, 3})) << behind;
        EXPECT_EQ(outcome.report.bytes_dropped, second.size()) << behind;
    }
}

TEST(MessageReader, ALengthThatLiesCostsThatRadialOnly) {
    for (const unsigned halfwords : {20U, 100U, 3000U, 40000U, 65535U}) {
        wire::Bytes liar = ray_31(2);
        wire::overwrite_u16(liar, 12, halfwords);
        const Outcome outcome =
            read_whole(wire::join({ray_31(1), liar, ray_31(3), ray_31(4), ray_31(5)}));
        EXPECT_EQ(azimuth_numbers(outcome.volume), (std::vector<int>{1, 3, 4, 5})) << halfwords;
        EXPECT_GT(outcome.report.bytes_dropped, 0) << halfwords;
    }
}

TEST(MessageReader, ACompressedRadialIsReadAndADamagedOneIsDroppedAndNamed) {
    const Outcome plain = read_whole(wire::join({ray_31(1), ray_31(2)}));
    for (const int indicator : {1, 2}) {
        const wire::Bytes packed = wire::compressed_message_31(ray_31(2), indicator);
        const Outcome outcome = read_whole(wire::join({ray_31(1), packed}));
        EXPECT_EQ(difference(outcome.volume, plain.volume), "") << indicator;
        EXPECT_EQ(outcome.report.radial_compression.at(indicator), 1);
        EXPECT_EQ(outcome.report.bytes_dropped, 0);

        wire::Bytes damaged = packed;
        damaged[damaged.size() - 12] ^= std::byte{0x10};
        const Outcome rest = read_whole(wire::join({ray_31(1), damaged, ray_31(3)}));
        EXPECT_EQ(azimuth_numbers(rest.volume), (std::vector<int>{1, 3})) << indicator;
        EXPECT_EQ(rest.report.problems.at(0).code, "bad_radial");
        EXPECT_EQ(rest.report.bytes_dropped, damaged.size());
    }
}

TEST(MessageReader, CountsTheCompressionOfRadialsThatItKeeps) {
    const wire::Bytes good = wire::compressed_message_31(ray_31(1), 2);
    wire::Bytes damaged = wire::compressed_message_31(ray_31(2), 2);
    damaged[damaged.size() - 20] ^= std::byte{0xFF};
    const wire::Bytes no_moment = wire::message_31_with_block(wire::Writer{}.text("DREF").bytes);
    const Outcome outcome =
        read_whole(wire::join({good, damaged, ray_31(3), no_moment, ray_31(4)}));
    EXPECT_EQ(azimuth_numbers(outcome.volume), (std::vector<int>{1, 3, 4}));
    const std::map<int, std::uint64_t> expected = {{0, 2}, {2, 1}};
    EXPECT_EQ(outcome.report.radial_compression, expected);
}

TEST(MessageReader, AHeaderInTheMiddleIsSkipped) {
    const Outcome outcome =
        read_whole(wire::join({wire::frame(2), wire::archive_header(), wire::frame(2), ray_31(1)}));
    EXPECT_EQ(outcome.report.message_counts.at(2), 2);
    EXPECT_EQ(outcome.volume.radial_count(), 1);
    EXPECT_EQ(outcome.report.bytes_dropped, 0);
}

TEST(MessageReader, ProblemsStayFewWhateverTheInput) {
    wire::Bytes bytes;
    const wire::Bytes bad = wire::join({ray_1(1), wire::Writer{}.text("xxxxxxx").bytes});
    for (int i = 0; i < 1000; ++i)
        bytes.insert(bytes.end(), bad.begin(), bad.end());
    ArrayRoom room{ample};
    FragmentBuilder builder{room, 8, everything};
    MessageReader reader{builder};
    reader.read(bytes, true);
    const Outcome outcome = outcome_of(reader);
    EXPECT_EQ(outcome.report.problems.size(), DecodeReport::max_problems);
    EXPECT_EQ(outcome.report.problems_left_out, 900);
    EXPECT_EQ(outcome.report.bytes_dropped, 7000);
}

TEST(MessageReader, RandomBytesGiveNothing) {
    std::uint32_t state = 1;
    wire::Bytes bytes(1'000'000);
    for (std::byte& b : bytes) {
        state = state * 1664525 + 1013904223;
        b = static_cast<std::byte>(state >> 24);
    }
    const Outcome outcome = read_whole(bytes);
    EXPECT_EQ(outcome.volume.sweeps.size(), 0);
}

}  // namespace
}  // namespace stormcellar::level2
