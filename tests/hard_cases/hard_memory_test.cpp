// Tests that decoding stays below 1 GiB of memory for small files that were made to take much more.
//
// Each file is decoded in a new process, whose peak memory the kernel records (proc(5)).
#include <array>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "stormcellar/level2/growing_volume.h"
#include "stormcellar/level2/live_volume.h"
#include "tests/level2/wire.h"

namespace stormcellar::level2 {
namespace {

using wire::Bytes;

constexpr long most_mib = 1024;

long high_water_mib() {
    std::ifstream status{"/proc/self/status"};
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmHWM:")) return std::stol(line.substr(6)) / 1024;
    }
    return -1;
}

// Returns the peak memory of a process that does the work, or -1 if it crashed.
long peak_mib(const std::function<void()>& work) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) return -1;
    const pid_t child = ::fork();
    if (child == 0) {
        work();
        const std::string text = fmt::format("{}", high_water_mib());
        const bool written = ::write(ends[1], text.data(), text.size()) > 0;
        std::_Exit(written ? 0 : 1);
    }
    ::close(ends[1]);
    std::array<char, 32> text{};
    const ssize_t length = ::read(ends[0], text.data(), text.size());
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    long peak = -1;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && length > 0) {
        std::from_chars(text.data(), text.data() + length, peak);
    }
    return peak;
}

// Under a sanitizer the peak means nothing, because it includes freed memory that the sanitizer
// keeps.
#if defined(STORMCELLAR_SANITIZED)
constexpr bool peak_is_ours = false;
#else
constexpr bool peak_is_ours = true;
#endif

void expect_small(const std::function<void()>& work) {
    if (!peak_is_ours) GTEST_SKIP() << "the sanitizer's own memory is not ours";
    const auto begin = std::chrono::steady_clock::now();
    const long peak = peak_mib(work);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    ::testing::Test::RecordProperty("peak_mib", static_cast<int>(peak));
    fmt::print("peak {} MiB, {:.2f} s\n", peak, took.count());
    EXPECT_GT(peak, 0) << "the process crashed";
    EXPECT_LT(peak, most_mib);
}

// Returns a radial with one moment of `gates` gates, or without moments if `gates` is 0.
Bytes radial(unsigned cut, unsigned status, unsigned gates, float scale = 1) {
    wire::Writer block;
    if (gates != 0) {
        block.text("DREF").u32(0).u16(gates).u16(2125).u16(250).u16(0).u16(0).u8(0).u8(8);
        block.f32(scale).f32(66);
        block.bytes.resize(block.bytes.size() + gates + gates % 2, std::byte{70});
    }
    Bytes message = wire::message_31_with_block(block.bytes);
    message[28 + 21] = static_cast<std::byte>(status);
    message[28 + 22] = static_cast<std::byte>(cut);
    if (gates == 0) wire::overwrite_u32(message, 28 + 32, 0);
    return message;
}

void append(Bytes& to, const Bytes& more) {
    to.insert(to.end(), more.begin(), more.end());
}

// Returns many empty radials between a few long radials of several kinds. Each radial takes a row
// of every kind.
Bytes amplifier(unsigned cut, unsigned kinds, unsigned short_radials, bool begins = true) {
    Bytes messages;
    for (const bool last : {false, true}) {
        for (unsigned kind = 0; kind < kinds; ++kind) {
            const bool first = begins && !last && kind == 0;
            append(messages, radial(cut, first ? 0 : 1, 65'000, 1.0F + static_cast<float>(kind)));
        }
        for (unsigned i = 0; i < short_radials && !last; ++i)
            append(messages, radial(cut, 1, 0));
    }
    return messages;
}

Bytes repeated(const Bytes& part, unsigned times) {
    Bytes all;
    for (unsigned i = 0; i < times; ++i)
        append(all, part);
    return all;
}

Bytes file_of(const Bytes& record, unsigned records) {
    return wire::join({wire::archive_header(), repeated(record, records)});
}

DecodeOptions with_threads(int threads) {
    DecodeOptions options;
    options.threads = threads;
    return options;
}

class MemoryByThreads : public ::testing::TestWithParam<int> {};

TEST_P(MemoryByThreads, RecordsOfLargeArrays) {
    const Bytes file = file_of(wire::ldm_record(amplifier(1, 4, 200)), 24);
    expect_small([&] { (void)decode(file, with_threads(GetParam())); });
}

TEST_P(MemoryByThreads, RecordsOfAsMuchAsASweepMayHold) {
    const Bytes file = file_of(wire::ldm_record(amplifier(1, 1, 1000)), 24);
    expect_small([&] { (void)decode(file, with_threads(GetParam())); });
}

TEST_P(MemoryByThreads, DamagedRecordsOfLargeBlocks) {
    Bytes damaged = wire::bzip2(wire::radial_messages(1, 20));
    damaged[10] ^= std::byte{0xFF};  // the checksum of its block
    Bytes stream = damaged;
    append(stream, wire::bzip2(Bytes(45'900'000)));  // one block
    const Bytes record =
        wire::Writer{}.u32(static_cast<std::uint32_t>(stream.size())).raw(stream).bytes;
    const Bytes file = file_of(record, 8);
    expect_small([&] { (void)decode(file, with_threads(GetParam())); });
}

TEST_P(MemoryByThreads, RecordsJustBelowAShare) {
    const Bytes file = file_of(wire::ldm_record(amplifier(1, 1, 110)), 200);
    expect_small([&] { (void)decode(file, with_threads(GetParam())); });
}

INSTANTIATE_TEST_SUITE_P(Threads, MemoryByThreads, ::testing::Values(1, 2, 4, 32, 1000));

TEST(Memory, OneSweepThatGrowsWithoutEnd) {
    const Bytes first = wire::ldm_record(amplifier(1, 8, 100));
    const Bytes more = wire::ldm_record(amplifier(1, 8, 100, false));
    const Bytes file = wire::join({wire::archive_header(), first, repeated(more, 20)});
    expect_small([&] { (void)decode(file); });
}

TEST(Memory, PlainMessagesThatGrowWithoutEnd) {
    Bytes plain = wire::archive_header();
    for (unsigned i = 0; i < 200; ++i)
        append(plain, amplifier(1 + i % 40, 4, 100));
    const Bytes file = wire::gzip(plain);
    expect_small([&] { (void)decode(file); });
}

// A file of 408 kB took 1504 MiB, because growing arrays were copied and only their contents were
// counted.
TEST(Memory, RadialsOfThirtyThousandGates) {
    const Bytes file = file_of(wire::ldm_record(repeated(radial(1, 1, 30'000), 20)), 520);
    expect_small([&] { (void)decode(file); });
}

TEST(Memory, SweepsOfOneRadial) {
    const Bytes file = file_of(wire::ldm_record(repeated(radial(1, 0, 0), 50'000)), 40);
    expect_small([&] { (void)decode(file); });
}

// Moments of one gate take more memory for their descriptions than for their gates.
TEST(Memory, SweepsOfOneRadialOfOneGate) {
    const Bytes record =
        wire::ldm_record(repeated(wire::message_31({.status = 0, .gates = 1}), 20'000));
    const Bytes file = file_of(record, 30);
    expect_small([&] { (void)decode(file); });
    expect_small([&] {
        LiveVolume live;
        for (int number = 1; number <= 30; ++number)
            (void)live.add(number, ChunkKind::intermediate, record, {});
        (void)live.take_sweeps();
        (void)live.finish();
    });
}

// A radial that is compressed inside its message expands from some 200 bytes to 60 kB.
TEST(Memory, RadialsThatExpandAreCounted) {
    Bytes large = radial(1, 1, 1);
    large.resize(60'000);
    wire::overwrite_u16(large, 28 + 18, static_cast<unsigned>(large.size()) - 28);
    const Bytes small = wire::compressed_message_31(large, 2);
    ASSERT_LT(small.size(), 250U);
    ASSERT_TRUE(decode(wire::join({wire::archive_header(), small})));
    Bytes messages;
    for (unsigned i = 0; i < 5000; ++i)
        append(messages, small);
    const auto decoded = decode(file_of(wire::ldm_record(messages), 4));
    ASSERT_FALSE(decoded) << "the radials expand to 4 times 5000 times 60 kB";
    EXPECT_NE(decoded.error().message.find("decompresses to more"), std::string::npos);
}

TEST(Memory, BytesThatAreNoRecordsAreNotHeldWithoutEnd) {
    GrowingVolume growing;
    ASSERT_TRUE(growing.append(wire::ldm_volume(1, 20)));
    const Bytes noise(std::size_t{1} << 20, std::byte{0x5A});
    int taken = 0;
    while (taken < 200 && growing.append(noise))
        ++taken;
    EXPECT_GT(taken, 30);
    EXPECT_LT(taken, 36);
    EXPECT_EQ(growing.finish().error().code, ErrorCode::unsupported);
}

// Each lower cut begins another volume, and each volume has a copy of the pattern.
TEST(Memory, VolumesOfOneRadial) {
    Bytes messages;
    for (unsigned i = 0; i < 1000; ++i) {
        append(messages, radial(2, 0, 0));
        append(messages, radial(1, 0, 0));
    }
    const std::vector<float> elevations_deg(51, 0.5F);
    const Bytes pattern = wire::ldm_record(wire::vcp_frame(212, elevations_deg));
    Bytes file = wire::join({wire::archive_header(), pattern});
    const Bytes record = wire::ldm_record(messages);
    for (int i = 0; i < 300; ++i)
        append(file, record);
    expect_small([&] { (void)decode(file); });
}

TEST(Memory, PatternsWithoutRadials) {
    const std::vector<float> elevations_deg(51, 0.5F);
    Bytes messages;
    for (unsigned i = 0; i < 4000; ++i)
        append(messages, wire::vcp_frame(212, elevations_deg));
    const Bytes file = file_of(wire::ldm_record(messages), 10);
    expect_small([&] { (void)decode(file); });
}

TEST(Memory, AKindOfAMomentForEachRadial) {
    Bytes messages;
    for (unsigned i = 0; i < 3000; ++i)
        append(messages, radial(1, i == 0 ? 0 : 1, 20'000, 1.0F + static_cast<float>(i)));
    const Bytes file = file_of(wire::ldm_record(messages), 4);
    expect_small([&] { (void)decode(file); });
}

TEST(Memory, CompressedInCompressed) {
    Bytes inner = wire::ldm_record(amplifier(1, 4, 200));
    Bytes padded = file_of(inner, 24);
    padded.resize(60U << 20);
    const Bytes file = wire::bzip2(wire::gzip(wire::gzip(padded)));
    expect_small([&] { (void)decode(file); });
}

TEST(Memory, RecordsOfNextToNothing) {
    // A record has only a control word and the first bytes of a stream.
    const Bytes record =
        wire::Writer{}.u32(10).text("BZh9").u16(0x3141).u16(0x5926).u16(0x5359).bytes;
    const Bytes file = file_of(record, 2'000'000);
    DecodeOptions options;
    expect_small([&] { (void)decode(file, options); });
    options.selection.elevation_numbers = {1};
    expect_small([&] { (void)decode(file, options); });
    expect_small([&] { (void)LiveVolume{}.add(1, ChunkKind::start, file, {}); });
    expect_small([&] {
        GrowingVolume growing;
        (void)growing.append(file);
        (void)growing.finish();
    });
}

TEST(Memory, ChunksOfLargeArrays) {
    const Bytes chunk = file_of(wire::ldm_record(amplifier(1, 1, 900)), 6);
    expect_small([&] {
        LiveVolume live;
        for (int number = 1; number <= 12; ++number) {
            (void)live.add(number, ChunkKind::intermediate, chunk, {});
            (void)live.take_sweeps();
        }
        (void)live.finish();
    });
}

// The chunk has records of one radial with two moments of one gate; each record becomes a fragment.
TEST(Memory, ChunksOfRecordsOfOneRadialHoldWhatTheyMay) {
    const Bytes chunk = file_of(wire::ldm_record(wire::message_31({.gates = 1})), 1000);
    const auto fill = [&](std::uint64_t limit_bytes) {
        LiveOptions options;
        options.decode.output_limit_bytes = limit_bytes;
        LiveVolume live{options};
        for (int number = 1; number <= 30; ++number)
            (void)live.add(number, ChunkKind::intermediate, chunk, {});
    };
    constexpr std::uint64_t limit_mib = 32;
    if (!peak_is_ours) {
        fill(limit_mib << 20);
        GTEST_SKIP() << "the chunks are added; the sanitizer's own memory is not ours";
    }
    const long empty = peak_mib([&] { fill(1); });
    const long full = peak_mib([&] { fill(limit_mib << 20); });
    ASSERT_GT(empty, 0);
    EXPECT_LT(full - empty, static_cast<long>(limit_mib));
}

TEST(Memory, SweepsThatAreHandedOutAreFew) {
    Bytes messages;
    for (unsigned cut = 1; cut <= 20; ++cut)
        append(messages, amplifier(cut, 1, 300));
    const Bytes file = file_of(wire::ldm_record(messages), 1);
    expect_small([&] {
        GrowingVolume growing;
        (void)growing.append(file);
        while (!growing.take_sweeps().empty()) {
        }
        (void)growing.finish();
    });
}

// Each record ends the same sweep again. The test measures no memory; it took 32 s when the sweep
// was copied each time.
TEST(Memory, ASweepThatEndsWithEachRecord) {
    GrowingVolume growing;
    ASSERT_TRUE(growing.append(
        wire::join({wire::archive_header(), wire::ldm_record(radial(1, 0, 30'000))})));
    const Bytes record = wire::ldm_record(radial(1, 2, 30'000));
    std::size_t handed_out = 0;
    for (int i = 0; i < 1000; ++i) {
        ASSERT_TRUE(growing.append(record));
        handed_out += growing.take_sweeps().size();
    }
    EXPECT_GT(handed_out, 10U);
    EXPECT_LT(handed_out, 40U);
    EXPECT_EQ(growing.finish()->volume.radial_count(), 1001U);
}

}  // namespace
}  // namespace stormcellar::level2
