#include "accuracy/ladder_message.h"

#include <gtest/gtest.h>

namespace stormcellar::accuracy {
namespace {

LadderRow message_row(const char* step, const char* name, double time_s, double p99) {
    LadderRow made;
    made.step = step;
    made.name = name;
    made.time_s = time_s;
    made.value = ErrorSummary{100, p99 / 3, p99 / 2, p99, p99 * 2};
    return made;
}

std::string said_by(std::vector<LadderRow> rows, ValueUnit unit = ValueUnit::db) {
    mark_pareto(rows, TimeKind::kept);
    return message_of(rows, unit).sentence();
}

TEST(LadderMessage, NamesTheBestBuyAndWhatLiesBeyond) {
    EXPECT_EQ(
        said_by({message_row("chain", "nearest", 1, 8),
                 message_row("chain", "linear (default)", 2, 4),
                 message_row("chain", "eight-point", 12, 2), message_row("chain", "area", 120, 1.6),
                 message_row("chain", "exact", 240, 0)}),
        "eight-point costs 6 times the time of linear and halves the error; beyond it, area "
        "costs 10 times the time of that and lowers the error by 20 % (to 1.6 dB)");
    EXPECT_EQ(said_by({message_row("chain", "linear (default)", 2, 4),
                       message_row("chain", "area", 3, 1)}),
              "area costs 50 % more time than linear and divides the error by 4 (to 1 dB)");
    EXPECT_EQ(said_by({message_row("chain", "a", 2, 4), message_row("chain", "exact", 20, 0)}),
              "exact costs 10 times the time of a and leaves no error")
        << "no other rung is better";
}

TEST(LadderMessage, PassesOverAGainThatIsNoneToSpeakOf) {
    EXPECT_EQ(
        said_by({message_row("chain", "linear (default)", 1, 4),
                 message_row("chain", "hardly", 4, 3.8), message_row("chain", "better", 10, 2)}),
        "better costs 10 times the time of linear and halves the error");
}

TEST(LadderMessage, PraisesNothingThatIsNotBetter) {
    EXPECT_EQ(said_by({message_row("chain", "linear (default)", 2, 4),
                       message_row("chain", "slow", 20, 4.5)}),
              "no slower rung has a smaller error than linear");
    // "good" is faster and more accurate than "bad", so only "good" is worth its time.
    EXPECT_EQ(said_by({message_row("chain", "linear (default)", 2, 4),
                       message_row("chain", "good", 4, 1), message_row("chain", "bad", 8, 2)}),
              "good costs 2 times the time of linear and divides the error by 4 (to 1 dB)");
}

TEST(LadderMessage, ComparesByTheTimeOfFurtherRuns) {
    std::vector<LadderRow> rows = {message_row("chain", "linear (default)", 1, 4),
                                   message_row("chain", "b", 1, 2)};
    rows[0].kept_time_s = 0.1;
    rows[1].kept_time_s = 0.3;
    EXPECT_EQ(said_by(rows), "b costs 3 times the time of linear and halves the error");
}

TEST(LadderMessage, IsOfWholeChainsElseOfTheLongestStep) {
    std::vector<LadderRow> rows = {
        message_row("beam", "flat", 1, 9), message_row("beam", "round", 2, 0),
        message_row("chain", "a", 1, 4), message_row("chain", "b", 3, 2)};
    mark_pareto(rows);
    EXPECT_EQ(message_of(rows, ValueUnit::db).step, "chain");
    std::vector<LadderRow> of_picture;
    for (const double time_s : {1.0, 2.0, 4.0}) {
        LadderRow one = message_row("slices", time_s > 2 ? "512 slices" : "fewer", time_s, 0);
        one.value.reset();
        one.image_p99_de = 8 / time_s;
        of_picture.push_back(one);
    }
    mark_pareto(of_picture);
    EXPECT_EQ(message_of(of_picture, ValueUnit::db).step, "slices");
    EXPECT_EQ(message_of(of_picture, ValueUnit::db).buy,
              "fewer costs 2 times the time of fewer and halves the error");
}

TEST(LadderMessage, IsEmptyWithoutErrorsToCompare) {
    EXPECT_EQ(said_by({}), "");
    EXPECT_EQ(said_by({message_row("chain", "a", 1, 4)}), "");
    std::vector<LadderRow> unmeasured = {message_row("chain", "a", 1, 4),
                                         message_row("chain", "b", 2, 4)};
    for (LadderRow& one : unmeasured)
        one.value.reset();
    EXPECT_EQ(said_by(unmeasured), "");
}

}  // namespace
}  // namespace stormcellar::accuracy
