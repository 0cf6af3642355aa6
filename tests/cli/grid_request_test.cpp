// Tests how the options of `stormcellar grid` are interpreted.
#include "cli/grid/grid_request.h"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

namespace stormcellar::cli {
namespace {

Result<grid::GridSpec> spec_for(const std::string& arguments, double latitude_deg,
                                double longitude_deg) {
    GridOptions options;
    CLI::App app;
    add_grid_options(app, options);
    app.parse("file -o out.nc " + arguments);
    const auto request = parse_request(options);
    if (!request) return pass_on(request);
    const auto center =
        request->center_deg.value_or(std::array<double, 2>{latitude_deg, longitude_deg});
    return spec_about(*request, center[0], center[1]);
}

Result<GridRequest> request_for(const std::string& arguments) {
    GridOptions options;
    CLI::App app;
    add_grid_options(app, options);
    app.parse("file -o out.nc " + arguments);
    return parse_request(options);
}

TEST(GridRequest, DerivedMomentsAreDealiasedAndHaveAMotion) {
    using level2::Moment;
    using retrieve::Dealiasing;
    const auto right = request_for("--moment SRV");
    ASSERT_TRUE(right) << right.error().message;
    EXPECT_EQ(right->derived.dealiasing, Dealiasing::automatic);
    EXPECT_EQ(right->derived.motion.rule, retrieve::MotionRule::right);
    const auto given = request_for("--moment VEL,SRV --dealias region --storm-motion 180/12");
    ASSERT_TRUE(given) << given.error().message;
    EXPECT_EQ(given->moments(), (std::vector{Moment::veld, Moment::srv}));
    EXPECT_EQ(given->derived.dealiasing, Dealiasing::region);
    EXPECT_EQ(given->derived.motion.rule, retrieve::MotionRule::given);
    EXPECT_NEAR(given->derived.motion.motion.v_mps, 12, 1e-9);
    EXPECT_EQ(request_for("--moment SRV --dealias off").error().message,
              "--dealias off does not go with --moment SRV, which is dealiased");
    EXPECT_EQ(request_for("--moment VEL --storm-motion auto").error().message,
              "--storm-motion needs --moment SRV");
    EXPECT_EQ(request_for("--moment SRV --storm-motion 500/1").error().code,
              ErrorCode::bad_argument);
}

TEST(GridRequest, NothingGivenIsTheDefaultGridAboutTheSite) {
    const auto spec = spec_for("", 35, -97);
    ASSERT_TRUE(spec);
    EXPECT_EQ(*spec, grid::default_spec(35, -97));
}

TEST(GridRequest, EveryNameOfAProjectionIsKnown) {
    using enum grid::Projection;
    const std::pair<const char*, grid::Projection> names[] = {
        {"azimuthal_equidistant", azimuthal_equidistant},
        {"aeqd", azimuthal_equidistant},
        {"latitude_longitude", latitude_longitude},
        {"lat-lon", latitude_longitude},
        {"latlon", latitude_longitude},
        {"lambert_conformal", lambert_conformal},
        {"lambert", lambert_conformal},
        {"lcc", lambert_conformal},
    };
    for (const auto& [name, projection] : names) {
        const auto spec = spec_for(std::string("--projection ") + name, 35, -97);
        ASSERT_TRUE(spec) << name;
        EXPECT_EQ(spec->projection, projection);
    }
    EXPECT_FALSE(spec_for("--projection mercator", 35, -97));
}

TEST(GridRequest, DegreesAreTakenAsTheyAre) {
    const auto spec = spec_for(
        "--projection lat-lon --spacing-deg 0.02 --extent-deg 5,4 --center 13.45,179.9", 35, -97);
    ASSERT_TRUE(spec);
    EXPECT_EQ(spec->spacing_deg, 0.02);
    EXPECT_EQ(spec->spacing_m, 0);
    EXPECT_EQ(spec->nx, 250);
    EXPECT_EQ(spec->ny, 200);
    EXPECT_EQ(spec->center_latitude_deg, 13.45);
    EXPECT_EQ(spec->center_longitude_deg, 179.9);
}

// At 60 N a degree of latitude is 111.412 km, and a degree of longitude is 55.800 km.
TEST(GridRequest, KilometresBecomeDegreesAsTheCentreHasThem) {
    const auto both = spec_for("--projection lat-lon --spacing-km 2 --extent-km 300,200", 60, 10);
    ASSERT_TRUE(both);
    EXPECT_NEAR(both->spacing_deg, 2 / 111.412, 1e-7);
    EXPECT_EQ(both->ny, 100);
    EXPECT_EQ(both->nx, 300);  // 5.3763 / 0.017951 = 299.5
    const auto mixed =
        spec_for("--projection lat-lon --spacing-deg 0.01 --extent-km 300,200", 60, 10);
    ASSERT_TRUE(mixed);
    EXPECT_EQ(mixed->spacing_deg, 0.01);
    EXPECT_EQ(mixed->ny, 180);  // 1.7951 / 0.01 = 179.5
    EXPECT_EQ(mixed->nx, 538);  // 5.3763 / 0.01 = 537.6
}

TEST(GridRequest, ParallelsAreGivenOrThoseOfTheCentre) {
    const auto given = spec_for("--projection lcc --parallels 33,45", 39, -97);
    ASSERT_TRUE(given);
    EXPECT_EQ(given->parallels_deg, (std::array<double, 2>{33, 45}));
    const auto own = spec_for("--projection lcc", 39, -97);
    ASSERT_TRUE(own);
    EXPECT_EQ(own->parallels_deg, (std::array<double, 2>{39, 39}));
    EXPECT_FALSE(spec_for("--projection lcc", 0, -97)) << "a cone cannot touch the equator";
    EXPECT_TRUE(spec_for("--projection lcc --parallels 10,20", 0, -97));
}

TEST(GridRequest, WhatTheSiteMakesImpossibleIsBadUsage) {
    const auto polar = spec_for("--projection lat-lon", 89.9, 0);
    ASSERT_FALSE(polar);
    EXPECT_EQ(polar.error().code, ErrorCode::bad_argument);
    EXPECT_FALSE(spec_for("--projection lat-lon", 90, 0));
}

TEST(GridRequest, DealiasTurnsVelIntoVeld) {
    using level2::Moment;
    using retrieve::Dealiasing;
    using Moments = std::vector<Moment>;
    const auto expect = [](const char* arguments, const Moments& moments, Dealiasing rung) {
        const auto request = request_for(arguments);
        ASSERT_TRUE(request) << arguments << ": " << request.error().message;
        EXPECT_EQ(request->moments(), moments) << arguments;
        EXPECT_EQ(request->derived.dealiasing, rung) << arguments;
    };
    expect("--moment VEL", {Moment::vel}, Dealiasing::automatic);
    expect("--moment VELD", {Moment::veld}, Dealiasing::automatic);
    // Nothing is dealiased, so the rung keeps its default.
    expect("--moment VEL --dealias off", {Moment::vel}, Dealiasing::automatic);
    expect("--moment REF --dealias off", {Moment::ref}, Dealiasing::automatic);
    expect("--moment VEL --dealias auto", {Moment::veld}, Dealiasing::automatic);
    expect("--moment VEL --dealias profile", {Moment::veld}, Dealiasing::profile);
    expect("--moment VELD --dealias region", {Moment::veld}, Dealiasing::region);
    expect("--moment REF,VEL --dealias anchored", {Moment::ref, Moment::veld},
           Dealiasing::anchored);
    expect("--moment VELD,VEL,REF --dealias region", {Moment::ref, Moment::vel, Moment::veld},
           Dealiasing::region);
    const auto all = request_for("--moment all --dealias auto");
    ASSERT_TRUE(all);
    EXPECT_EQ(all->moments().back(), Moment::veld);
    EXPECT_EQ(std::ranges::count(all->moments(), Moment::vel), 0);
    EXPECT_EQ(std::ranges::count(request_for("--moment all")->moments(), Moment::veld), 0);
}

TEST(GridRequest, DealiasThatMakesNoSenseIsBadUsage) {
    const std::vector<std::pair<const char*, const char*>> said = {
        {"--moment VEL --dealias strong",
         "--dealias 'strong' is no way to dealias; it must be off, auto, profile, region or "
         "anchored"},
        {"--moment REF --dealias auto", "--dealias needs --moment VEL"},
        {"--moment SW,RHO --dealias region", "--dealias needs --moment VEL"},
        {"--moment VELD --dealias off",
         "--dealias off does not go with --moment VELD, which is dealiased"},
    };
    for (const auto& [arguments, message] : said) {
        const auto request = request_for(arguments);
        ASSERT_FALSE(request) << arguments;
        EXPECT_EQ(request.error().code, ErrorCode::bad_argument);
        EXPECT_EQ(request.error().message, message);
    }
}

}  // namespace
}  // namespace stormcellar::cli
