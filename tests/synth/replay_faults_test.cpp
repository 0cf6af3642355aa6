#include "synth/replay_faults.h"

#include <cmath>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "synth/replay_pieces.h"
#include "tests/synth/replay_fixture.h"

namespace stormcellar::synth {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::size_t> order_of(const std::vector<Arrival>& arrivals) {
    return parts_of(arrivals, &Arrival::piece);
}

FaultRates certainly(double FaultRates::*fault) {
    FaultRates rates;
    rates.*fault = 1;
    return rates;
}

TEST(ReplayFaults, AreReadFromOneLine) {
    const auto all = parse_fault_rates("drop=0.01,repeat=0.5,reorder=0,truncate=0.25,seed=7");
    ASSERT_TRUE(all) << all.error().message;
    EXPECT_EQ(all->drop, 0.01);
    EXPECT_EQ(all->repeat, 0.5);
    EXPECT_EQ(all->reorder, 0);
    EXPECT_EQ(all->truncate, 0.25);
    EXPECT_EQ(all->seed, 7U);
    const auto one = parse_fault_rates("drop=1");
    ASSERT_TRUE(one);
    EXPECT_EQ(one->seed, 1U);
    for (const char* wrong :
         {"", "drop", "drop=", "drop=x", "drop=nan", "drop=-0.1", "drop=1.1", "drop=0.1,",
          "lose=0.1", "seed=-1", "seed=1.5", "drop=0.1,drop=0.2", "drop=0.6,repeat=0.6"}) {
        const auto refused = parse_fault_rates(wrong);
        ASSERT_FALSE(refused) << wrong;
        EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
        EXPECT_THAT(refused.error().message, HasSubstr("faults: "));
    }
}

TEST(ReplayFaults, EachKindAlone) {
    EXPECT_THAT(order_of(arrivals_of({}, 3, 4)), ElementsAre(0, 1, 2, 3));
    EXPECT_THAT(order_of(arrivals_of(certainly(&FaultRates::repeat), 3, 2)),
                ElementsAre(0, 0, 1, 1));
    // Every second piece is delayed until after the next piece. The last piece has no next piece,
    // so it comes in its turn.
    EXPECT_THAT(order_of(arrivals_of(certainly(&FaultRates::reorder), 3, 5)),
                ElementsAre(1, 0, 3, 2, 4));
    const auto dropped = arrivals_of(certainly(&FaultRates::drop), 3, 2);
    EXPECT_THAT(order_of(dropped), ElementsAre(0, 1));
    EXPECT_EQ(kept_bytes(dropped.front(), 100), 0U);
    for (const Arrival& cut : arrivals_of(certainly(&FaultRates::truncate), 3, 200)) {
        EXPECT_GE(kept_bytes(cut, 10), 1U);
        EXPECT_LE(kept_bytes(cut, 10), 9U);
        EXPECT_EQ(kept_bytes(cut, 1), 1U) << "nothing can be taken away";
        EXPECT_EQ(kept_bytes(cut, 0), 0U);
    }
    EXPECT_THAT(arrivals_of(certainly(&FaultRates::drop), 3, 0), IsEmpty());
}

TEST(ReplayFaults, ComeAsOftenAsAsked) {
    FaultRates rates;
    rates.drop = 0.1;
    rates.repeat = 0.05;
    rates.reorder = 0.02;
    rates.truncate = 0.01;
    constexpr std::size_t pieces = 200'000;
    std::map<Fault, double> count;
    for (const Arrival& arrival : arrivals_of(rates, 1, pieces)) {
        if (!arrival.again) ++count[arrival.fault];
    }
    // No fault is drawn for a piece after which a delayed piece comes, so faults are drawn for 2 %
    // fewer pieces.
    const double drawn = pieces / (1 + rates.reorder);
    for (const auto& [fault, rate] : {std::pair{Fault::drop, 0.1},
                                      {Fault::repeat, 0.05},
                                      {Fault::reorder, 0.02},
                                      {Fault::truncate, 0.01}}) {
        const double deviation = std::sqrt(drawn * rate * (1 - rate));
        EXPECT_NEAR(count[fault], drawn * rate, 5 * deviation) << to_string(fault);
    }
}

TEST(ReplayFaults, DependOnSeedAndRowAlone) {
    FaultRates rates;
    rates.drop = rates.repeat = rates.reorder = 0.2;
    EXPECT_EQ(order_of(arrivals_of(rates, 5, 100)), order_of(arrivals_of(rates, 5, 100)));
    EXPECT_NE(order_of(arrivals_of(rates, 5, 100)), order_of(arrivals_of(rates, 6, 100)));
    FaultRates other = rates;
    other.seed = 2;
    EXPECT_NE(order_of(arrivals_of(rates, 5, 100)), order_of(arrivals_of(other, 5, 100)));
}

// For every way of writing, the drop directory contains the files that the report names.
class ReplayWithFaults : public Replay {
  protected:
    void SetUp() override {
        Replay::SetUp();
        for (std::uint32_t i = 0; i < 4; ++i)
            put(fmt::format("v{}", i), volume_of("KTLX", 1000 * i, 12));
    }
    ReplayReport play_with(Delivery delivery, const char* spec) {
        ReplayOptions options = at_once(delivery);
        options.faults = parse_fault_rates(spec).value();
        auto report = play(options);
        EXPECT_TRUE(report) << report.error().message;
        return report.value_or(ReplayReport{});
    }
    std::vector<wire::Bytes> pieces_of(const std::string& name) {
        const auto bytes = read_file(directory_ / "in" / name).value();
        std::vector<wire::Bytes> pieces;
        std::size_t at = 0;
        for (const std::size_t end : piece_ends(bytes)) {
            pieces.emplace_back(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                                bytes.begin() + static_cast<std::ptrdiff_t>(end));
            at = end;
        }
        return pieces;
    }
};

constexpr const char* plenty = "drop=0.15,repeat=0.15,reorder=0.15,truncate=0.15,seed=7";

TEST_F(ReplayWithFaults, GrowingFilesHoldWhatTheReportSays) {
    const ReplayReport report = play_with(Delivery::growing, plenty);
    std::set<Fault> kinds;
    for (int i = 0; i < 4; ++i) {
        const std::string name = fmt::format("v{}", i);
        std::vector<wire::Bytes> pieces = pieces_of(name);
        for (const FaultMade& made : report.faults) {
            if (made.name != name) continue;
            kinds.insert(made.fault);
            wire::Bytes& piece = pieces[made.chunk - 1];
            EXPECT_EQ(made.bytes, piece.size());
            const wire::Bytes once = piece;
            if (made.fault == Fault::drop) piece.clear();
            if (made.fault == Fault::repeat) piece.insert(piece.end(), once.begin(), once.end());
            if (made.fault == Fault::reorder) std::swap(piece, pieces[made.chunk]);
            if (made.fault == Fault::truncate) piece.resize(made.kept_bytes);
        }
        wire::Bytes expected;
        for (const wire::Bytes& piece : pieces)
            expected.insert(expected.end(), piece.begin(), piece.end());
        EXPECT_EQ(read_file(drop() / name).value(), expected);
    }
    EXPECT_EQ(kinds.size(), 4U) << "choose another seed";
}

TEST_F(ReplayWithFaults, ChunksAreMissingOrCutAsTheReportSays) {
    const ReplayReport report = play_with(Delivery::chunks, plenty);
    std::map<fs::path, std::uint64_t> kept;
    for (const FaultMade& made : report.faults) {
        if (made.fault == Fault::drop || made.fault == Fault::truncate)
            kept[made.name] = made.kept_bytes;
    }
    ASSERT_FALSE(kept.empty());
    std::size_t cut = 0, missing = 0;
    for (std::size_t volume = 0; volume < 4; ++volume) {
        const auto pieces = pieces_of(fmt::format("v{}", volume));
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const char last = i + 1 == pieces.size() ? 'E' : 'I';
            const char kind = i == 0 ? 'S' : last;
            const fs::path name = fmt::format("KTLX/{}/{}-{:03}-{}", 116 + volume,
                                              day_and_second(volume), i + 1, kind);
            const auto fault = kept.find(name);
            if (fault == kept.end()) {
                EXPECT_EQ(read_file(drop() / name).value(), pieces[i]) << name;
            } else if (fault->second == 0) {
                EXPECT_FALSE(fs::exists(drop() / name)) << name;
                ++missing;
            } else {
                EXPECT_EQ(fs::file_size(drop() / name), fault->second) << name;
                ++cut;
            }
        }
    }
    EXPECT_EQ(cut + missing, kept.size()) << "the report names only these faults";
}

TEST_F(ReplayWithFaults, OfWholeFilesEachIsOnePiece) {
    const ReplayReport dropped = play_with(Delivery::whole, "drop=1");
    EXPECT_EQ(dropped.files, 4U);
    EXPECT_EQ(dropped.writes, 0U);
    EXPECT_FALSE(fs::exists(drop() / "v0"));
    ASSERT_EQ(dropped.faults.size(), 4U);
    EXPECT_EQ(dropped.faults[0].chunk, 0U);

    const ReplayReport cut = play_with(Delivery::whole, "truncate=1");
    ASSERT_EQ(cut.faults.size(), 4U);
    for (const FaultMade& made : cut.faults) {
        EXPECT_EQ(fs::file_size(drop() / made.name), made.kept_bytes);
        EXPECT_LT(made.kept_bytes, made.bytes);
        fs::remove(drop() / made.name);
    }

    const ReplayReport twice = play_with(Delivery::whole, "repeat=1");
    EXPECT_EQ(twice.writes, 8U);
    EXPECT_EQ(twice.files, 4U);
    EXPECT_EQ(twice.bytes, 2 * 4 * fs::file_size(drop() / "v0"));
}

}  // namespace
}  // namespace stormcellar::synth
