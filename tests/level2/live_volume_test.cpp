// Tests that the volume made from chunks depends on their numbers, but not on the order in which
// they arrive.
#include "stormcellar/level2/live_volume.h"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "stormcellar/base/file_system.h"
#include "tests/level2/same_volume.h"
#include "tests/level2/wire.h"
#include "tests/testing/data.h"
#include "tests/testing/test_name.h"

namespace stormcellar::level2 {
namespace {

using wire::Bytes;
using Added = LiveVolume::Added;
using std::chrono::seconds;

// Stores sweeps in memory, but refuses every `refuses`-th sweep. If `lost` is set, get() fails.
class MemoryDepot final : public SweepDepot {
  public:
    explicit MemoryDepot(std::size_t refuses = 0) : refuses_(refuses) {}
    std::optional<std::uint64_t> put(const Sweep& sweep) override {
        ++asked_;
        if (refuses_ > 0 && asked_ % refuses_ == 0) return std::nullopt;
        sweeps_.push_back(sweep);
        return sweeps_.size() - 1;
    }
    Result<Sweep> get(std::uint64_t place) const override {
        if (lost) return fail(ErrorCode::io, "lost");
        return sweeps_.at(place);
    }
    [[nodiscard]] std::size_t count() const { return sweeps_.size(); }
    bool lost = false;

  private:
    std::size_t refuses_, asked_ = 0;
    std::vector<Sweep> sweeps_;
};

LiveOptions with(SweepDepot* depot) {
    LiveOptions options;
    options.depot = depot;
    return options;
}

struct ChunkFile {
    ChunkName name;
    Bytes bytes;
};

std::vector<ChunkFile> real_chunks(const char* set) {
    std::vector<ChunkFile> chunks;
    for (const auto& entry :
         std::filesystem::directory_iterator(*testing::data_directory() / "chunks" / set)) {
        const auto name = parse_chunk_name(entry.path().filename().string());
        EXPECT_TRUE(name) << entry.path();
        if (name) chunks.push_back({*name, read_file(entry.path()).value()});
    }
    std::sort(chunks.begin(), chunks.end(),
              [](const ChunkFile& a, const ChunkFile& b) { return a.name.number < b.name.number; });
    return chunks;
}

// Returns the chunks of a volume: a start chunk, and then two chunks for each sweep.
std::vector<ChunkFile> simple_chunks(unsigned sweeps, unsigned ms = 1000) {
    std::vector<ChunkFile> chunks;
    const auto add = [&](ChunkKind kind, Bytes bytes) {
        const int number = static_cast<int>(chunks.size()) + 1;
        chunks.push_back({{"20220317-000842", number, kind}, std::move(bytes)});
    };
    Bytes start = wire::archive_header();
    wire::overwrite_u32(start, 16, ms);
    add(ChunkKind::start, wire::join({start, wire::ldm_record(wire::frame(2))}));
    const unsigned radials = 10;
    const Bytes all = wire::radial_messages(sweeps, radials);
    const std::size_t length = all.size() / (sweeps * radials);
    for (unsigned half = 0; half < 2 * sweeps; ++half) {
        const auto from = all.begin() + static_cast<std::ptrdiff_t>(half * 5 * length);
        const Bytes part(from, from + static_cast<std::ptrdiff_t>(5 * length));
        const bool last = half + 1 == 2 * sweeps;
        add(last ? ChunkKind::end : ChunkKind::intermediate, wire::ldm_record(part, last));
    }
    return chunks;
}

Bytes joined(const std::vector<ChunkFile>& chunks) {
    Bytes all;
    for (const ChunkFile& chunk : chunks)
        all.insert(all.end(), chunk.bytes.begin(), chunk.bytes.end());
    return all;
}

// Removes the problems about missing chunks, which a decode of the joined chunks cannot report, and
// sets `complete`.
Decoded without_missing_chunks(Decoded decoded, bool complete) {
    std::erase_if(decoded.report.problems,
                  [](const Problem& problem) { return problem.code == "missing_chunks"; });
    decoded.report.complete = complete;
    return decoded;
}

Result<Added> add(LiveVolume& volume, const ChunkFile& chunk, seconds at = {}) {
    return volume.add(chunk.name.number, chunk.name.kind, chunk.bytes,
                      LiveVolume::Clock::time_point{at});
}

// Loses some of the chunks, repeats some of the others, and adds them in a random order. Returns
// the chunks that were added, sorted by number.
std::vector<ChunkFile> arrive(LiveVolume& volume, const std::vector<ChunkFile>& chunks,
                              std::mt19937& random, double lost, double repeated) {
    std::uniform_real_distribution<double> chance;
    std::vector<ChunkFile> arrived;
    std::vector<const ChunkFile*> order;
    for (const ChunkFile& chunk : chunks) {
        if (chance(random) < lost) continue;
        arrived.push_back(chunk);
    }
    for (const ChunkFile& chunk : arrived) {
        order.push_back(&chunk);
        if (chance(random) < repeated) order.push_back(&chunk);
    }
    std::shuffle(order.begin(), order.end(), random);
    for (const ChunkFile* chunk : order)
        EXPECT_TRUE(add(volume, *chunk));
    return arrived;
}

void expect_any_order_gives_the_same(const std::vector<ChunkFile>& chunks, unsigned rounds) {
    std::mt19937 random{20'260'811};
    for (unsigned round = 0; round < rounds; ++round) {
        MemoryDepot depot{3};
        LiveVolume volume{with(round % 2 == 0 ? &depot : nullptr)};
        const double lost = round % 3 == 0 ? 0 : 0.15;
        const auto arrived = arrive(volume, chunks, random, lost, 0.2);
        if (arrived.empty()) continue;
        const auto live = volume.finish();
        const auto whole = decode(joined(arrived));
        ASSERT_EQ(live.has_value(), whole.has_value()) << round;
        if (!whole) continue;
        const bool lacks_some = arrived.back().name.number != static_cast<int>(arrived.size());
        const bool complete = whole->report.complete;
        EXPECT_EQ(live->report.complete, complete && !lacks_some) << "round " << round;
        EXPECT_EQ(difference(without_missing_chunks(*live, complete), *whole), "")
            << "round " << round;
    }
}

TEST(LiveVolume, AnyOrderGivesTheSame) {
    expect_any_order_gives_the_same(simple_chunks(5), 200);
}

struct RealChunks {
    const char* set;
    int rounds;
};
class AnyOrder : public ::testing::TestWithParam<RealChunks> {};

TEST_P(AnyOrder, GivesTheSame) {
    STORMCELLAR_NEED_DATA();
    expect_any_order_gives_the_same(real_chunks(GetParam().set), GetParam().rounds);
}

// The chunk sets are from a TDWR, a volume that stops early, a volume from 2026, and a large
// volume.
INSTANTIATE_TEST_SUITE_P(LiveVolumeReal, AnyOrder,
                         ::testing::Values(RealChunks{"L2D_185", 6}, RealChunks{"KLOT_34", 4},
                                           RealChunks{"OPENRADAR_KLOT", 2},
                                           RealChunks{"L2D_230", 2}),
                         [](const auto& test) { return testing::test_name(test.param.set); });

// Expects that the last returned version of each sweep equals the sweep in the final volume.
void expect_sweeps_come_out(const std::vector<ChunkFile>& chunks, bool shuffled,
                            SweepDepot* depot = nullptr) {
    std::mt19937 random{5};
    std::vector<const ChunkFile*> order;
    for (const ChunkFile& chunk : chunks)
        order.push_back(&chunk);
    if (shuffled) std::shuffle(order.begin(), order.end(), random);
    LiveVolume volume{with(depot)};
    std::map<std::pair<int, std::int64_t>, Sweep> newest;  // by cut and time of the first radial
    std::size_t handed_out = 0;
    for (const ChunkFile* chunk : order) {
        ASSERT_TRUE(add(volume, *chunk));
        for (LiveSweep& live : volume.take_sweeps()) {
            ++handed_out;
            const auto time = live.sweep.radials.front().time.time_since_epoch().count();
            newest[{live.sweep.elevation_number, time}] = std::move(live.sweep);
        }
    }
    const Volume whole = volume.finish().value().volume;
    std::size_t found = 0;
    for (const Sweep& sweep : whole.sweeps) {
        const auto time = sweep.radials.front().time.time_since_epoch().count();
        const auto live = newest.find({sweep.elevation_number, time});
        if (live == newest.end()) continue;
        ++found;
        Volume a, b;
        a.sweeps = {sweep};
        b.sweeps = {live->second};
        EXPECT_EQ(difference(a, b), "") << sweep.elevation_number;
    }
    EXPECT_GE(found + 1, whole.sweeps.size()) << "only a last sweep without its end may be open";
    if (!shuffled) {
        EXPECT_EQ(handed_out, found) << "chunks in order return each sweep once";
    }
}

TEST(LiveVolume, SweepsComeOutAsTheyClose) {
    expect_sweeps_come_out(simple_chunks(5), false);
    expect_sweeps_come_out(simple_chunks(5), true);
}

TEST(LiveVolumeReal, SweepsComeOutAsTheyClose) {
    STORMCELLAR_NEED_DATA();
    expect_sweeps_come_out(real_chunks("KLOT_34"), false);
    MemoryDepot depot;
    expect_sweeps_come_out(real_chunks("KLOT_34"), true, &depot);
    EXPECT_GT(depot.count(), 10U);
    expect_sweeps_come_out(real_chunks("L2D_185"), true);
}

TEST(LiveVolumeReal, WithADepotLittleIsHeldInMemory) {
    STORMCELLAR_NEED_DATA();
    MemoryDepot depot;
    LiveVolume with_depot{with(&depot)};
    LiveVolume without;
    for (const ChunkFile& chunk : real_chunks("L2D_230")) {
        ASSERT_TRUE(add(with_depot, chunk));
        ASSERT_TRUE(add(without, chunk));
    }
    EXPECT_GT(without.held_bytes(), 10'000'000U);
    EXPECT_LT(with_depot.held_bytes(), without.held_bytes() / 20);
    EXPECT_EQ(difference(*with_depot.finish(), *without.finish()), "");
}

TEST(LiveVolume, WhatTheDepotLosesIsAnErrorOfItsOwn) {
    MemoryDepot depot;
    LiveVolume volume{with(&depot)};
    for (const ChunkFile& chunk : simple_chunks(3))
        ASSERT_TRUE(add(volume, chunk));
    ASSERT_GT(depot.count(), 0U);
    depot.lost = true;
    EXPECT_TRUE(volume.take_sweeps().empty());
    const auto finished = volume.finish();
    ASSERT_FALSE(finished);
    EXPECT_EQ(finished.error().code, ErrorCode::io);
}

TEST(LiveVolume, TheEndIsKnownByTheChunkTheRadialOrTheControlWord) {
    auto chunks = simple_chunks(2);
    LiveVolume volume;
    for (std::size_t i = 0; i + 1 < chunks.size(); ++i) {
        EXPECT_EQ(add(volume, chunks[i]), Added::added);
        EXPECT_FALSE(volume.has_ended()) << i;
    }
    chunks.back().name.kind = ChunkKind::intermediate;  // a wrong kind in the name
    EXPECT_EQ(add(volume, chunks.back()), Added::added);
    EXPECT_TRUE(volume.has_ended());
    EXPECT_TRUE(volume.is_whole());
    EXPECT_TRUE(volume.is_due(LiveVolume::Clock::time_point{}));
}

TEST(LiveVolume, LateChunksAreWaitedForThenGivenUp) {
    const auto chunks = simple_chunks(3);
    LiveVolume volume;
    for (const ChunkFile& chunk : chunks) {
        if (chunk.name.number == 3) continue;
        EXPECT_TRUE(add(volume, chunk, seconds{100}));
    }
    const auto at = [](int s) { return LiveVolume::Clock::time_point{seconds{s}}; };
    EXPECT_TRUE(volume.has_ended());
    EXPECT_EQ(volume.missing_numbers(), std::vector<int>{3});
    EXPECT_FALSE(volume.is_due(at(129)));
    EXPECT_TRUE(volume.is_due(at(130)));
    EXPECT_TRUE(add(volume, chunks[2], seconds{120}));
    EXPECT_TRUE(volume.is_due(at(120)));
}

TEST(LiveVolume, AVolumeThatStopsTimesOut) {
    LiveOptions options;
    options.timeout = seconds{50};
    LiveVolume volume{options};
    EXPECT_FALSE(volume.is_due(LiveVolume::Clock::time_point{seconds{1'000'000}}));
    const auto chunks = simple_chunks(3);
    EXPECT_TRUE(add(volume, chunks[0], seconds{10}));
    EXPECT_TRUE(add(volume, chunks[1], seconds{20}));
    EXPECT_FALSE(volume.is_due(LiveVolume::Clock::time_point{seconds{69}}));
    EXPECT_TRUE(volume.is_due(LiveVolume::Clock::time_point{seconds{70}}));
    const auto decoded = volume.finish();
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded->volume.radial_count(), 5U);
    EXPECT_FALSE(decoded->report.complete);
    EXPECT_TRUE(volume.is_empty());
}

TEST(LiveVolume, AChunkThatWasReadTooEarlyIsReplaced) {
    const auto chunks = simple_chunks(2);
    for (const bool cut_first : {true, false}) {
        LiveVolume volume;
        ChunkFile cut = chunks[0];
        cut.bytes.resize(30);
        EXPECT_EQ(add(volume, cut_first ? cut : chunks[0]), Added::added);
        EXPECT_EQ(add(volume, cut_first ? chunks[0] : cut),
                  cut_first ? Added::replaced : Added::worse);
        EXPECT_EQ(add(volume, chunks[0]), Added::repeated);
        EXPECT_TRUE(add(volume, chunks[1]));
        EXPECT_EQ(volume.finish()->report.message_counts.at(2), 1U);
    }
}

TEST(LiveVolume, ARadarThatBeginsAgainIsAnotherVolume) {
    const auto old_volume = simple_chunks(3, 1000);
    const auto new_volume = simple_chunks(3, 61'000);
    LiveVolume volume;
    EXPECT_TRUE(add(volume, old_volume[0]));
    EXPECT_TRUE(add(volume, old_volume[1]));
    EXPECT_EQ(add(volume, new_volume[0]), Added::another_volume);
    const auto kept = volume.finish();
    ASSERT_TRUE(kept);
    EXPECT_EQ(kept->volume.header->ms, 1000U);
    EXPECT_EQ(kept->volume.radial_count(), 5U);
    EXPECT_EQ(add(volume, new_volume[0]), Added::added);
}

TEST(LiveVolume, WhatIsNoChunkIsRefusedAndChangesNothing) {
    LiveVolume volume;
    const auto refuse = [&](const Bytes& bytes) {
        const auto added = volume.add(2, ChunkKind::intermediate, bytes, {});
        EXPECT_FALSE(added);
        return added ? ErrorCode::internal : added.error().code;
    };
    EXPECT_EQ(refuse({}), ErrorCode::empty);
    EXPECT_EQ(refuse(Bytes(1000, std::byte{0x41})), ErrorCode::not_level2);
    Bytes cut = simple_chunks(1)[1].bytes;
    cut.resize(cut.size() / 2);
    EXPECT_EQ(refuse(cut), ErrorCode::truncated);
    EXPECT_TRUE(volume.is_empty());
    EXPECT_EQ(volume.finish().error().code, ErrorCode::corrupt);
    EXPECT_EQ(volume.finish().error().code, ErrorCode::empty);
}

std::vector<std::string> texts_of(const Decoded& decoded, std::string_view code) {
    std::vector<std::string> texts;
    for (const Problem& problem : decoded.report.problems) {
        if (problem.code == code) texts.push_back(problem.text());
    }
    return texts;
}

TEST(LiveVolume, LostChunksAreNamed) {
    const auto chunks = simple_chunks(3);
    LiveVolume volume;
    for (const ChunkFile& chunk : chunks) {
        if (chunk.name.number == 3 || chunk.name.number == 5) continue;
        EXPECT_TRUE(add(volume, chunk));
    }
    EXPECT_FALSE(volume.add(5, ChunkKind::intermediate, Bytes(1000, std::byte{0x41}), {}));
    EXPECT_FALSE(volume.add(6, ChunkKind::intermediate, Bytes(1000, std::byte{0x41}), {}))
        << "a whole chunk of this number has come";
    const Decoded decoded = volume.finish().value();
    EXPECT_EQ(texts_of(decoded, "missing_chunks"), std::vector<std::string>{"missing chunks: 3"});
    EXPECT_EQ(texts_of(decoded, "bad_chunk"),
              std::vector<std::string>{"chunk 5: not a chunk of a Level II volume"});
    EXPECT_FALSE(decoded.report.complete);
}

TEST(LiveVolume, TheFirstHeaderOfANumberIsRemembered) {
    const auto a = simple_chunks(1, 1000), b = simple_chunks(1, 61'000);
    const ChunkFile without_header{{"20220317-000842", 1, ChunkKind::start}, a[1].bytes};
    LiveVolume volume;
    EXPECT_EQ(add(volume, without_header), Added::added);
    EXPECT_EQ(add(volume, a[0]), Added::worse)
        << "the new chunk has only metadata; the chunk that it would replace has radials";
    EXPECT_EQ(add(volume, b[0]), Added::another_volume);
}

TEST(LiveVolume, ThatAChunkIsTheLastIsBelievedThoughItComesTwice) {
    const auto chunks = simple_chunks(2);
    LiveVolume volume;
    EXPECT_EQ(add(volume, chunks[1]), Added::added);
    EXPECT_FALSE(volume.has_ended());
    EXPECT_EQ(volume.add(2, ChunkKind::end, chunks[1].bytes, {}), Added::repeated);
    EXPECT_TRUE(volume.has_ended());
}

TEST(LiveVolume, BeyondTheLimitAChunkIsRefused) {
    LiveOptions options;
    options.decode.output_limit_bytes = 10'000;
    LiveVolume volume{options};
    const auto chunks = simple_chunks(5);
    int taken = 0;
    for (const ChunkFile& chunk : chunks) {
        const auto added = add(volume, chunk);
        if (added) {
            ++taken;
        } else {
            EXPECT_EQ(added.error().code, ErrorCode::unsupported);
        }
    }
    EXPECT_GT(taken, 1);
    EXPECT_LT(taken, static_cast<int>(chunks.size()));
    EXPECT_TRUE(volume.finish()) << "finish() must return the chunks that add() accepted";
}

TEST(LiveVolume, NumbersHaveThreeDigits) {
    LiveVolume volume;
    const Bytes bytes = simple_chunks(1)[1].bytes;
    for (const int number : {-1, 0, 1000, 200'000'000}) {
        const auto added = volume.add(number, ChunkKind::intermediate, bytes, {});
        ASSERT_FALSE(added) << number;
        EXPECT_EQ(added.error().code, ErrorCode::bad_argument);
    }
}

TEST(LiveVolume, FactsAreKnownFromTheFirstChunksOn) {
    const auto chunks = simple_chunks(1);
    LiveVolume volume;
    EXPECT_TRUE(add(volume, chunks[0]));
    EXPECT_EQ(volume.facts().header->icao, "KTLX");
    EXPECT_TRUE(add(volume, chunks[1]));
    EXPECT_EQ(volume.facts().station, "KTLX");
    EXPECT_TRUE(volume.facts().sweeps.empty());
}

}  // namespace
}  // namespace stormcellar::level2
