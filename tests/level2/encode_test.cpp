#include "level2/encode.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include <gtest/gtest.h>

#include "base/byte_reader.h"
#include "base/file_system.h"
#include "level2/decode.h"
#include "level2/live_volume.h"
#include "tests/level2/same_volume.h"
#include "tests/level2/wire.h"
#include "tests/testing/data.h"

namespace stormcellar::level2 {
namespace {

using wire::Bytes;

SweepMoment moment_of(Moment name, std::size_t radials, std::int32_t gates, int bits) {
    SweepMoment moment;
    moment.moment = name;
    moment.first_gate_m = 2125;
    moment.gate_spacing_m = 250;
    moment.gate_stride = gates;
    moment.word_size_bits = bits;
    moment.scale = 2;
    moment.offset = 66;
    moment.snr_threshold_db = 2;
    moment.folding_threshold_db = 5;
    moment.gate_counts.assign(radials, static_cast<std::uint16_t>(gates));
    const std::size_t codes = radials * static_cast<std::size_t>(gates);
    for (std::size_t i = 0; i < codes; ++i) {
        if (bits == 8) {
            moment.codes8.push_back(static_cast<std::uint8_t>(i * 7 % 256));
        } else {
            moment.codes16.push_back(static_cast<std::uint16_t>(i * 77 % 65536));
        }
    }
    return moment;
}

Radial radial_of(std::size_t index, std::size_t count, bool first_sweep, bool last_sweep) {
    Radial radial;
    radial.time = time_from_nexrad(19069, 86'399'900) + std::chrono::milliseconds(30 * index);
    radial.azimuth_deg = static_cast<float>(index) + 0.25F;
    radial.elevation_deg = -0.25F;
    radial.nyquist_mps = 28.34F;
    radial.unambiguous_range_m = 137000;
    radial.calibration_dbz = -42.9F;
    radial.horizontal_noise_dbm = -81.5F;
    radial.vertical_noise_dbm = -81.25F;
    radial.vertical_calibration_dbz = -42.5F;
    radial.azimuth_number = static_cast<std::uint16_t>(index + 1);
    radial.status = 1;
    if (index == 0) radial.status = first_sweep ? 3 : 0;
    if (index + 1 == count) radial.status = last_sweep ? 4 : 2;
    radial.cut_sector = 1;
    radial.spot_blanking = 2;
    radial.azimuth_indexing = 25;
    radial.radial_flags = 5;
    radial.attenuation_db_per_km_thousandths = std::int16_t{-12};
    radial.elevation_calibration_db = -43.0F;
    return radial;
}

VcpCut cut_of(float elevation_deg) {
    VcpCut cut;
    cut.elevation_deg = elevation_deg;
    cut.channel_configuration = 2;
    cut.waveform = 1;
    cut.super_resolution = 11;
    cut.surveillance_prf = 1;
    cut.surveillance_pulses = 15;
    cut.azimuth_rate_code = -15400;
    cut.supplemental = 0x35;
    cut.thresholds_eighth_db = {16, -16, 28, 1, 2, 3};
    for (std::size_t i = 0; i < cut.rest.size(); ++i)
        cut.rest[i] = static_cast<std::uint8_t>(i + 1);
    return cut;
}

// Two sweeps that use every field of the model that message 31 has.
Volume example_volume() {
    Volume volume;
    volume.header = VolumeHeader{"AR2V0006.116", 19070, 900, "KLOT"};
    volume.station = "KLOT";
    volume.block = VolumeBlock{};
    volume.block->size_bytes = 52;
    volume.block->version_major = 3;
    volume.block->latitude_deg = 41.6F;
    volume.block->longitude_deg = -88.08F;
    volume.block->site_height_m = -20;
    volume.block->tower_height_m = 29;
    volume.block->vcp = 212;
    volume.block->rest = {1, 2, 3, 4, 5, 6, 7, 8};
    volume.vcp_message = Vcp{};
    volume.vcp_message->pattern_number = 212;
    volume.vcp_message->version = 1;
    volume.vcp_message->doppler_resolution = 2;
    volume.vcp_message->pulse_width = 2;
    volume.vcp_message->sequencing = 7;
    volume.vcp_message->supplemental = 0x70;
    volume.vcp_message->cuts = {cut_of(0.483398438F), cut_of(static_cast<float>(-180.0 / 32768))};
    volume.vcp = 212;
    volume.vcp_source = VcpSource::message_5;
    for (const int number : {1, 2}) {
        Sweep sweep;
        sweep.elevation_number = number;
        sweep.azimuth_spacing_deg = number == 1 ? 0.5F : 1.0F;
        sweep.vcp_elevation_deg =
            volume.vcp_message->cuts[static_cast<std::size_t>(number - 1)].elevation_deg;
        const std::size_t count = 130;
        for (std::size_t i = 0; i < count; ++i)
            sweep.radials.push_back(radial_of(i, count, number == 1, number == 2));
        sweep.moments.push_back(moment_of(Moment::ref, count, 101, 8));
        sweep.moments.push_back(moment_of(Moment::sw, count, 33, 8));
        sweep.moments.push_back(moment_of(Moment::phi, count, 40, 16));
        volume.sweeps.push_back(sweep);
    }
    return volume;
}

void expect_round_trip(const Volume& volume) {
    const auto encoded = encode(volume);
    ASSERT_TRUE(encoded) << encoded.error().message;
    const auto decoded = decode(encoded->joined());
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_EQ(difference(volume, decoded->volume), "");
    EXPECT_EQ(decoded->report.bytes_dropped, 0);
    EXPECT_EQ(decoded->report.complete, !volume.sweeps.empty());
}

ErrorCode refusal(const Volume& volume, const EncodeOptions& options = {}) {
    const auto encoded = encode(volume, options);
    EXPECT_FALSE(encoded);
    return encoded ? ErrorCode::internal : encoded.error().code;
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
        radial.vertical_noise_dbm.reset();  // unknown inside a block that is there
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

// ICD 2620010 section 7.3.4: records of 120 radials, none of two sweeps, the last one's length
// negative; the metadata record is 134 frames with message 5 and 2 in the last two.
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

TEST(Encode, RefusesWhatMessage31CannotHold) {
    const Volume good = example_volume();
    ASSERT_TRUE(encode(good));
    std::vector<std::pair<std::string, std::function<void(Volume&)>>> cases = {
        {"nothing", [](Volume& v) { v = Volume{}; }},
        {"no station", [](Volume& v) { v.station.clear(); }},
        {"no block", [](Volume& v) { v.block.reset(); }},
        {"block of another size", [](Volume& v) { v.block->rest.pop_back(); }},
        {"long name", [](Volume& v) { v.header->filename = "AR2V0006.1160"; }},
        {"header site", [](Volume& v) { v.header->icao = "KLO"; }},
        {"message 1 of another kind", [](Volume& v) { v.sweeps[1].message_type = 1; }},
        {"message 3", [](Volume& v) { v.sweeps[1].message_type = 3; }},
        {"number", [](Volume& v) { v.sweeps[1].elevation_number = 256; }},
        {"spacing", [](Volume& v) { v.sweeps[1].azimuth_spacing_deg = 0.75F; }},
        {"Nyquist", [](Volume& v) { v.sweeps[1].radials[5].nyquist_mps = 700; }},
        {"NaN", [](Volume& v) { v.sweeps[1].radials[5].nyquist_mps = std::nanf(""); }},
        {"radial of 2150",
         [](Volume& v) { v.sweeps[1].radials[5].time = time_from_nexrad(65536, 0); }},
        {"word", [](Volume& v) { v.sweeps[1].moments[0].word_size_bits = 12; }},
        {"rows", [](Volume& v) { v.sweeps[1].moments[0].gate_counts.pop_back(); }},
        {"codes", [](Volume& v) { v.sweeps[1].moments[0].codes8.pop_back(); }},
        {"gates", [](Volume& v) { v.sweeps[1].moments[0].gate_counts[0] = 102; }},
        {"first gate", [](Volume& v) { v.sweeps[1].moments[0].first_gate_m = 40000; }},
        {"flags", [](Volume& v) { v.sweeps[1].moments[0].control_flags = -1; }},
        {"too long",
         [](Volume& v) {
             v.sweeps[1].moments[0] = moment_of(Moment::ref, v.sweeps[1].radials.size(), 65400, 8);
         }},
        {"cuts", [](Volume& v) { v.vcp_message->cuts.resize(52); }},
        {"VCP message", [](Volume& v) { v.vcp_message->message_type = 8; }},
    };
    for (const auto& [name, spoil] : cases) {
        Volume bad = good;
        spoil(bad);
        EXPECT_EQ(refusal(bad), ErrorCode::bad_argument) << name;
    }
    EXPECT_EQ(refusal(good, {.compression_level = 0}), ErrorCode::bad_argument);
    EXPECT_EQ(refusal(good, {.radials_per_record = 0}), ErrorCode::bad_argument);
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

    LiveOptions live_options;
    live_options.decode = options;
    LiveVolume live{live_options};
    for (const EncodedChunk& chunk : encoded->chunks())
        EXPECT_TRUE(live.add(chunk.name.number, chunk.name.kind, chunk.bytes, {}));
    EXPECT_TRUE(live.is_whole());
    EXPECT_EQ(difference(live.finish().value(), *again), "");
}

// Message 31: super-resolution with every moment, TDWR, trimmed, few radials, recombined.
// Message 1: of 1991, 1999, damaged, four volumes in a file, 1 m/s, gates that vary in a sweep.
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

// The bodies of message 31 that follow the first metadata record of a file, without the headers.
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

// An open RDA's own message 31 and ours, byte by byte.
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
