// Tests that a growing file gives the same volume as the whole file, in whatever pieces it arrives.
#include "stormcellar/level2/growing_volume.h"

#include <algorithm>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>

#include "stormcellar/base/file_system.h"
#include "tests/level2/grow_dropping.h"
#include "tests/level2/same_volume.h"
#include "tests/level2/wire.h"
#include "tests/testing/data.h"

namespace stormcellar::level2 {
namespace {

using wire::Bytes;

// Appends pieces of random length up to `most` bytes.
Result<Decoded> grow(std::span<const std::byte> bytes, std::size_t most, unsigned seed,
                     std::vector<LiveSweep>* sweeps = nullptr) {
    std::mt19937 random{seed};
    GrowingVolume volume;
    for (std::size_t at = 0; at < bytes.size();) {
        const std::size_t length = std::min(bytes.size() - at, 1 + random() % most);
        if (Status taken = volume.append(bytes.subspan(at, length)); !taken) break;
        at += length;
        if (sweeps == nullptr) continue;
        for (LiveSweep& sweep : volume.take_sweeps())
            sweeps->push_back(std::move(sweep));
    }
    return volume.finish();
}

void expect_same(std::span<const std::byte> bytes, std::size_t most, unsigned seed,
                 const std::string& what) {
    const auto whole = decode(bytes);
    const auto grown = grow(bytes, most, seed);
    ASSERT_EQ(grown.has_value(), whole.has_value()) << what;
    if (whole) {
        EXPECT_EQ(difference(*grown, *whole), "") << what;
        const auto dropping = grow_dropping(bytes, most, seed);
        ASSERT_TRUE(dropping) << what;
        EXPECT_EQ(difference(*dropping, *whole), "") << what << ", with sweeps dropped";
    } else {
        EXPECT_EQ(grown.error().code, whole.error().code) << what;
        EXPECT_EQ(grown.error().message, whole.error().message) << what;
    }
}

TEST(GrowingVolume, EveryContainerInPiecesOfAnyLength) {
    const Bytes ldm = wire::ldm_volume(3, 20);
    const Bytes plain = wire::join({wire::archive_header(), wire::radial_messages(2, 30)});
    for (const std::size_t most : {1U, 7U, 100U, 5000U, 1'000'000U}) {
        expect_same(ldm, most, 1, "records");
        expect_same(std::span{ldm}.subspan(24), most, 2, "records without a header");
        expect_same(plain, most, 3, "messages");
        expect_same(wire::gzip(ldm), most, 4, "gzip");
        expect_same(wire::bzip2(plain), most, 5, "bzip2");
        expect_same(Bytes(5000, std::byte{0x41}), most, 6, "nothing known");
    }
}

TEST(GrowingVolume, DamagedRecordsGiveTheSameToo) {
    const Bytes whole = wire::ldm_volume(6, 20);
    std::mt19937 random{7};
    for (unsigned round = 0; round < 200; ++round) {
        Bytes bytes = whole;
        const std::size_t at = random() % bytes.size();
        switch (round % 4) {
            case 0:
                bytes[at] ^= static_cast<std::byte>(1U << (random() % 8));
                break;
            case 1:
                bytes.resize(at);
                break;
            case 2:
                bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                            bytes.begin() + static_cast<std::ptrdiff_t>(
                                                std::min(at + random() % 3000, bytes.size())));
                break;
            default:
                bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), random() % 200,
                             std::byte{0});
        }
        if (!bytes.empty())
            expect_same(bytes, 1 + random() % 4000, round, fmt::format("{}", round));
    }
}

TEST(GrowingVolume, ASweepComesOutWhenItsLastRecordIsThere) {
    const Bytes bytes = wire::ldm_volume(3, 20);
    GrowingVolume volume;
    std::size_t sweeps = 0;
    for (const std::byte b : bytes) {
        ASSERT_TRUE(volume.append(std::span{&b, 1}));
        for (const LiveSweep& sweep : volume.take_sweeps()) {
            EXPECT_EQ(sweep.index, sweeps++);
            EXPECT_TRUE(sweep.whole);
            EXPECT_EQ(sweep.sweep.radials.size(), 20U);
        }
    }
    EXPECT_EQ(sweeps, 3U) << "the last sweep does not wait for the end of the file";
    EXPECT_TRUE(volume.has_ended());
    EXPECT_EQ(volume.facts().station, "KTLX");
}

TEST(GrowingVolume, BeyondTheLimitIsAnErrorThatStays) {
    DecodeOptions options;
    options.output_limit_bytes = 100'000;
    GrowingVolume volume{options};
    const Bytes bytes = wire::ldm_volume(3, 200);
    EXPECT_FALSE(volume.append(bytes));
    EXPECT_FALSE(volume.append(bytes));
    EXPECT_EQ(volume.finish().error().code, ErrorCode::unsupported);
}

TEST(GrowingVolume, ASweepThatIsDroppedHoldsNothing) {
    GrowingVolume volume;
    ASSERT_TRUE(volume.append(wire::ldm_volume(8, 300)));
    ASSERT_EQ(volume.take_sweeps().size(), 8U);
    const std::uint64_t all = volume.held_bytes();
    const std::size_t dropped = volume.droppable_sweeps();
    ASSERT_GE(dropped, 6U);
    for (std::size_t index = 0; index < dropped; ++index)
        volume.drop_sweep(index);
    EXPECT_LT(volume.held_bytes(), all / 3) << all;
}

// The limit matters because a sender can make a large file of zeros at no cost.
TEST(GrowingVolume, WhatHoldsNothingKnownIsHeldNoFurtherThan16MiB) {
    GrowingVolume volume;
    const Bytes text(300, std::byte{'x'}), zeros(std::size_t{1} << 20);
    Status taken = volume.append(text);
    for (int i = 0; i < 40 && taken; ++i)
        taken = volume.append(zeros);
    ASSERT_FALSE(taken);
    EXPECT_EQ(taken.error().code, ErrorCode::not_level2);
    EXPECT_LE(volume.held_bytes(), std::uint64_t{33} << 20)
        << "the array may have room for twice its bytes";
}

// After a damaged start, twenty megabytes of records give the same result as decode().
TEST(GrowingVolume, WhatIsDamagedAtItsStartIsHeldToItsEnd) {
    Bytes bytes(300, std::byte{'x'});
    const Bytes volume = wire::ldm_volume(3, 360);
    bytes.insert(bytes.end(), volume.begin() + 24, volume.end());
    bytes.resize(std::size_t{20} << 20);
    const auto whole = decode(bytes), grown = grow(bytes, 1'000'000, 5);
    ASSERT_TRUE(whole);
    ASSERT_TRUE(grown) << grown.error().message;
    EXPECT_EQ(grown->volume.radial_count(), whole->volume.radial_count());
    EXPECT_EQ(whole->volume.radial_count(), 3U * 360U);
}

TEST(GrowingVolumeReal, RealFilesGrowToTheSame) {
    STORMCELLAR_NEED_DATA();
    for (const char* name : {"KCRP20170826_044114.trimmed.ar2v", "KTLX20170101_030027_V06",
                             "Level2_KLBB_single_chunk", "Level2_TSTL_20220213_2357.ar2v"}) {
        const auto bytes = read_file(*testing::data_directory() / "volumes" / name).value();
        const auto whole = decode(bytes).value();
        std::vector<LiveSweep> sweeps;
        const auto grown = grow(bytes, 100'000, 11, &sweeps).value();
        EXPECT_EQ(difference(grown, whole), "") << name;
        // The sweeps returned while the file grew must equal the sweeps of the final volume.
        for (const LiveSweep& live : sweeps) {
            Volume a, b;
            a.sweeps = {live.sweep};
            b.sweeps = {whole.volume.sweeps.at(live.index)};
            EXPECT_EQ(difference(a, b), "") << name << " " << live.index;
        }
        EXPECT_GE(sweeps.size() + 1, whole.volume.sweeps.size()) << name;
    }
}

}  // namespace
}  // namespace stormcellar::level2
