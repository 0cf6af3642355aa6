// Compares bunzip with libbz2 on streams that compressors rarely or never write. The bytes and the
// kind of end must be the same.
#include <algorithm>
#include <random>

#include "bunzip/bunzip.h"
#include "bunzip/bzip2_format.h"
#include "tests/bunzip/each_path.h"
#include "tests/bunzip/stream_maker.h"
#include "tests/testing/noise.h"

namespace stormcellar::bunzip {
namespace {

using stormcellar::testing::noise;

using End = LibraryOutcome::Status;
constexpr std::size_t most = std::size_t{16} << 20;

class OddStreams : public ::testing::TestWithParam<Path> {
  protected:
    // Compares the results of bunzip and libbz2. Returns how the stream ends according to libbz2,
    // so that a test can state the expected end.
    End check(const Bytes& stream, std::size_t limit = most) {
        const LibraryOutcome wanted = decompressed(stream, limit);
        std::vector<std::byte> out;
        const Outcome outcome = decompress(stream, out, limit, workspace_, GetParam());
        EXPECT_EQ(static_cast<int>(outcome.status), static_cast<int>(wanted.status));
        if (wanted.status == End::whole) {
            EXPECT_EQ(outcome.output_bytes, wanted.bytes.size());
            EXPECT_EQ(outcome.input_bytes, wanted.input_bytes);
        }
        const std::size_t both = std::min(outcome.output_bytes, wanted.bytes.size());
        EXPECT_TRUE(std::equal(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(both),
                               wanted.bytes.begin()));
        return wanted.status;
    }
    Workspace workspace_;
};
INSTANTIATE_TEST_SUITE_P(EachPath, OddStreams, ::testing::ValuesIn(available_kernels()), test_name);

TEST_P(OddStreams, AllLevelsAndBlockEnds) {
    for (const int level : {1, 2, 5, 9}) {
        const auto block = static_cast<std::size_t>(level) * 100'000;
        // bzip2 leaves 19 bytes of a block unused.
        for (const std::size_t size : {block - 20, block - 19, block - 18, block, 2 * block + 7}) {
            EXPECT_EQ(check(compressed(noise(size, 200, 1), level)), End::whole) << size;
        }
    }
}

TEST_P(OddStreams, ContentsOfAllKinds) {
    EXPECT_EQ(check(compressed({}, 9)), End::whole);
    for (std::size_t size = 1; size < 40; ++size)
        EXPECT_EQ(check(compressed(noise(size, 3, 2), 1)), End::whole) << size;
    for (const unsigned kinds : {1U, 2U, 17U, 64U, 65U, 129U, 193U, 256U})
        EXPECT_EQ(check(compressed(noise(250'000, kinds, kinds), 9)), End::whole) << kinds;
    // Repeated pieces have equal rotations, and their links form many rings.
    for (const std::size_t period : {1U, 2U, 3U, 5U, 64U, 100U, 2432U, 50'000U}) {
        const Bytes piece = noise(period, 251, 3);
        Bytes bytes;
        while (bytes.size() < 400'000)
            bytes.insert(bytes.end(), piece.begin(), piece.end());
        EXPECT_EQ(check(compressed(bytes, 4)), End::whole) << period;
    }
    // Runs of every length that a count can express, and longer runs.
    Bytes runs;
    for (std::size_t length = 1; length < 700; ++length)
        runs.insert(runs.end(), length, static_cast<std::byte>(length % 5));
    EXPECT_EQ(check(compressed(runs, 9)), End::whole);
    EXPECT_EQ(check(compressed(Bytes(9'000'000), 1)), End::whole);
}

BlockPlan plan(std::vector<std::uint8_t> bytes, std::vector<std::uint8_t> lengths,
               std::vector<std::uint16_t> symbols) {
    BlockPlan block;
    block.bytes = std::move(bytes);
    block.lengths = {lengths, lengths};
    block.selectors.assign(symbols.size() / 50 + 1, 0);
    block.symbols = std::move(symbols);
    return block;
}

TEST_P(OddStreams, LongestWords) {
    std::vector<std::uint8_t> bytes(40), lengths(42, 20);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<std::uint8_t>(6 * i);
    for (std::size_t i = 0; i < 19; ++i)
        lengths[i] = static_cast<std::uint8_t>(i + 1);
    lengths[41] = 3;
    std::mt19937 random(4);
    std::vector<std::uint16_t> symbols;
    for (int i = 0; i < 30'000; ++i) {
        const auto symbol = static_cast<std::uint16_t>(random() % 41);
        symbols.push_back(symbol <= run_b && random() % 8 != 0 ? std::uint16_t{2} : symbol);
    }
    symbols.push_back(41);
    // Words that do not fit into 20 bits are cut, so the result may be anything.
    static_cast<void>(check(mended_stream('9', plan(bytes, lengths, symbols))));

    // This complete code has words of up to 20 bits.
    std::vector<std::uint8_t> proper(21);
    for (std::size_t i = 0; i < 20; ++i)
        proper[i] = static_cast<std::uint8_t>(20 - i);
    proper[20] = 20;
    std::vector<std::uint16_t> long_words;
    for (int i = 0; i < 20'000; ++i)
        long_words.push_back(static_cast<std::uint16_t>(2 + random() % 5));
    long_words.push_back(20);
    BlockPlan block =
        plan(std::vector<std::uint8_t>(bytes.begin(), bytes.begin() + 19), proper, long_words);
    block.origin = 12'345;
    EXPECT_EQ(check(mended_stream('9', block)), End::whole);
}

// Returns a block in which one byte occurs `rows` times. The symbols are `rows` written with the
// digits 1 and 2.
BlockPlan run_of(std::size_t rows) {
    std::vector<std::uint16_t> digits;
    for (std::size_t left = rows; left > 0; left = (left - 1) / 2)
        digits.push_back(left % 2 == 1 ? run_a : run_b);
    digits.push_back(2);
    return plan({4}, {1, 2, 2}, digits);
}

// In a block of equal bytes, every fifth byte is a count, and a block that ends before a count is
// corrupt.
TEST_P(OddStreams, RunsUpToABlockAndAboveIt) {
    for (const std::size_t rows : {1U, 3U, 4U, 5U, 8U, 9U, 10U, 99'999U, 100'000U, 100'001U}) {
        const End end = check(mended_stream('1', run_of(rows)));
        EXPECT_EQ(end, rows % 5 == 4 || rows > 100'000 ? End::corrupt : End::whole) << rows;
    }
    for (std::size_t digits = 10; digits <= 24; ++digits) {
        const std::size_t rows = (std::size_t{1} << digits) - 1;
        const End end = check(mended_stream('9', run_of(rows)));
        EXPECT_EQ(end, rows % 5 == 4 || rows > 900'000 ? End::corrupt : End::whole) << rows;
    }
}

TEST_P(OddStreams, SelectorsThatRunOutOrAreTooMany) {
    std::vector<std::uint16_t> symbols(120, 2);
    for (std::size_t i = 0; i < symbols.size(); i += 2)
        symbols[i] = 3;
    symbols.push_back(4);
    BlockPlan block = plan({7, 9, 200}, {2, 2, 2, 3, 3}, symbols);
    ASSERT_EQ(block.selectors.size(), 3U);
    block.origin = 5;
    EXPECT_EQ(check(mended_stream('9', block)), End::whole);
    block.selectors.pop_back();
    EXPECT_EQ(check(mended_stream('9', block)), End::corrupt);
    block.selectors.assign(18'002, 0);
    EXPECT_EQ(check(mended_stream('9', block)), End::whole);
    block.selectors.assign(18'003, 1);
    EXPECT_EQ(check(mended_stream('9', block)), End::whole);
    block.selectors.assign(32'767, 0);
    EXPECT_EQ(check(mended_stream('9', block)), End::whole);
}

TEST_P(OddStreams, Origins) {
    std::vector<std::uint16_t> symbols(30, 2);
    symbols.push_back(3);
    BlockPlan block = plan({1, 2}, {1, 2, 3, 3}, symbols);
    for (const std::uint32_t origin :
         {0U, 1U, 29U, 30U, 31U, 100'009U, 100'010U, 100'011U, 0xFFFFFFU}) {
        block.origin = origin;
        EXPECT_EQ(check(mended_stream('1', block)) == End::corrupt, origin >= 30) << origin;
    }
    // The block has only the end symbol, so it has no row and no valid origin.
    block.symbols = {3};
    block.origin = 0;
    EXPECT_EQ(check(mended_stream('1', block)), End::corrupt);
}

TEST_P(OddStreams, RandomisedBlocksAreLibbz2s) {
    std::vector<std::uint16_t> symbols;
    std::mt19937 random(5);
    for (int i = 0; i < 20'000; ++i)
        symbols.push_back(static_cast<std::uint16_t>(2 + random() % 9));
    symbols.push_back(11);
    BlockPlan block =
        plan({0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, std::vector<std::uint8_t>(12, 4), symbols);
    block.randomised = true;
    block.origin = 17;
    EXPECT_EQ(check(mended_stream('9', block)), End::whole);

    // The stream has two blocks with the same symbols: a plain block, and then a randomised block.
    BlockPlan first = block;
    first.randomised = false;
    BlockPlan blocks[] = {first, block};
    for (BlockPlan& one : blocks) {
        const Bytes alone = stream_of('9', std::span{&one, 1}, 0);
        one.checksum = slow_checksum(decompressed(alone, most).bytes);
    }
    const std::uint32_t end =
        (blocks[0].checksum << 1 | blocks[0].checksum >> 31) ^ blocks[1].checksum;
    EXPECT_EQ(check(stream_of('9', blocks, end)), End::whole);
    EXPECT_EQ(check(stream_of('9', blocks, end + 1)), End::corrupt);
}

// 2026-11-23: if a move made a block one byte too long, only the next symbol showed this error. A
// stream that was cut before that symbol was reported as cut instead of corrupt.
TEST_P(OddStreams, ABlockIsTooLongWithTheByteOfAMove) {
    for (const bool is_full : {false, true}) {
        // The symbols are the digits of 100,000 or 99,999 bytes, then a move, and the end.
        std::vector<std::uint16_t> symbols;
        for (unsigned left = is_full ? 100'000 : 99'999; left > 0;) {
            const unsigned digit = left % 2 == 1 ? 1 : 2;
            symbols.push_back(static_cast<std::uint16_t>(digit - 1));
            left = (left - digit) / 2;
        }
        symbols.insert(symbols.end(), {2, 3});
        const Bytes stream = mended_stream('1', plan({4, 5}, {2, 2, 2, 2}, symbols));
        int corrupt = 0;
        for (std::size_t size = 20; size <= stream.size(); ++size) {
            const Bytes cut(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size));
            corrupt += check(cut) == End::corrupt ? 1 : 0;
        }
        EXPECT_EQ(corrupt > 0, is_full);
    }
}

// If the last byte of a block fills the buffer, the bytes after the block are still checked, as in
// libbz2.
TEST_P(OddStreams, WhatIsBehindTheLimitsLastByte) {
    const BlockPlan sound = plan({0, 1, 2, 3}, std::vector<std::uint8_t>(6, 3), {2, 3, 2, 3, 5});
    const Bytes alone = mended_stream('9', sound);
    const std::size_t limit = decompressed(alone, most).bytes.size();
    BlockPlan first = sound;
    first.checksum = slow_checksum(decompressed(alone, most).bytes);
    std::vector<BlockPlan> next(6, first);
    next[1].checksum += 1;
    next[2].origin = 100;
    next[3].randomised = true;
    next[4].randomised = true;
    next[4].origin = 100;
    next[5].randomised = true;
    next[5].symbols = {2, 3};
    for (std::size_t k = 0; k < next.size(); ++k) {
        SCOPED_TRACE(k);
        const BlockPlan blocks[] = {first, next[k]};
        const Bytes stream = stream_of('9', blocks, 0);
        const End end = check(stream, limit);
        EXPECT_EQ(end, k == 2 || k == 4 ? End::corrupt : End::too_large);
        for (const std::size_t more : {1U, 2U, 3U, 4U, 5U})
            check(stream, limit + more);
        for (std::size_t size = alone.size() - 10; size < stream.size(); ++size)
            check(Bytes(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size)), limit);
    }
    EXPECT_EQ(check(stream_of('9', {&first, 1}, first.checksum), limit), End::whole);
    EXPECT_EQ(check(stream_of('9', {&first, 1}, first.checksum + 1), limit), End::corrupt);
}

TEST_P(OddStreams, EveryCut) {
    const Bytes stream = compressed(noise(3000, 9, 6), 1);
    for (std::size_t size = 0; size < stream.size(); ++size) {
        EXPECT_EQ(check(Bytes(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size))),
                  End::truncated)
            << size;
    }
}

TEST_P(OddStreams, EveryChangedBit) {
    const Bytes stream = compressed(noise(400, 20, 7), 1);
    int corrupt = 0;
    for (std::size_t bit = 0; bit < stream.size() * 8; ++bit) {
        Bytes changed = stream;
        changed[bit / 8] ^= std::byte{0x80} >> (bit % 8);
        corrupt += check(changed) == End::corrupt ? 1 : 0;
        if (HasFailure()) FAIL() << "bit " << bit;
    }
    EXPECT_GT(corrupt, static_cast<int>(stream.size()) * 7);
}

TEST_P(OddStreams, WhateverComesOfAnyChoices) {
    std::mt19937 random(8);
    int whole = 0;
    for (int round = 0; round < 500; ++round) {
        Bytes choices(1 + random() % 1200);
        for (std::byte& byte : choices)
            byte = static_cast<std::byte>(random());
        choices[0] = static_cast<std::byte>(round);
        whole += check(stream_from(choices), std::size_t{1} << 20) == End::whole ? 1 : 0;
        if (HasFailure()) FAIL() << "round " << round;
    }
    EXPECT_GT(whole, 100);
}

}  // namespace
}  // namespace stormcellar::bunzip
