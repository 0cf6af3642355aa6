// Tests single known kinds of damage on volumes made by hand.
#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "base/byte_reader.h"
#include "level2/messages/message_header.h"
#include "stormcellar/level2/decode.h"
#include "tests/level2/radial_identity.h"
#include "tests/level2/wire.h"

namespace stormcellar::level2 {
namespace {

using wire::Bytes;

constexpr std::array<float, 3> elevations_deg = {0.5F, 1.5F, 2.5F};

bool has_problem(const DecodeReport& report, std::string_view code) {
    return std::any_of(report.problems.begin(), report.problems.end(),
                       [&](const Problem& problem) { return problem.code == code; });
}

// Returns a volume of plain messages: the header, the VCP and three sweeps of six radials.
Bytes plain_volume(const Bytes& vcp) {
    return wire::join({wire::archive_header(), vcp, wire::radial_messages(3, 6)});
}

std::vector<RadialIdentity> radials_of(const Bytes& file) {
    const auto decoded = decode(file);
    return decoded ? identities(decoded->volume) : std::vector<RadialIdentity>{};
}

// Message 5 gives its number of cuts, which is negative in some cases if it is read as a signed
// number.
class NumberOfCuts : public ::testing::TestWithParam<unsigned> {
  protected:
    static Bytes damaged() {
        Bytes vcp = wire::vcp_frame(212, elevations_deg);
        wire::overwrite_u16(vcp, 28 + 6, GetParam());
        return plain_volume(vcp);
    }
};

TEST_P(NumberOfCuts, BeyondTheMessageCostsThePatternOnly) {
    const auto decoded = decode(damaged());
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_FALSE(decoded->volume.vcp_message);
    // The pattern number comes from the radials.
    EXPECT_EQ(decoded->volume.vcp, 212);
    EXPECT_EQ(decoded->volume.vcp_source, VcpSource::radial);
    EXPECT_EQ(identities(decoded->volume),
              radials_of(plain_volume(wire::vcp_frame(212, elevations_deg))));
}

// The values are, as signed numbers, -1, the lowest, the highest, more than the 51 cuts that fit,
// and 0.
INSTANTIATE_TEST_SUITE_P(Extremes, NumberOfCuts,
                         ::testing::Values(0xFFFFU, 0x8000U, 0x7FFFU, 53U, 0U));

// The stream after a wrong control word is intact, so nothing may be lost.
TEST(ControlWord, ExtremesCostNothing) {
    const Bytes volume = wire::ldm_volume(3, 6);
    const auto expected = radials_of(volume);
    ASSERT_EQ(expected.size(), 18);
    for (const std::uint32_t word : {0U, 1U, 0xFFFFFFFFU, 0x80000000U, 0x7FFFFFFFU, 4U, 0xFFFFU}) {
        Bytes damaged = volume;
        wire::overwrite_u32(damaged, 24, word);
        const auto decoded = decode(damaged);
        ASSERT_TRUE(decoded) << decoded.error().message;
        EXPECT_EQ(identities(decoded->volume), expected) << word;
        EXPECT_TRUE(has_problem(decoded->report, "bad_control_word")) << word;
    }
}

TEST(Cut, AtEveryByteOfAStreamKeepsWhatIsWhole) {
    const Bytes header = wire::archive_header();
    const Bytes radials = wire::radial_messages(1, 4, 20);
    const std::size_t length = radials.size() / 4;
    const auto expected = radials_of(wire::join({header, radials}));
    for (std::size_t size = length; size < radials.size(); ++size) {
        const auto decoded = decode(
            wire::join({header, {radials.begin(), radials.begin() + static_cast<long>(size)}}));
        ASSERT_TRUE(decoded) << size;
        const auto found = identities(decoded->volume);
        ASSERT_EQ(found.size(), size / length) << size;
        EXPECT_TRUE(std::equal(found.begin(), found.end(), expected.begin())) << size;
        EXPECT_TRUE(has_problem(decoded->report, "no_end_of_volume")) << size;
        // The 12 bytes of the terminal manager and the byte after them are zeros, so up to 13 bytes
        // look like padding.
        EXPECT_EQ(has_problem(decoded->report, "damaged_messages"), size % length > 13) << size;
    }
}

TEST(Cut, AtEveryByteOfARecordKeepsTheRecordsBefore) {
    const Bytes volume = wire::ldm_volume(2, 3, 20);
    // The record begins after the header, the metadata and the first sweep.
    std::size_t start = 24;
    for (int record = 0; record < 2; ++record) {
        ByteReader reader{std::span{volume}.subspan(start)};
        start += 4 + reader.u32();
    }
    const auto expected = radials_of(volume);
    ASSERT_EQ(expected.size(), 6);
    for (std::size_t size = start; size < volume.size(); ++size) {
        const auto decoded =
            decode(Bytes{volume.begin(), volume.begin() + static_cast<long>(size)});
        ASSERT_TRUE(decoded) << size;
        const auto found = identities(decoded->volume);
        ASSERT_TRUE(found.size() == 3 || found.size() == 6) << size;
        EXPECT_TRUE(std::equal(found.begin(), found.end(), expected.begin())) << size;
        const bool named =
            std::any_of(decoded->report.problems.begin(), decoded->report.problems.end(),
                        [](const Problem& problem) { return problem.severity != Severity::note; });
        EXPECT_TRUE(named || found.size() == 6) << size;
    }
}

// ---- Found by mutants, each in its smallest form

// 2026-11-21, seven legacy volumes: bytes at a wrong place can look like a plausible header, and
// the bytes a frame later then often look like a header, too. The reader took hundreds of frames
// for messages of unknown types.
TEST(FoundByMutants, EightBytesLostCostOneLegacyRadial) {
    Bytes radials;
    for (unsigned i = 0; i < 40; ++i) {
        radials = wire::join({radials, wire::message_1({.azimuth_deg = static_cast<float>(i),
                                                        .azimuth_number = i + 1,
                                                        .status = i == 0 ? 3U : 1U})});
    }
    const Bytes header = wire::archive_header("ARCHIVE2.031", std::string(4, '\0'));
    ASSERT_EQ(radials_of(wire::join({header, radials})).size(), 40);
    const auto place = radials.begin() + 10 * frame_bytes + 500;
    radials.erase(place, place + 8);
    EXPECT_EQ(radials_of(wire::join({header, radials})).size(), 39);
}

// 2026-11-21: message 15, with its type damaged to 1, became a radial of elevation 0 at azimuth 0,
// and the report did not mention it.
TEST(FoundByMutants, MetadataOfAnotherTypeIsNoRadial) {
    const Bytes metadata = wire::frame(15, Bytes(100, std::byte{3}));
    for (const unsigned type : {1U, 31U}) {
        Bytes damaged = metadata;
        damaged[15] = static_cast<std::byte>(type);
        const Bytes radials = wire::radial_messages(1, 6);
        const auto decoded = decode(wire::join({wire::archive_header(), damaged, radials}));
        ASSERT_TRUE(decoded);
        EXPECT_EQ(decoded->volume.radial_count(), 6) << type;
        EXPECT_TRUE(has_problem(decoded->report, "bad_radial") ||
                    has_problem(decoded->report, "damaged_messages"))
            << type;
    }
}

// 2026-11-21, KDOX20100911 and L2D_185: a message 31 was shorter than a frame, and its type was
// damaged to a type that fills a frame. The reader accepted that type because of zeros among the
// gates a frame later.
TEST(FoundByMutants, AFrameDoesNotSwallowTheRadialsInsideIt) {
    Bytes radials;
    for (unsigned i = 0; i < 20; ++i) {
        radials = wire::join({radials, wire::message_31({.azimuth_deg = static_cast<float>(i),
                                                         .azimuth_number = i + 1,
                                                         .fill = 0})});
    }
    const Bytes header = wire::archive_header();
    const std::size_t length = radials.size() / 20;
    radials[10 * length + 15] = std::byte{128};
    EXPECT_EQ(radials_of(wire::join({header, radials})).size(), 19);
}

// 2026-11-21, KTLX20140101: a record of more than 4 MiB was read block by block, without a
// comparison of the control word with the stream.
TEST(FoundByMutants, TheWrongLengthOfALargeRecordIsNamed) {
    const Bytes radials = wire::radial_messages(1, 1500, 1000);
    ASSERT_GT(radials.size(), std::size_t{4} << 20);
    Bytes record = wire::ldm_record(radials, true);
    wire::overwrite_u32(record, 0, static_cast<std::uint32_t>(record.size() - 4 + 1));
    const auto decoded = decode(wire::join({wire::archive_header(), record}));
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded->volume.radial_count(), 1500);
    EXPECT_TRUE(has_problem(decoded->report, "bad_control_word"));
}

// 2026-11-21, KTLX19910720 and KLIX20050828: after a hundred notes the list of problems was full,
// and the error of the gzip checksum was left out.
TEST(FoundByMutants, NotesDoNotCrowdOutErrors) {
    Bytes file = wire::join({wire::archive_header(), wire::radial_messages(1, 6)});
    for (int i = 0; i < 120; ++i)
        file = wire::join({file, wire::frame(200)});
    Bytes packed = wire::gzip(wire::join({file, wire::radial_messages(1, 6)}));
    packed[packed.size() - 8] ^= std::byte{1};
    const auto decoded = decode(packed);
    ASSERT_TRUE(decoded);
    EXPECT_TRUE(has_problem(decoded->report, "gzip_checksum"));
}

// 2026-11-21: the decoder skipped a message 5 that it could not read, and the report did not
// mention it.
TEST(FoundByMutants, AnUnreadablePatternIsNamed) {
    Bytes vcp = wire::vcp_frame(212, elevations_deg);
    wire::overwrite_u16(vcp, 28 + 6, 0xFFFF);
    const auto decoded = decode(plain_volume(vcp));
    ASSERT_TRUE(decoded);
    EXPECT_FALSE(decoded->report.problems.empty());
}

// 2026-11-21: the clutter map of KMPX20060106 has no date, so the reader did not recognize it. A
// radial before the map had lost bytes, and the reader accepted this radial with a part of the map
// as its gates.
TEST(FoundByMutants, HalfARadialBeforeUndatedFramesDoesNotComeOut) {
    Bytes half = wire::message_1({});
    half.resize(664);
    Bytes file = wire::join({wire::archive_header(), half});
    for (unsigned segment = 44; segment < 50; ++segment) {
        Bytes frame = wire::frame(15);
        wire::overwrite_u16(frame, 12, 1208);
        wire::overwrite_u32(frame, 16, 0);  // sequence number and date
        wire::overwrite_u32(frame, 20, 0);  // time
        wire::overwrite_u16(frame, 24, 62);
        wire::overwrite_u16(frame, 26, segment);
        file.insert(file.end(), frame.begin(), frame.end());
    }
    const auto decoded = decode(file);
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_EQ(decoded->volume.radial_count(), 0U);
    EXPECT_EQ(decoded->report.message_counts.at(15), 6U);
    EXPECT_EQ(decoded->report.bytes_dropped, 664U);
}

}  // namespace
}  // namespace stormcellar::level2
