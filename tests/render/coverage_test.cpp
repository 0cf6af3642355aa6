#include "render/map/coverage.h"

#include <gtest/gtest.h>

#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

TEST(Coverage, CountsColumnsSeenAtAllAndSeenLow) {
    const grid::GridSpec spec = [] {
        grid::GridSpec made = small_spec(10, 3);
        made.levels_m = {1000, 2999, 3000};
        return made;
    }();
    std::vector<ColumnSummary> columns(10);
    columns[0].lowest_seen = 0;
    columns[1].lowest_seen = 1;
    columns[2].lowest_seen = 2;
    const Coverage coverage = coverage_of(columns, spec);
    EXPECT_DOUBLE_EQ(coverage.seen, 0.3);
    EXPECT_DOUBLE_EQ(coverage.seen_low, 0.2);
    EXPECT_EQ(coverage_of({}, spec).seen, 0);
}

TEST(Coverage, PercentDoesNotRoundToAllOrNothing) {
    for (const auto& [share, text] : {std::pair{0.0, "0 %"},
                                      {0.0001, "< 1 %"},
                                      {0.01, "1 %"},
                                      {0.874, "87 %"},
                                      {0.9999, "> 99 %"},
                                      {1.0, "100 %"}})
        EXPECT_EQ(percent_text(share), text);
}

}  // namespace
}  // namespace stormcellar::render
