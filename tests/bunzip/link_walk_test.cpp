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

// Rings of these sizes, their rows anywhere.
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

void expect_as_alone(std::vector<Link> links, std::uint32_t rows, std::uint32_t origin) {
    static LinkWalk walk;
    const Octets wanted = walk_alone(links, origin, rows + 1);
    const std::vector<Link> before(links.begin(), links.begin() + rows);
    Octets bytes(rows + 1);
    walk.read(links, rows, origin, bytes);
    EXPECT_TRUE(bytes == wanted) << rows << " rows from " << origin;
    links.resize(rows);
    EXPECT_TRUE(links == before) << "the links are not as they were";
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

// Of a block that repeats itself the links are several rings; what is read goes round on one.
TEST(LinkWalk, ManyRings) {
    std::mt19937 random(9);
    expect_as_alone(links_of({50'000, 1, 1, 7, 30'000, 300'000}, random), 380'009, 17);
    expect_as_alone(links_of(std::vector<std::uint32_t>(9000, 100), random), 900'000, 450'000);
    expect_as_alone(links_of(std::vector<std::uint32_t>(5000, 1), random), 5000, 4999);
    expect_as_alone(links_of({3, 100'000}, random), 100'003, 50'000);
}

// All marks stand close together on the ring, so one walk has nearly all of the block to go and no
// room for it.
TEST(LinkWalk, OneWalkThatHasItAll) {
    constexpr std::uint32_t rows = 600'000;
    const std::uint32_t segments = std::min(LinkWalk::most_segments, rows / 256 + 1);
    std::vector<std::uint32_t> order;
    std::vector<bool> first(rows);
    for (std::uint32_t i = 0; i < segments; ++i) {
        order.push_back(static_cast<std::uint32_t>(std::uint64_t{rows} * i / segments));
        first[order.back()] = true;
    }
    for (std::uint32_t row = 0; row < rows; ++row) {
        if (!first[row]) order.push_back(row);
    }
    std::vector<Link> links(rows + 1 + link_slack);
    for (std::uint32_t i = 0; i < rows; ++i)
        links[order[i]] = order[(i + 1) % rows] << link_shift | (i % 251);
    expect_as_alone(links, rows, 0);
    expect_as_alone(links, rows, 599'999);
}

class RowLinksOf : public ::testing::TestWithParam<Path> {};
INSTANTIATE_TEST_SUITE_P(EachPath, RowLinksOf, ::testing::ValuesIn(available_kernels()), test_name);

// The rows of a text sorted as the format says it: what is read along the links is the text.
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
