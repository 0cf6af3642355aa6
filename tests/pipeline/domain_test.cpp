// Tests the meaning of [[domain]] tables, and the errors that are reported.
#include "pipeline/options/domain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/grid/projection.h"

namespace stormcellar::pipeline {
namespace {

using ::testing::HasSubstr;

struct Read {
    std::vector<Domain> domains;
    std::string complaint;
};

Read read(const std::string& text) {
    auto file = TomlFile::parse(text, "s.toml");
    EXPECT_TRUE(file);
    TomlTable root = file->root();
    Read result{read_domains(root), ""};
    if (const Status finished = file->finish(); !finished) {
        result.complaint = finished.error().message;
    }
    return result;
}

std::string complaint(const std::string& keys) {
    return read("[[domain]]\n" + keys).complaint;
}

TEST(Domain, EveryKeyIsTaken) {
    const Read all = read(
        "[[domain]]\nname = \"northeast\"\ncenter = [42.5, -75]\n"
        "projection = \"lambert_conformal\"\nparallels_deg = [40, 45]\nspacing_km = 2\n"
        "extent_km = [1000, 801]\nlevels_km = [1, 2.5]\nmoments = [\"REF\", \"VEL\"]\n"
        "stations = [\"KBGM\", \"KOKX\"]\ninterval_seconds = 120\noverlap = \"maximum\"\n"
        "overlap_km = 100\ntime_method = \"blend\"\n");
    EXPECT_EQ(all.complaint, "");
    ASSERT_EQ(all.domains.size(), 1U);
    const Domain& domain = all.domains[0];
    EXPECT_EQ(domain.name, "northeast");
    EXPECT_EQ(domain.spec.projection, grid::Projection::lambert_conformal);
    EXPECT_EQ(domain.spec.parallels_deg, (std::array<double, 2>{40, 45}));
    EXPECT_EQ(domain.spec.center_latitude_deg, 42.5);
    EXPECT_EQ(domain.spec.center_longitude_deg, -75);
    EXPECT_EQ(domain.spec.spacing_m, 2000);
    EXPECT_EQ(domain.spec.nx, 500);
    EXPECT_EQ(domain.spec.ny, 401);  // covers 801 km
    EXPECT_EQ(domain.spec.levels_m, (std::vector<double>{1000, 2500}));
    EXPECT_EQ(domain.moments, (std::vector{level2::Moment::ref, level2::Moment::vel}));
    EXPECT_EQ(domain.interval, std::chrono::seconds{120});
    EXPECT_EQ(domain.overlap, grid::Overlap::maximum);
    EXPECT_EQ(domain.overlap_length_m, 100'000);
    EXPECT_EQ(domain.time, grid::TimeMethod::blend);
    EXPECT_TRUE(domain.takes("KOKX"));
    EXPECT_FALSE(domain.takes("KTLX"));
}

TEST(Domain, DefaultsAreThoseOfTheShippedFile) {
    const Read all = read("[[domain]]\nname = \"a\"\ncenter = [35, -97]\nextent_km = [100, 100]\n");
    EXPECT_EQ(all.complaint, "");
    const Domain& domain = all.domains.at(0);
    EXPECT_EQ(domain.spec.projection, grid::Projection::azimuthal_equidistant);
    EXPECT_EQ(domain.spec.spacing_m, 1000);
    EXPECT_EQ(domain.spec.nx, 100);
    EXPECT_EQ(domain.spec.levels_m, grid::default_spec(0, 0).levels_m);
    EXPECT_EQ(domain.moments, std::vector{level2::Moment::ref});
    EXPECT_EQ(domain.interval, std::chrono::seconds{300});
    EXPECT_FALSE(domain.overlap);
    EXPECT_EQ(domain.time, grid::TimeMethod::advected);
    EXPECT_TRUE(domain.takes("KTLX"));
}

TEST(Domain, BoundsInDegreesAreThatBox) {
    const Read all = read(
        "[[domain]]\nname = \"us\"\nbounds = [-130, 20, -60, 55]\nspacing_deg = 0.01\n"
        "levels_km = \"1:3:1\"\n");
    EXPECT_EQ(all.complaint, "");
    const grid::GridSpec& spec = all.domains.at(0).spec;
    EXPECT_EQ(spec.projection, grid::Projection::latitude_longitude);
    EXPECT_EQ(spec.nx, 7000);
    EXPECT_EQ(spec.ny, 3500);
    EXPECT_EQ(spec.center_latitude_deg, 37.5);
    EXPECT_EQ(spec.center_longitude_deg, -95);
}

TEST(Domain, BoundsAcrossTheAntimeridianGoTheShortWay) {
    const Read all =
        read("[[domain]]\nname = \"a\"\nbounds = [170, 50, -170, 60]\nspacing_deg = 0.1\n");
    EXPECT_EQ(all.complaint, "");
    EXPECT_EQ(all.domains.at(0).spec.nx, 200);
    EXPECT_EQ(std::abs(all.domains.at(0).spec.center_longitude_deg), 180);
}

// The grid contains all points of the bounds, and is no wider than necessary.
TEST(Domain, BoundsOfAPlaneAreWithinTheGrid) {
    for (const std::string projection : {"azimuthal_equidistant", "lambert_conformal"}) {
        const Read all = read(
            "[[domain]]\nname = \"a\"\nbounds = [-110, 30, -80, 50]\n"
            "projection = \"" +
            projection + "\"\nspacing_km = 10\n");
        EXPECT_EQ(all.complaint, "");
        const grid::GridSpec& spec = all.domains.at(0).spec;
        const grid::GridProjection map(spec);
        double west = 1e9, east = -1e9;
        for (double latitude = 30; latitude <= 50; latitude += 0.5) {
            for (double longitude = -110; longitude <= -80; longitude += 0.5) {
                const grid::ColumnPoint column = map.to_column({latitude, longitude});
                EXPECT_GE(column.y, -0.51);
                EXPECT_LE(column.y, spec.ny - 0.49);
                west = std::min(west, column.x);
                east = std::max(east, column.x);
            }
        }
        EXPECT_GE(west, -0.51);
        EXPECT_LE(west, 1);
        EXPECT_LE(east, spec.nx - 0.49);
        EXPECT_GE(east, spec.nx - 2);
    }
}

TEST(Domain, WhatMakesNoSenseIsNamed) {
    const std::string good = "name = \"a\"\ncenter = [35, -97]\nextent_km = [100, 100]\n";
    EXPECT_EQ(complaint(good), "");
    EXPECT_THAT(complaint("center = [35, -97]\nextent_km = [9, 9]\n"),
                HasSubstr("name: must be given"));
    EXPECT_THAT(complaint("name = \"a.b\"\ncenter = [35, -97]\nextent_km = [9, 9]\n"),
                HasSubstr("letters, digits"));
    EXPECT_THAT(complaint("name = \"KTLX\"\ncenter = [35, -97]\nextent_km = [9, 9]\n"),
                HasSubstr("station's own"));
    EXPECT_THAT(complaint("name = \"a\"\n"), HasSubstr("either center or bounds"));
    EXPECT_THAT(complaint("name = \"a\"\ncenter = [35, -97]\n"), HasSubstr("needs extent_km"));
    EXPECT_THAT(complaint("name = \"a\"\ncenter = [35]\n"), HasSubstr("[latitude, longitude]"));
    EXPECT_THAT(complaint("name = \"a\"\nbounds = [1, 5, 2, 4]\n"), HasSubstr("west, south"));
    EXPECT_THAT(complaint(good + "spacing_deg = 1\n"), HasSubstr("latitude_longitude"));
    EXPECT_THAT(complaint(good + "projection = \"mercator\"\n"), HasSubstr("mercator"));
    EXPECT_THAT(complaint(good + "parallels_deg = [1, 2]\n"), HasSubstr("lambert_conformal"));
    EXPECT_THAT(complaint(good + "levels_km = \"1:2\"\n"), HasSubstr("BOTTOM:TOP:STEP"));
    EXPECT_THAT(complaint(good + "levels_km = [2, 1]\n"), HasSubstr("level"));
    EXPECT_THAT(complaint(good + "moments = [\"DBZ\"]\n"), HasSubstr("not a moment"));
    EXPECT_THAT(complaint(good + "moments = [\"REF\", \"SRV\"]\n"),
                HasSubstr("SRV is made for single stations"));
    EXPECT_THAT(complaint(good + "moments = []\n"), HasSubstr("at least one moment"));
    EXPECT_THAT(complaint(good + "stations = [\"ktlx\"]\n"), HasSubstr("four capital"));
    EXPECT_THAT(complaint(good + "overlap = \"min\"\n"), HasSubstr("maximum"));
    EXPECT_THAT(complaint(good + "time_method = \"now\"\n"), HasSubstr("advected"));
    EXPECT_THAT(complaint(good + "interval_seconds = 1\n"), HasSubstr("out of range"));
    EXPECT_THAT(complaint("name = \"a\"\ncenter = [35, -97]\nspacing_km = 0.05\n"
                          "extent_km = [9000, 9]\n"),
                HasSubstr("cells"));
    EXPECT_THAT(complaint(good + "[[domain]]\n" + good), HasSubstr("another domain"));
}

}  // namespace
}  // namespace stormcellar::pipeline
