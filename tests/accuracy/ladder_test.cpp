#include "stormcellar/accuracy/ladder.h"

#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stormcellar::accuracy {
namespace {

LadderRow row(const char* step, std::size_t rung, const char* name, double time_s,
              std::optional<double> p99, std::optional<double> position_m) {
    LadderRow made;
    made.step = step;
    made.rung = rung;
    made.name = name;
    made.time_s = time_s;
    made.position_max_m = position_m;
    if (p99) made.value = ErrorSummary{100, *p99 / 3, *p99 / 2, *p99, *p99 * 2};
    return made;
}

std::string front(std::vector<LadderRow> rows, TimeKind kind = TimeKind::first) {
    mark_pareto(rows, kind);
    std::string names;
    for (const LadderRow& marked : rows) {
        if (marked.pareto) names += marked.name;
    }
    return names;
}

TEST(Ladder, TheFrontIsWhatNothingBeats) {
    EXPECT_EQ(front({row("s", 0, "a", 1, 3, 9), row("s", 1, "b", 2, 2, 9),
                     row("s", 2, "c", 3, 2.5, 9), row("s", 3, "d", 4, 0, 0)}),
              "abd");
    // A rung (choice) that is better in a single error is also on the Pareto front.
    EXPECT_EQ(front({row("s", 0, "a", 1, 3, 5), row("s", 1, "b", 2, 4, 4)}), "ab");
    EXPECT_EQ(front({row("s", 0, "a", 1, 3, 5), row("s", 1, "b", 2, 3, 5)}), "a");
}

TEST(Ladder, EqualsAreOnTheFrontTogether) {
    EXPECT_EQ(front({row("s", 0, "a", 1, 3, 5), row("s", 1, "b", 1, 3, 5)}), "ab");
}

TEST(Ladder, StepsDoNotCompete) {
    EXPECT_EQ(front({row("s", 0, "a", 1, 1, 1), row("t", 0, "b", 2, 2, 2)}), "ab");
}

TEST(Ladder, WhatWasNotMeasuredWinsNothing) {
    EXPECT_EQ(front({row("s", 0, "a", 1, 3, {}), row("s", 1, "b", 1, {}, {})}), "a");
    EXPECT_EQ(front({row("s", 0, "a", 1, 3, {}), row("s", 1, "b", 2, 2, {})}), "ab");
}

TEST(Ladder, KeptTimesMakeAnotherFront) {
    std::vector<LadderRow> rows = {row("s", 0, "a", 1, 3, {}), row("s", 1, "b", 5, 3, {})};
    rows[1].kept_time_s = 0.5;
    EXPECT_EQ(front(rows), "a");
    EXPECT_EQ(front(rows, TimeKind::kept), "b");
}

TEST(Ladder, TheFrontMeetsItsDefinitionOnRandomRows) {
    std::mt19937_64 random(20261121);
    for (int trial = 0; trial < 500; ++trial) {
        std::vector<LadderRow> rows;
        for (std::size_t i = random() % 12; i > 0; --i) {
            rows.push_back(row("s", i, "x", static_cast<double>(1 + random() % 4),
                               static_cast<double>(random() % 4),
                               static_cast<double>(random() % 3)));
        }
        mark_pareto(rows);
        const auto leq = [](const LadderRow& a, const LadderRow& b) {
            return a.time_s <= b.time_s && a.value->p99 <= b.value->p99 &&
                   *a.position_max_m <= *b.position_max_m;
        };
        for (const LadderRow& one : rows) {
            const bool beaten = std::any_of(rows.begin(), rows.end(), [&](const LadderRow& other) {
                return leq(other, one) && !leq(one, other);
            });
            EXPECT_EQ(one.pareto, !beaten);
        }
    }
}

TEST(Ladder, RowsHaveTheSameKeysWithTheirUnits) {
    const auto empty = fields(LadderRow{}, ValueUnit::db);
    LadderRow full = row("beam", 1, "ray traced", 0.5, 0.3, 12);
    full.status = StatusCounts{1000, 5};
    const auto filled = fields(full, ValueUnit::db);
    ASSERT_EQ(empty.size(), filled.size());
    for (std::size_t i = 0; i < empty.size(); ++i)
        EXPECT_EQ(empty[i].key, filled[i].key);
    const auto of = [&](const std::string& key) {
        return std::find_if(filled.begin(), filled.end(),
                            [&](const LadderField& field) { return field.key == key; })
            ->value;
    };
    EXPECT_EQ(std::get<double>(of("value_p99_db")), 0.3);
    EXPECT_EQ(std::get<double>(of("status_disagreement")), 0.005);
    EXPECT_TRUE(std::holds_alternative<std::monostate>(of("image_p99_de")));
    EXPECT_THAT(fields(full, ValueUnit::mps)[9].key, "value_p99_mps");
}

}  // namespace
}  // namespace stormcellar::accuracy
