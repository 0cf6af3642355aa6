#include "bunzip/block_tables.h"

#include <gtest/gtest.h>

#include "tests/bunzip/stream_maker.h"

namespace stormcellar::bunzip {
namespace {

BlockPlan small_plan() {
    BlockPlan block;
    block.bytes = {0, 65, 66, 255};
    block.lengths = {{2, 2, 3, 3, 3, 3}, {1, 2, 3, 4, 5, 5}, {20, 1, 3, 4, 5, 20}};
    block.selectors = {2, 0, 1, 2};
    return block;
}

// The tables begin after the head of the stream (4 bytes), the mark, the checksum and 25 bits.
constexpr std::uint64_t tables_at = 32 + 48 + 32 + 25;

Found read(BlockTables& tables, const BlockPlan& block, std::size_t missing_bits = 0) {
    const Bytes stream = stream_of('9', std::span{&block, 1}, std::nullopt);
    BitReader reader{std::span{stream}.first(stream.size() - missing_bits / 8)};
    reader.skip(tables_at);
    return tables.read(reader);
}

TEST(BlockTables, AreReadAsTheyWereWritten) {
    BlockTables tables;
    ASSERT_EQ(read(tables, small_plan()), Found::good);
    EXPECT_EQ(tables.byte_count, 4U);
    EXPECT_EQ(tables.bytes[1], 65);
    EXPECT_EQ(tables.bytes[3], 255);
    EXPECT_EQ(tables.end_symbol(), 5);
    EXPECT_EQ(tables.code_count, 3U);
    // Through the move-to-front list, the selectors choose code 2 twice, then code 0, and then code
    // 1.
    EXPECT_EQ(tables.selectors, (std::vector<std::uint8_t>{2, 2, 0, 1}));
    EXPECT_EQ(tables.codes[1].decode(std::uint64_t{0b10} << 62).symbol, 1);
    EXPECT_EQ(tables.codes[2].decode(0).symbol, 1);
}

TEST(BlockTables, WhatIsMissingIsCut) {
    const BlockPlan block = small_plan();
    const Bytes stream = stream_of('9', std::span{&block, 1}, std::nullopt);
    BlockTables tables;
    for (std::size_t size = tables_at / 8 + 1; size + 1 < stream.size(); ++size) {
        BitReader reader{std::span{stream}.first(size)};
        reader.skip(tables_at);
        EXPECT_EQ(tables.read(reader), Found::cut) << size;
    }
}

TEST(BlockTables, WhatContradictsIsBad) {
    BlockTables tables;
    BlockPlan nothing = small_plan();
    nothing.bytes.clear();
    EXPECT_EQ(read(tables, nothing), Found::bad);

    BlockPlan one_code = small_plan();
    one_code.lengths.resize(1);
    EXPECT_EQ(read(tables, one_code), Found::bad);

    BlockPlan seven_codes = small_plan();
    seven_codes.lengths.resize(7, seven_codes.lengths.front());
    EXPECT_EQ(read(tables, seven_codes), Found::bad);

    BlockPlan no_selectors = small_plan();
    no_selectors.selectors.clear();
    EXPECT_EQ(read(tables, no_selectors), Found::bad);

    BlockPlan another_code = small_plan();
    another_code.selectors.back() = 3;
    EXPECT_EQ(read(tables, another_code), Found::bad);

    for (const unsigned length : {0U, 21U, 31U}) {
        BlockPlan wrong = small_plan();
        wrong.lengths[1][0] = static_cast<std::uint8_t>(length);
        EXPECT_EQ(read(tables, wrong), Found::bad) << length;
    }
}

// Since version 1.0.7, libbz2 also drops selectors that no block needs.
TEST(BlockTables, SelectorsThatNoBlockNeedsAreDropped) {
    BlockPlan many = small_plan();
    many.selectors.assign(20'000, 0);
    BlockTables tables;
    ASSERT_EQ(read(tables, many), Found::good);
    EXPECT_EQ(tables.selectors.size(), most_groups);
}

}  // namespace
}  // namespace stormcellar::bunzip
