#include "stormcellar/level2/encode.h"

#include <algorithm>
#include <cstdlib>
#include <map>

#include <gtest/gtest.h>

#include "base/byte_reader.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/live_volume.h"
#include "tests/level2/example_volume.h"
#include "tests/level2/same_volume.h"
#include "tests/level2/wire.h"
#include "tests/testing/data.h"

namespace stormcellar::level2 {
namespace {

using wire::Bytes;

void expect_round_trip(const Volume& volume) {
    const auto encoded = encode(volume);
    ASSERT_TRUE(encoded) << encoded.error().message;
    const auto decoded = decode(encoded->joined());
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_EQ(difference(volume, decoded->volume), "");
    EXPECT_EQ(decoded->report.bytes_dropped, 0);
    EXPECT_EQ(decoded->report.complete, !volume.sweeps.empty());
}

TEST(Encode, EveryFieldComesBack) {
    expect_round_trip(example_volume());
}

TEST(Encode, APatternOfMessage7ComesBack) {
    Volume volume = example_volume();
    volume.vcp_message->message_type = 7;
    volume.vcp_source = VcpSource::message_7;
    expect_round_trip(volume);
}

TEST(Encode, RadialsThatLackAMomentOrDifferInLengthComeBack) {
    Volume volume = example_volume();
    SweepMoment& ref = volume.sweeps[0].moments[0];
    ref.gate_counts[3] = 0;
    ref.gate_counts[5] = 10;
    std::fill_n(ref.codes8.begin() + 3 * 101, 101, std::uint8_t{0});
    std::fill_n(ref.codes8.begin() + 5 * 101 + 10, 91, std::uint8_t{0});
    expect_round_trip(volume);
}

TEST(Encode, BlocksThatTheRadarDoesNotSendStayAbsent) {
    Volume volume = example_volume();
    for (Radial& radial : volume.sweeps[0].radials) {
        radial.calibration_dbz.reset();
        radial.vertical_calibration_dbz.reset();
        radial.attenuation_db_per_km_thousandths.reset();
        radial.elevation_calibration_db.reset();
    }
    for (Radial& radial : volume.sweeps[1].radials) {
        radial.vertical_noise_dbm.reset();  // unknown, inside a block that exists
        radial.elevation_calibration_db.reset();
    }
    Radial& bare = volume.sweeps[0].radials[7];
    bare.horizontal_noise_dbm.reset();
    bare.vertical_noise_dbm.reset();
    bare.nyquist_mps = bare.unambiguous_range_m = 0;
    bare.radial_flags = 0;
    volume.vcp_message.reset();
    volume.vcp_source = VcpSource::radial;
    for (Sweep& sweep : volume.sweeps)
        sweep.vcp_elevation_deg.reset();
    expect_round_trip(volume);
}

TEST(Encode, MetadataAloneIsAVolume) {
    Volume volume = example_volume();
    volume.sweeps.clear();
    volume.station = "KLOT";
    volume.block.reset();
    expect_round_trip(volume);
}

TEST(Encode, AVolumeWithoutAHeaderGetsOneWithTheFirstRadialsTime) {
    Volume volume = example_volume();
    volume.header.reset();
    const auto decoded = decode(encode(volume).value().joined()).value();
    ASSERT_TRUE(decoded.volume.header);
    EXPECT_EQ(decoded.volume.header->filename, "AR2V0006.001");
    EXPECT_EQ(decoded.volume.header->icao, "KLOT");
    EXPECT_EQ(decoded.volume.header->time(), volume.sweeps[0].radials[0].time);
}

// ICD 2620010 section 7.3.4: records have 120 radials of one sweep, and the length of the last
// record is negative. The metadata record has 134 frames, with messages 5 and 2 in the last two.
TEST(Encode, RecordsAreAsTheRdaSendsThem) {
    const auto encoded = encode(example_volume()).value();
    ASSERT_EQ(encoded.header.size(), 24);
    ASSERT_EQ(encoded.records.size(), 1 + 2 + 2);
    std::vector<std::size_t> counts;
    for (std::size_t i = 0; i < encoded.records.size(); ++i) {
        const auto& bytes = encoded.records[i].bytes;
        ByteReader reader(bytes);
        const std::int32_t length = reader.i32();
        EXPECT_EQ(length < 0, i + 1 == encoded.records.size());
        EXPECT_EQ(static_cast<std::size_t>(std::abs(length)), bytes.size() - 4);
        EXPECT_EQ(reader.text(3), "BZh");
        const auto decoded = decode(bytes);
        ASSERT_TRUE(decoded) << decoded.error().message;
        counts.push_back(decoded->volume.radial_count());
        if (i == 0) {
            EXPECT_EQ(decoded->report.message_bytes, 134 * 2432);
            const std::map<int, std::uint64_t> expected{{0, 132}, {2, 1}, {5, 1}};
            EXPECT_EQ(decoded->report.message_counts, expected);
        }
    }
    EXPECT_EQ(counts, (std::vector<std::size_t>{0, 120, 10, 120, 10}));
}

TEST(Encode, TheSameVolumeGivesTheSameBytes) {
    const Volume volume = example_volume();
    EXPECT_EQ(encode(volume)->joined(), encode(volume)->joined());
}

// The header has a later date than the decoder accepts in messages.
TEST(Encode, MetadataOfAStrangeDayComeBack) {
    Volume volume = example_volume();
    volume.sweeps.clear();
    volume.block.reset();
    volume.header->date = 50'000;
    expect_round_trip(volume);
}

class EncodeReal : public ::testing::TestWithParam<const char*> {};

TEST_P(EncodeReal, ComesBackToTheBit) {
    STORMCELLAR_NEED_DATA();
    const auto decoded = decode_file(*testing::data_directory() / GetParam());
    ASSERT_TRUE(decoded) << decoded.error().message;
    const auto encoded = encode(decoded->volume, {.compression_level = 1});
    ASSERT_TRUE(encoded) << encoded.error().message;
    DecodeOptions options;
    options.fallback_station = decoded->volume.station;
    const auto again = decode(encoded->joined(), options);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(difference(decoded->volume, again->volume), "");
    EXPECT_EQ(again->report.bytes_dropped, 0U);

    LiveOptions live_options{.decode = options};
    LiveVolume live{live_options};
    for (const EncodedChunk& chunk : encoded->chunks())
        EXPECT_TRUE(live.add(chunk.name.number, chunk.name.kind, chunk.bytes, {}));
    EXPECT_TRUE(live.is_whole());
    EXPECT_EQ(difference(live.finish().value(), *again), "");
}

// The volumes of message 31 have super-resolution with every moment, come from a TDWR, have trimmed
// rows or few radials, or are recombined. The volumes of message 1 are from 1991 and 1999, are
// damaged, come four in a file, or have velocity steps of 1 m/s or gates that vary within a sweep.
INSTANTIATE_TEST_SUITE_P(
    Volumes, EncodeReal,
    ::testing::Values(
        "volumes/KDMX20250101_225441_V06", "volumes/KTLX20170101_030027_V06",
        "volumes/Level2_TSTL_20220213_2357.ar2v", "volumes/KTLX20140101_000624.trimmed.ar2v",
        "volumes/KIWX20160429_194300_V06.gz", "volumes/KCCX20130112_070503_V06.gz",
        "volumes/KATX20160427_095248_V06.gz", "mosaic-northeast/KDOX20100911_012056_V04.gz",
        "volumes/KTLX19910720_160529.gz", "volumes/KTLX19990503_235621.gz",
        "volumes/KLVX20050106_163401.gz", "volumes/KBBX20060113_170337.gz",
        "volumes/KCRP20170826_044114.trimmed.ar2v", "volumes/KOKX20080109_141449.gz",
        "volumes/example_nexrad_archive_msg1.bz2", "sequence-kbgm/KBGM20050822_024414.gz"),
    [](const auto& test) { return std::to_string(test.index); });

TEST(Encode, ChunksAreNamedByTheVolumesStart) {
    const auto encoded = encode(example_volume()).value();
    const auto chunks = encoded.chunks();
    ASSERT_EQ(chunks.size(), encoded.records.size());
    Bytes joined;
    for (std::size_t i = 0; i < chunks.size(); ++i) {
        const std::string name = to_string(chunks[i].name);
        const auto parsed = parse_chunk_name(name);
        ASSERT_TRUE(parsed) << name;
        EXPECT_EQ(parsed->number, static_cast<int>(i) + 1);
        joined.insert(joined.end(), chunks[i].bytes.begin(), chunks[i].bytes.end());
    }
    EXPECT_EQ(chunks.front().name.kind, ChunkKind::start);
    EXPECT_EQ(chunks.back().name.kind, ChunkKind::end);
    EXPECT_EQ(joined, encoded.joined());
}

// Returns the bodies, without message headers, of the messages 31 in the record after the metadata
// record.
std::vector<Bytes> first_radials(std::span<const std::byte> file) {
    ByteReader reader(file);
    reader.skip(24);
    reader.skip(static_cast<std::size_t>(std::abs(reader.i32())));
    const auto size = static_cast<std::size_t>(std::abs(reader.i32()));
    const Bytes messages = wire::unpack_bzip2(reader.bytes(size));
    std::vector<Bytes> bodies;
    ByteReader stream(messages);
    while (stream.remaining() >= 28) {
        stream.skip(12);
        const std::size_t length = std::size_t{stream.u16()} * 2;
        stream.skip(1);
        EXPECT_EQ(stream.u8(), 31);
        stream.skip(12);
        const auto body = stream.bytes(length - 16);
        bodies.emplace_back(body.begin(), body.end());
    }
    return bodies;
}

// Compares messages 31 of an Open RDA with the same messages from the writer, byte by byte.
TEST(Encode, RadialsAreTheRadarsOwnBytes) {
    STORMCELLAR_NEED_DATA();
    for (const char* name : {"KLOT20220317_000842_V06", "KTLX20170101_030027_V06"}) {
        const auto file = read_file(*testing::data_directory() / "volumes" / name);
        ASSERT_TRUE(file) << file.error().message;
        auto decoded = decode(*file);
        ASSERT_TRUE(decoded) << decoded.error().message;
        const auto encoded = encode(decoded->volume, {.compression_level = 1});
        ASSERT_TRUE(encoded) << encoded.error().message;
        const auto ours = first_radials(encoded->joined());
        const auto theirs = first_radials(*file);
        ASSERT_EQ(theirs.size(), 120) << name;
        EXPECT_TRUE(ours == theirs) << name;
    }
}

}  // namespace
}  // namespace stormcellar::level2
