#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/accuracy/ladder.h"

namespace stormcellar::accuracy {
namespace {

using ::testing::HasSubstr;

LadderRow table_row(const char* step, const char* name, double time_s, std::optional<double> p99) {
    LadderRow made;
    made.step = step;
    made.name = name;
    made.time_s = time_s;
    if (p99) made.value = ErrorSummary{100, *p99 / 3, *p99 / 2, *p99, *p99 * 2};
    return made;
}

TEST(LadderTable, IsAlignedByCharactersBelowItsSteps) {
    std::vector<LadderRow> rows = {table_row("beam", "4/3 earth", 0.012, 0.25),
                                   table_row("beam", "ray traced", 1.5, 0),
                                   table_row("averaging",
                                             "d\xc3\xa9"
                                             "cibels",
                                             0.001, 1.25)};
    rows[0].position_max_m = 557;
    mark_pareto(rows);
    EXPECT_EQ(format_table(rows, ValueUnit::db),
              "              first  position   usual  99 in 100  largest  worth\n"
              "step           time         m      dB         dB       dB     it\n"
              "beam\n"
              "  4/3 earth   12 ms       557  0.0834       0.25      0.5    yes\n"
              "  ray traced  1.5 s         -       0          0        0    yes\n"
              "averaging\n"
              "  d\xc3\xa9"
              "cibels     1 ms         -   0.417       1.25      2.5    yes\n");
    EXPECT_EQ(format_table({}, ValueUnit::db), "");
}

// Regression of 2026-11-25: the table had 175 columns and wrapped on every terminal.
TEST(LadderTable, FitsAHundredColumnsWhateverItHolds) {
    LadderRow full = table_row(
        "interpolation", "all values of each step, in their order, and longer", 123.456, 123.456);
    full.kept_time_s = 100.123;
    full.position_max_m = 123456;
    full.position_rms_m = 12345;
    full.image_p99_de = 12.345;
    full.status = StatusCounts{1000, 123};
    for (const ValueUnit unit : {ValueUnit::db, ValueUnit::mps, ValueUnit::ratio}) {
        const std::string table = format_table(std::vector{full}, unit);
        std::istringstream lines(table);
        for (std::string line; std::getline(lines, line);)
            EXPECT_LE(line.size(), 100U) << line;
        EXPECT_THAT(table, HasSubstr("...")) << "only the name is shortened";
        EXPECT_THAT(table, HasSubstr("12.30"));
    }
}

}  // namespace
}  // namespace stormcellar::accuracy
