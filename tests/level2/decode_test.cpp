// Tests the whole decoder with containers, damage and limits.
#include "stormcellar/level2/decode.h"

#include <fstream>

#include <gtest/gtest.h>

#include "stormcellar/base/file_system.h"
#include "tests/level2/wire.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::level2 {
namespace {

// The decoder tries each damaged block several times and counts the tries as output. A real volume
// must still stay within the limit.
TEST(DecodeLimits, AVolumeOfWhichNearlyAllIsDamagedStaysWithinThem) {
    STORMCELLAR_NEED_DATA();
    wire::Bytes bytes = *read_file(*testing::data_directory() / "volumes/KLBB20160601_150025_V06");
    std::size_t records = 0;
    for (std::size_t at = 24; at + 4 < bytes.size(); ++records) {
        std::uint32_t word = 0;
        for (std::size_t i = 0; i < 4; ++i)
            word = word << 8U | std::to_integer<std::uint32_t>(bytes[at + i]);
        const auto length = static_cast<std::size_t>(std::abs(static_cast<std::int32_t>(word)));
        if (records >= 2) bytes[at + 4 + length / 2] ^= std::byte{1};
        at += 4 + length;
    }
    EXPECT_GT(records, 40U);
    DecodeOptions options;
    options.output_limit_bytes = std::uint64_t{256} << 20;
    const auto decoded = decode(bytes, options);
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_GT(decoded->report.errors, 40U);
}

// 2026-11-25: 11 kB of records with a wrong checksum took 20 s, because the bytes of failed tries
// did not count.
TEST(DecodeLimits, WhatIsUnpackedInVainCounts) {
    wire::Bytes stream = wire::bzip2(wire::Bytes(45'000'000));
    stream[10] ^= std::byte{1};  // a bit of its checksum
    const wire::Bytes record =
        wire::Writer{}.u32(static_cast<std::uint32_t>(stream.size())).raw(stream).bytes;
    wire::Bytes bytes = wire::ldm_volume(1, 4);
    for (int i = 0; i < 20; ++i)
        bytes.insert(bytes.end(), record.begin(), record.end());
    DecodeOptions options;
    options.output_limit_bytes = std::uint64_t{256} << 20;
    const auto decoded = decode(bytes, options);
    ASSERT_FALSE(decoded);
    EXPECT_EQ(decoded.error().code, ErrorCode::unsupported);
    options.output_limit_bytes = std::uint64_t{2} << 30;
    EXPECT_TRUE(decode(bytes, options)) << "the limit is above what the whole file takes";
}

using wire::Bytes;

ErrorCode code_of(std::span<const std::byte> bytes, const DecodeOptions& options = {}) {
    const auto decoded = decode(bytes, options);
    EXPECT_FALSE(decoded);
    return decoded ? ErrorCode::internal : decoded.error().code;
}

// Expects sweeps with the same numbers of radials and gates, and the same codes.
void expect_same_sweeps(const Volume& a, const Volume& b) {
    ASSERT_EQ(a.sweeps.size(), b.sweeps.size());
    for (std::size_t i = 0; i < a.sweeps.size(); ++i) {
        ASSERT_EQ(a.sweeps[i].radials.size(), b.sweeps[i].radials.size());
        ASSERT_EQ(a.sweeps[i].moments.size(), b.sweeps[i].moments.size());
        for (std::size_t m = 0; m < a.sweeps[i].moments.size(); ++m) {
            EXPECT_EQ(a.sweeps[i].moments[m].gate_counts, b.sweeps[i].moments[m].gate_counts);
            EXPECT_EQ(a.sweeps[i].moments[m].codes8, b.sweeps[i].moments[m].codes8);
            EXPECT_EQ(a.sweeps[i].moments[m].codes16, b.sweeps[i].moments[m].codes16);
        }
    }
}

TEST(Decode, EveryContainerGivesTheSame) {
    const Bytes plain = wire::join({wire::archive_header(), wire::radial_messages(2, 30)});
    const Bytes ldm = wire::ldm_volume(2, 30);
    const auto reference = decode(plain);
    ASSERT_TRUE(reference) << reference.error().message;
    EXPECT_EQ(reference->volume.radial_count(), 60);
    EXPECT_TRUE(reference->report.complete);
    const std::vector<std::pair<std::string, Bytes>> cases = {
        {"uncompressed", plain},
        {"gzip+uncompressed", wire::gzip(plain)},
        {"bzip2-whole-file+uncompressed", wire::bzip2(plain)},
        {"gzip+bzip2-whole-file+uncompressed", wire::gzip(wire::bzip2(plain))},
        {"ldm-bzip2", ldm},
        {"gzip+ldm-bzip2", wire::gzip(ldm)},
        {"bzip2-whole-file+ldm-bzip2", wire::bzip2(ldm)},
        {"uncompressed", Bytes{plain.begin() + 24, plain.end()}},
        {"ldm-bzip2", Bytes{ldm.begin() + 24, ldm.end()}},
    };
    for (const auto& [container, bytes] : cases) {
        const auto decoded = decode(bytes);
        ASSERT_TRUE(decoded) << container << ": " << decoded.error().message;
        EXPECT_EQ(decoded->report.container, container);
        EXPECT_EQ(decoded->report.bytes_dropped, 0) << container;
        expect_same_sweeps(decoded->volume, reference->volume);
    }
}

TEST(Decode, TheStationIsTheHeadersElseTheRadialsElseTheFallback) {
    const Bytes rays = wire::radial_messages(1, 2);
    const Bytes old_rays = wire::join({wire::message_1({}), wire::message_1({})});
    DecodeOptions options;
    options.fallback_station = "KMPX";
    const auto station = [&](const Bytes& header, const Bytes& messages) {
        return decode(wire::join({header, messages}), options).value().volume.station;
    };
    EXPECT_EQ(station(wire::archive_header("AR2V0006.116", "KLOT"), rays), "KLOT");
    EXPECT_EQ(station(wire::archive_header("AR2V0006.116", "klot"), rays), "KLOT");
    EXPECT_EQ(station(wire::archive_header("ARCHIVE2.116", "    "), rays), "KTLX");
    EXPECT_EQ(station(wire::archive_header("AR2V0001.116", "KLOT"), old_rays), "KLOT");
    EXPECT_EQ(station(wire::archive_header("ARCHIVE2.116", "    "), old_rays), "KMPX");
}

TEST(Decode, EmptyUnknownAndEmptyOfMeaningAreToldApart) {
    EXPECT_EQ(code_of({}), ErrorCode::empty);
    EXPECT_EQ(code_of(Bytes(100'000)), ErrorCode::not_level2);
    EXPECT_EQ(code_of(wire::Writer{}.text(std::string(100'000, 'x')).bytes), ErrorCode::not_level2);
    EXPECT_EQ(code_of(wire::gzip(Bytes(100'000))), ErrorCode::not_level2);
    EXPECT_EQ(code_of(wire::archive_header()), ErrorCode::truncated);
    EXPECT_EQ(code_of(wire::join({wire::archive_header(), Bytes(50'000, std::byte{0x33})})),
              ErrorCode::corrupt);
    EXPECT_EQ(code_of(wire::Writer{}.u16(0x1F9D).zeros(100).bytes), ErrorCode::corrupt);
}

// A grid file may contain bytes that look like a message.
TEST(Decode, WhatBeginsAsAnotherFormatIsNotSearchedForMessages) {
    const Bytes volume = wire::ldm_volume(1, 4);
    Bytes bytes = wire::join({wire::Writer{}.text("\x89SCG\r\n\x1A\n").bytes, volume});
    EXPECT_EQ(code_of(bytes), ErrorCode::not_level2);
    bytes[0] = std::byte{'x'};
    EXPECT_TRUE(decode(bytes)) << "the decoder skips a damaged start";
}

TEST(Decode, MetadataAloneIsAVolume) {
    const auto decoded = decode(wire::join({wire::archive_header(), wire::frame(2)}));
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_TRUE(decoded->volume.sweeps.empty());
    EXPECT_FALSE(decoded->report.complete);
    EXPECT_EQ(decoded->report.problems.back().code, "no_radials");
}

TEST(Decode, BombsStopAtTheLimit) {
    DecodeOptions options;
    options.output_limit_bytes = 10'000'000;
    const Bytes zeros(50'000'000);
    const Bytes plain = wire::join({wire::archive_header(), wire::frame(2), zeros});
    EXPECT_EQ(code_of(wire::gzip(plain), options), ErrorCode::unsupported);
    EXPECT_EQ(code_of(wire::bzip2(plain), options), ErrorCode::unsupported);
    EXPECT_EQ(code_of(wire::join({wire::archive_header(), wire::ldm_record(zeros)}), options),
              ErrorCode::unsupported);
    EXPECT_EQ(code_of(wire::gzip(wire::gzip(wire::gzip(wire::gzip(wire::gzip(plain)))))),
              ErrorCode::unsupported)
        << "the file has too many layers";
}

TEST(Decode, ARecordOfAWholeVolumeIsReadBlockByBlock) {
    const Bytes rays = wire::radial_messages(8, 360, 1800);
    ASSERT_GT(rays.size(), 8'000'000);
    const auto decoded = decode(wire::join({wire::archive_header(), wire::ldm_record(rays)}));
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_TRUE(decoded->report.complete);
    expect_same_sweeps(decoded->volume, decode(rays).value().volume);
}

// Wherever a file is cut, the decoder returns the radials of the records before the cut, and
// reports the cut.
TEST(Decode, ACutFileKeepsItsWholeRecords) {
    const Bytes whole = wire::ldm_volume(4, 20);
    for (std::size_t size = 25; size < whole.size(); size += 41) {
        const auto decoded = decode(std::span{whole}.first(size));
        if (!decoded) {
            EXPECT_TRUE(decoded.error().code == ErrorCode::truncated ||
                        decoded.error().code == ErrorCode::corrupt)
                << size << decoded.error().message;
            continue;
        }
        EXPECT_EQ(decoded->volume.radial_count() % 20, 0) << size;
        EXPECT_FALSE(decoded->report.complete) << size;
        EXPECT_FALSE(decoded->report.problems.empty()) << size;
    }
}

TEST(Decode, ADamagedRecordLosesItselfOnly) {
    Bytes damaged = wire::ldm_volume(4, 20);
    const auto whole = decode(damaged).value();
    // The bit is in the middle of the last record, so all other records are unchanged.
    damaged[damaged.size() - 200] ^= std::byte{0x40};
    const auto decoded = decode(damaged);
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_EQ(decoded->volume.sweeps.size(), 3);
    EXPECT_EQ(decoded->volume.radial_count(), 60);
    EXPECT_EQ(decoded->report.problems.at(0).code, "corrupt_record");
    EXPECT_GT(decoded->report.bytes_dropped, 0);
    EXPECT_FALSE(decoded->report.complete);
    EXPECT_EQ(decoded->report.ldm_records, whole.report.ldm_records);
}

TEST(Decode, ABadGzipChecksumIsReportedAndLosesNothing) {
    Bytes packed = wire::gzip(wire::join({wire::archive_header(), wire::radial_messages(1, 9)}));
    packed[packed.size() - 6] ^= std::byte{1};
    const auto decoded = decode(packed);
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded->volume.radial_count(), 9);
    EXPECT_EQ(decoded->report.problems.at(0).code, "gzip_checksum");
    EXPECT_FALSE(decoded->report.complete) << "a volume with an error is not complete";
}

TEST(DecodeFile, ErrorsNameTheFile) {
    const testing::TemporaryDirectory directory;
    const auto expect_named = [&](const std::filesystem::path& path, ErrorCode code) {
        const auto decoded = decode_file(path);
        ASSERT_FALSE(decoded);
        EXPECT_EQ(decoded.error().code, code);
        EXPECT_NE(decoded.error().message.find(path.string()), std::string::npos)
            << decoded.error().message;
    };
    expect_named(directory.path(), ErrorCode::not_a_file);
    expect_named(directory / "absent", ErrorCode::not_found);
    std::ofstream(directory / "empty");
    expect_named(directory / "empty", ErrorCode::empty);
    std::ofstream(directory / "text") << "not radar data";
    expect_named(directory / "text", ErrorCode::not_level2);
}

TEST(DecodeFile, TheNameGivesTheStationWhereTheFileDoesNot) {
    const testing::TemporaryDirectory directory;
    const Bytes bytes =
        wire::join({wire::archive_header("ARCHIVE2.116", "    "), wire::message_1({})});
    for (const auto& [name, station] :
         {std::pair{"KTLX19910720_160529", "KTLX"}, std::pair{"radar-file", ""}}) {
        ASSERT_TRUE(write_file_atomically(real_file_system(), directory / name, bytes));
        EXPECT_EQ(decode_file(directory / name).value().volume.station, station);
    }
}

// Every real volume gives the same result for any number of threads.
TEST(DecodeReal, ThreadsDoNotMatter) {
    STORMCELLAR_NEED_DATA();
    for (const char* name : {"KCRP20170826_044114.trimmed.ar2v", "KDMX20250101_225441_V06",
                             "KTLX20140101_000624.trimmed.ar2v"}) {
        const auto bytes = read_file(*testing::data_directory() / "volumes" / name).value();
        const auto one = decode(bytes).value();
        DecodeOptions options;
        options.threads = 4;
        const auto four = decode(bytes, options).value();
        expect_same_sweeps(one.volume, four.volume);
        EXPECT_EQ(one.report.message_counts, four.report.message_counts);
    }
}

// For a file that has just begun to arrive, the error is truncated, so that the daemon waits for
// the rest.
TEST(Decode, AHeaderAndTheFirstBytesOfARecordAreTruncated) {
    const wire::Bytes volume = wire::ldm_volume(1, 4);
    for (const std::size_t size : {24U, 25U, 30U, 37U, 38U, 45U}) {
        const auto decoded = decode(std::span(volume).first(size));
        ASSERT_FALSE(decoded) << size;
        EXPECT_EQ(decoded.error().code, ErrorCode::truncated) << size;
    }
}

TEST(Decode, AHeaderThatContradictsItsRadialsIsNamed) {
    wire::Bytes volume = wire::ldm_volume(1, 4);
    wire::overwrite_u32(volume, 12, wire::day + 32768);
    const auto decoded = decode(volume).value();
    const auto& problems = decoded.report.problems;
    EXPECT_TRUE(std::any_of(problems.begin(), problems.end(),
                            [](const Problem& problem) { return problem.code == "header_time"; }));
}

}  // namespace
}  // namespace stormcellar::level2
