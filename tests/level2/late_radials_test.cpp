// Tests that records in the wrong order, or repeated records, give the same volume as records in
// the right order.
#include "level2/decode/late_radials.h"

#include <algorithm>
#include <filesystem>
#include <numeric>

#include <gtest/gtest.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/level2/decode.h"
#include "tests/level2/grow_dropping.h"
#include "tests/level2/same_volume.h"
#include "tests/level2/wire.h"
#include "tests/testing/data.h"

namespace stormcellar::level2 {
namespace {

namespace fs = std::filesystem;
using wire::Bytes;
using Numbers = std::vector<std::size_t>;

std::vector<Bytes> chunks_of(const std::string& set) {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(*testing::data_directory() / "chunks" / set))
        paths.push_back(entry.path());
    std::ranges::sort(paths);
    std::vector<Bytes> chunks;
    for (const fs::path& path : paths)
        chunks.push_back(read_file(path).value());
    return chunks;
}

Bytes joined(const std::vector<Bytes>& chunks, const Numbers& order) {
    Bytes all;
    for (const std::size_t number : order)
        all.insert(all.end(), chunks[number].begin(), chunks[number].end());
    return all;
}

Numbers in_order(std::size_t first, std::size_t end) {
    Numbers numbers(end - first);
    std::iota(numbers.begin(), numbers.end(), first);
    return numbers;
}

class LateRecords : public ::testing::Test {
  protected:
    void set_chunks(std::vector<Bytes> chunks) {
        chunks_ = std::move(chunks);
        right_ = decode(joined(chunks_, in_order(0, chunks_.size()))).value();
    }
    void expect_volume_of_the_right_order(const Numbers& order, const std::string& what) const {
        const Bytes bytes = joined(chunks_, order);
        const auto found = decode(bytes);
        ASSERT_TRUE(found) << what;
        EXPECT_EQ(difference(found->volume, right_.volume), "") << what;
        EXPECT_TRUE(found->report.further_volume_starts.empty()) << what;
        EXPECT_EQ(found->report.complete, right_.report.complete) << what;
        const auto followed = grow_dropping(bytes, 200'000, 1);
        ASSERT_TRUE(followed) << what;
        EXPECT_EQ(difference(*followed, *found), "") << what << ", as the file grows";
    }
    std::vector<Bytes> chunks_;
    Decoded right_;
};

// 2026-11-28: two records in the wrong order at the boundary of two sweeps split a volume into two,
// and the grid at the true time was nearly empty.
class LateRealRecords : public LateRecords, public ::testing::WithParamInterface<const char*> {};

TEST_P(LateRealRecords, AnyTwoNeighborsMayBeExchanged) {
    STORMCELLAR_NEED_DATA();
    set_chunks(chunks_of(GetParam()));
    for (const std::size_t at : {1, 6, 12, 13, 14}) {
        if (at + 1 >= chunks_.size()) break;
        Numbers order = in_order(0, chunks_.size());
        std::swap(order[at], order[at + 1]);
        expect_volume_of_the_right_order(order, fmt::format("chunk {} late", at + 1));
    }
}

TEST_P(LateRealRecords, AllNeighborsMayBeExchanged) {
    STORMCELLAR_NEED_DATA();
    set_chunks(chunks_of(GetParam()));
    for (const std::size_t first : {0, 1}) {
        Numbers order = in_order(0, chunks_.size());
        for (std::size_t at = first; at + 1 < order.size(); at += 2)
            std::swap(order[at], order[at + 1]);
        expect_volume_of_the_right_order(order, fmt::format("from {}", first));
    }
}

TEST_P(LateRealRecords, ChunksMayComeTwice) {
    STORMCELLAR_NEED_DATA();
    set_chunks(chunks_of(GetParam()));
    const std::size_t count = chunks_.size();
    const auto again = [&](std::size_t end, std::size_t from) {
        Numbers order = in_order(0, end);
        for (const std::size_t number : in_order(from, count))
            order.push_back(number);
        return order;
    };
    expect_volume_of_the_right_order(again(count, 0), "all of them");
    expect_volume_of_the_right_order(again(count / 2, 0), "the first half");
    expect_volume_of_the_right_order(again(count / 2, count / 3), "some");
}

INSTANTIATE_TEST_SUITE_P(Sets, LateRealRecords, ::testing::Values("L2D_230", "L2D_185", "KLOT_34"),
                         [](const auto& set) { return std::string(set.param); });

// Returns a chunk with the header and the metadata, and then one chunk for each sweep.
std::vector<Bytes> made_chunks(unsigned sweeps) {
    constexpr unsigned radials = 20, apart_ms = 100;
    const std::vector<float> angles = {0.5F, 1.5F, 2.4F, 3.4F, 4.3F};
    std::vector<Bytes> chunks = {
        wire::join({wire::archive_header(), wire::ldm_record(wire::vcp_frame(212, angles))})};
    for (unsigned sweep = 0; sweep < sweeps; ++sweep) {
        Bytes messages;
        for (unsigned i = 0; i < radials; ++i) {
            wire::Ray ray{.azimuth_deg = static_cast<float>(i), .azimuth_number = i + 1};
            ray.elevation_number = sweep + 1;
            ray.elevation_deg = angles.at(sweep);
            ray.ms += (sweep * radials + i) * apart_ms;
            const bool first = i == 0, last = i + 1 == radials;
            if (first) ray.status = sweep == 0 ? 3 : 0;
            if (last) ray.status = sweep + 1 == sweeps ? 4 : 2;
            messages = wire::join({messages, wire::message_31(ray)});
        }
        chunks.push_back(wire::ldm_record(messages));
    }
    return chunks;
}

using LateMadeRecords = LateRecords;

TEST_F(LateMadeRecords, WholeSweepsMayComeInAnyOrder) {
    set_chunks(made_chunks(5));
    ASSERT_TRUE(right_.report.complete);
    Numbers order = in_order(1, chunks_.size());
    std::size_t tried = 0;
    while (std::ranges::next_permutation(order).found) {
        Numbers with_start = {0};
        with_start.insert(with_start.end(), order.begin(), order.end());
        expect_volume_of_the_right_order(with_start, fmt::format("{}", ++tried));
    }
}

TEST_F(LateMadeRecords, ALowerNumberBeginsAnotherVolumeIfTimeGoesOn) {
    const auto chunks = made_chunks(5);
    wire::Ray ray{.azimuth_number = 2, .elevation_number = 2};
    ray.ms += 5 * 60'000;
    const Bytes later = wire::ldm_record(wire::message_31(ray));
    const auto further_volumes = [](const Bytes& bytes) {
        return decode(bytes)->report.further_volume_starts.size();
    };
    EXPECT_EQ(further_volumes(wire::join({joined(chunks, {0, 1, 2, 3}), later})), 1U);
    EXPECT_EQ(further_volumes(joined(chunks, {0, 1, 3, 2})), 0U);
}

// The fuzzer found this: if an older radial followed the last radial in the same record, the report
// said that the volume had no end.
TEST(LateRadials, TheEndOfAVolumeStandsInOneRecordAsInMany) {
    wire::Ray last, older;
    last.azimuth_number = 2;
    last.status = 4;
    older.azimuth_number = 3;
    older.ms = last.ms - 60'000;
    const Bytes ends = wire::message_31(last);
    const Bytes follows = wire::message_31(older);
    const auto in_one = decode(
        wire::join({wire::archive_header(), wire::ldm_record(wire::join({ends, follows}), true)}));
    const auto in_two = decode(wire::join(
        {wire::archive_header(), wire::ldm_record(ends), wire::ldm_record(follows, true)}));
    ASSERT_TRUE(in_one && in_two);
    EXPECT_EQ(difference(in_one->volume, in_two->volume), "");
    for (const auto* decoded : {&in_one->report, &in_two->report})
        EXPECT_TRUE(std::ranges::none_of(decoded->problems, [](const Problem& problem) {
            return problem.code == "no_end_of_volume";
        }));
}

}  // namespace
}  // namespace stormcellar::level2
