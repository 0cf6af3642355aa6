// Tests that two machines with the same volume answer with the same entity tags and bytes, so a
// viewer sees no difference when a proxy switches between the machines.
#include <gtest/gtest.h>

#include "tests/web/asked.h"
#include "tests/web/pictured_storm.h"
#include "web/service/sources.h"

namespace stormcellar::web {
namespace {

std::shared_ptr<const Doors> doors_of(const PicturedStorm& storm, Measures& measures) {
    WebSetup setup;
    setup.catalog = storm.catalog();
    setup.cache = storm.cache();
    const auto sources = open_sources(setup);
    EXPECT_TRUE(sources);
    return doors_to(*sources, measures);
}

Answer asked_of(const Doors& doors, const std::string& target) {
    return asked(*doors.find(target.substr(0, target.find('?'))), target);
}

class SameAnswers : public PictureTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(SameAnswers, HaveTheSameTagAndBytes) {
    static const PicturedStorm other{"6500KTLX_other.gz", std::chrono::hours{30}};
    Measures here_measures, there_measures;
    const auto here = doors_of(*storm_, here_measures), there = doors_of(other, there_measures);
    const Answer ours = asked_of(*here, GetParam());
    const Answer theirs = asked_of(*there, GetParam());
    ASSERT_EQ(ours.status, 200U) << body_of(ours);
    ASSERT_EQ(theirs.status, 200U) << body_of(theirs);
    EXPECT_NE(header_of(ours, "ETag"), "");
    EXPECT_EQ(header_of(ours, "ETag"), header_of(theirs, "ETag"));
    EXPECT_TRUE(body_of(ours) == body_of(theirs));
}
INSTANTIATE_TEST_SUITE_P(
    Of, SameAnswers,
    ::testing::Values(
        "/api/v1/grids/KTLX/REF/1999-05-03T23:56:21Z",
        "/api/v1/grids/KTLX/REF/1999-05-03T23:56:21Z/file", "/api/v1/grids/KTLX/VEL/latest/packed",
        "/api/v1/grids/KTLX/REF/latest/netcdf",
        "/api/v1/stations/KTLX/volumes/1999-05-03T23:56:21Z/sweeps/0/REF",
        "/tiles/KTLX/composite.REF/1999-05-03T23:56:21Z/7/29/50.png",
        "/frames/KTLX.png?product=composite&width=400&height=300&time=1999-05-03T23:56:21Z",
        "/frames/KTLX.png?product=ppi&width=400&height=300&time=1999-05-03T23:56:21Z",
        "/api/v1/cells", "/placefiles/cells.txt?area=KTLX", "/volumes/KTLX/KTLX19990503_235621"));

}  // namespace
}  // namespace stormcellar::web
