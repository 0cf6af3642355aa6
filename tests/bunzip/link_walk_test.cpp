#include "bunzip/link_walk.h"

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "bunzip/row_links.h"
#include "tests/bunzip/each_path.h"

namespace stormcellar::bunzip {
namespace {

using Octets = std::vector<std::uint8_t>;

Octets walk_alone(const std::vector<Link>& links, std::uint32_t origin, std::size_t bytes) {
    Octets out;
    Link link = links[origin];
    for (std::size_t i = 0; i < bytes; ++i) {
        out.push_back(static_cast<std::uint8_t>(link));
        link = links[link >> link_shift];
    }
    return out;
}

// Returns links that form rings of these sizes, with the rows of each ring in random places.
std::vector<Link> links_of(const std::vector<std::uint32_t>& rings, std::mt19937& random) {
    const std::uint32_t rows = std::accumulate(rings.begin(), rings.end(), 0U);
    std::vector<std::uint32_t> order(rows);
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), random);
    std::vector<Link> links(rows + 1 + link_slack);
    std::uint32_t begin = 0;
    for (const std::uint32_t ring : rings) {
        for (std::uint32_t i = 0; i < ring; ++i) {
            links[order[begin + i]] =
                order[begin + (i + 1) % ring] << link_shift | (random() & 0xFFU);
        }
        begin += ring;
    }
    return links;
}

void expect_as_alone(std::vector<Link> links, std::uint32_t rows, std::uint32_t origin,
                     bool by_one_walk = false) {
    static LinkWalk walk;
    const Octets wanted = walk_alone(links, origin, rows + 1);
    const std::vector<Link> before(links.begin(), links.begin() + rows);
    Octets bytes(rows + 1);
    walk.read(links, rows, origin, bytes);
    EXPECT_TRUE(bytes == wanted) << rows << " rows from " << origin;
    EXPECT_EQ(walk.walked_alone(), by_one_walk) << rows << " rows from " << origin;
    links.resize(rows);
    EXPECT_TRUE(links == before) << "read() must restore the links";
}

TEST(LinkWalk, OneRingOfAnySize) {
    std::mt19937 random(8);
    for (const std::uint32_t rows : {1U, 2U, 3U, 255U, 256U, 257U, 512U, 4095U, 4096U, 10'000U,
                                     262'143U, 262'144U, 300'000U, 899'999U, 900'000U}) {
        const auto links = links_of({rows}, random);
        expect_as_alone(links, rows, 0);
        expect_as_alone(links, rows, rows - 1);
        expect_as_alone(links, rows, static_cast<std::uint32_t>(random() % rows));
    }
}

// If the block is a repetition of a text, the links form several rings, and the walk goes around
// only one ring.
TEST(LinkWalk, ManyRings) {
    std::mt19937 random(9);
    expect_as_alone(links_of({50'000, 1, 1, 7, 30'000, 300'000}, random), 380'009, 17);
    expect_as_alone(links_of(std::vector<std::uint32_t>(9000, 100), random), 900'000, 450'000);
    expect_as_alone(links_of(std::vector<std::uint32_t>(5000, 1), random), 5000, 4999);
    expect_as_alone(links_of({3, 100'000}, random), 100'003, 50'000);
}

// Each walk begins at a mark. Here all marks are close together on the ring, so one of the walks
// would have to read nearly all of the block, but has no room for so many bytes.
TEST(LinkWalk, OneWalkThatHasItAll) {
    constexpr std::uint32_t rows = 600'000;
    std::vector<std::uint32_t> order;
    std::vector<bool> first(rows);
    for (std::uint32_t i = 0; i < LinkWalk::mark_count(rows); ++i) {
        order.push_back(LinkWalk::marked_row(i, rows));
        first[order.back()] = true;
    }
    for (std::uint32_t row = 0; row < rows; ++row) {
        if (!first[row]) order.push_back(row);
    }
    std::vector<Link> links(rows + 1 + link_slack);
    for (std::uint32_t i = 0; i < rows; ++i)
        links[order[i]] = order[(i + 1) % rows] << link_shift | (i % 251);
    expect_as_alone(links, rows, 0, true);
    expect_as_alone(links, rows, 599'999, true);
}

TEST(LinkWalk, MarksAreRowsAndAllDiffer) {
    for (const std::uint32_t rows : {1U, 255U, 256U, 600U, 100'000U, 262'144U, 900'000U}) {
        std::uint32_t least = 0;
        for (std::uint32_t i = 0; i < LinkWalk::mark_count(rows); ++i) {
            const std::uint32_t row = LinkWalk::marked_row(i, rows);
            EXPECT_GE(row, least);
            EXPECT_LT(row, rows);
            least = row + 1;
        }
    }
}

// 2026-11-23: if the data had a period of 256, 512, 1024 or 2048 bytes, evenly spaced marks were
// all at the same places of a period, close together on the ring.
TEST(LinkWalk, DataThatRepeatsItselfIsNotReadByOneWalk) {
    constexpr std::uint32_t rows = 450'000;
    std::mt19937 random(11);
    for (const std::uint32_t period :
         {100U, 128U, 256U, 512U, 1000U, 1024U, 2048U, 2432U, 65'536U}) {
        // Rows that begin at the same place of the period are neighbors, in the order of the text.
        std::vector<std::uint32_t> places(period), begin(period);
        std::iota(places.begin(), places.end(), 0U);
        std::shuffle(places.begin(), places.end(), random);
        std::uint32_t row = 0;
        for (const std::uint32_t place : places) {
            begin[place] = row;
            row += rows / period + (place < rows % period ? 1 : 0);
        }
        const auto row_of = [&](std::uint32_t at) { return begin[at % period] + at / period; };
        std::vector<Link> links(rows + 1 + link_slack);
        for (std::uint32_t at = 0; at < rows; ++at)
            links[row_of(at)] = row_of((at + 1) % rows) << link_shift | (at % period % 251);
        SCOPED_TRACE(period);
        expect_as_alone(links, rows, row_of(7));
    }
}

class RowLinksOf : public ::testing::TestWithParam<Path> {};
INSTANTIATE_TEST_SUITE_P(EachPath, RowLinksOf, ::testing::ValuesIn(available_kernels()), test_name);

// The test sorts the rotations of a text, as the format describes it. Reading along the links must
// give the text.
TEST_P(RowLinksOf, AreThoseOfTheSortedRotations) {
    std::mt19937 random(10);
    for (int round = 0; round < 60; ++round) {
        const std::uint32_t size = 1 + static_cast<std::uint32_t>(random() % 3000);
        Octets text(size);
        const auto kinds = static_cast<unsigned>(1 + random() % 5);
        for (std::size_t i = 0; i < size; ++i)
            text[i] = static_cast<std::uint8_t>(i > 0 && random() % 9 != 0 ? text[i - 1]
                                                                           : random() % kinds);
        std::vector<std::uint32_t> rows(size);
        std::iota(rows.begin(), rows.end(), 0U);
        Octets twice = text;
        twice.insert(twice.end(), text.begin(), text.end());
        std::stable_sort(rows.begin(), rows.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::lexicographical_compare(twice.begin() + a, twice.begin() + a + size,
                                                twice.begin() + b, twice.begin() + b + size);
        });
        std::vector<ByteRun> runs;
        std::array<std::uint32_t, 256> count{};
        std::uint32_t origin = 0;
        for (std::uint32_t i = 0; i < size; ++i) {
            const std::uint8_t byte = twice[rows[i] + size - 1];
            if (!runs.empty() && runs.back().byte() == byte) {
                runs.back() = ByteRun{byte, runs.back().length() + 1};
            } else {
                runs.emplace_back(byte, 1U);
            }
            ++count[byte];
            if (rows[i] == 0) origin = i;
        }
        std::vector<Link> links(size + 1 + link_slack);
        link_rows_by(GetParam())(runs, count, links.data());
        Octets wanted = text;
        wanted.push_back(text.front());
        ASSERT_EQ(walk_alone(links, origin, size + 1), wanted) << round;
        expect_as_alone(links, size, origin);
    }
}

}  // namespace
}  // namespace stormcellar::bunzip
