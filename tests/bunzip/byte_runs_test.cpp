#include "bunzip/byte_runs.h"

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "tests/bunzip/each_path.h"

namespace stormcellar::bunzip {
namespace {

using Symbols = std::vector<std::uint16_t>;

// Writes the last column of the sorted rotations byte by byte, as the format describes it.
std::vector<std::uint8_t> slowly(const Symbols& symbols, std::vector<std::uint8_t> list) {
    std::vector<std::uint8_t> column;
    std::size_t unit = 1;
    for (const std::uint16_t symbol : symbols) {
        if (symbol <= run_b) {
            column.insert(column.end(), unit * (symbol + 1U), list.front());
            unit *= 2;
            continue;
        }
        unit = 1;
        const auto found = list.begin() + (symbol - 1);
        std::rotate(list.begin(), found, found + 1);
        column.push_back(list.front());
    }
    return column;
}

constexpr std::uint64_t bad_above = std::uint64_t{1} << 60;

class ByteRunsOf : public ::testing::TestWithParam<Path> {
  protected:
    std::vector<ByteRun> runs(const Symbols& symbols, std::size_t batch) {
        std::vector<ByteRun> made(symbols.size() + 1);
        std::size_t count = 0;
        for (std::size_t at = 0; at < symbols.size(); at += batch) {
            const auto part = std::span{symbols}.subspan(at, std::min(batch, symbols.size() - at));
            count += make_runs_by(GetParam())(maker_, part, made.data() + count);
        }
        if (maker_.bytes < bad_above) made[count++] = last_run(maker_);
        made.resize(count);
        return made;
    }
    void begin(std::size_t bytes) {
        std::vector<std::uint8_t> list(bytes);
        std::iota(list.begin(), list.end(), static_cast<std::uint8_t>(3));
        maker_.begin(list);
        list_ = list;
    }
    RunMaker maker_;
    std::vector<std::uint8_t> list_;
};
INSTANTIATE_TEST_SUITE_P(EachPath, ByteRunsOf, ::testing::ValuesIn(available_kernels()), test_name);

TEST_P(ByteRunsOf, AnySymbolsInAnyBatches) {
    std::mt19937 random(6);
    for (int round = 0; round < 300; ++round) {
        const unsigned bytes = round % 5 == 0 ? 256U : 2 + static_cast<unsigned>(random() % 255);
        Symbols symbols(random() % 1500);
        for (std::uint16_t& symbol : symbols) {
            const unsigned most = random() % 4 == 0 ? bytes + 1 : std::min(bytes + 1, 18U);
            symbol = static_cast<std::uint16_t>(random() % most);
        }
        // Break long rows of digits, because the run that they give would soon be longer than
        // memory.
        for (std::size_t i = 0, digits = 0; i < symbols.size(); ++i) {
            digits = symbols[i] <= run_b ? digits + 1 : 0;
            if (digits > 9) symbols[i] = std::uint16_t{2};
        }
        begin(bytes);
        const auto wanted = slowly(symbols, list_);
        const auto made = runs(symbols, 1 + random() % 1200);
        std::vector<std::uint8_t> column;
        std::array<std::uint32_t, 256> count{};
        for (const ByteRun run : made) {
            column.insert(column.end(), run.length(), run.byte());
            count[run.byte()] += run.length();
        }
        ASSERT_EQ(column, wanted) << round;
        EXPECT_EQ(maker_.bytes, wanted.size());
        EXPECT_EQ(maker_.count, count);
    }
}

TEST_P(ByteRunsOf, EachPlaceOfTheList) {
    begin(256);
    Symbols symbols;
    for (std::uint16_t symbol = 2; symbol <= 256; ++symbol) {
        symbols.push_back(symbol);
        symbols.push_back(static_cast<std::uint16_t>(258 - symbol));
    }
    const auto wanted = slowly(symbols, list_);
    const auto made = runs(symbols, 1000);
    std::vector<std::uint8_t> column;
    for (const ByteRun run : made)
        column.insert(column.end(), run.length(), run.byte());
    EXPECT_EQ(column, wanted);
}

TEST_P(ByteRunsOf, ARunHas21DigitsAtMost) {
    for (const std::size_t before : {0, 1, 40, 50, 63, 64, 100}) {
        for (const std::size_t digits : {20, 21, 22, 23, 64, 130}) {
            Symbols symbols(before, 2);
            symbols.insert(symbols.end(), digits, run_b);
            begin(5);
            static_cast<void>(runs(symbols, 1000));
            // each move adds a byte, and the digits add 2^(digits + 1) - 2 bytes
            if (digits <= most_run_digits) {
                EXPECT_EQ(maker_.bytes, before + (std::uint64_t{2} << digits) - 2)
                    << before << ' ' << digits;
            } else {
                EXPECT_GT(maker_.bytes, bad_above) << before << ' ' << digits;
            }
        }
    }
}

}  // namespace
}  // namespace stormcellar::bunzip
