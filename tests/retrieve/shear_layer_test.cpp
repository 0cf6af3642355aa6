// Tests layers, tracks and maxima with vortices whose places are known, and with the tornado
// between Bridge Creek and Moore of 3 May 1999.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/degree.h"
#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/retrieve/velocity_shear.h"
#include "tests/retrieve/velocity_sweep.h"
#include "tests/testing/data.h"

namespace stormcellar::retrieve {
namespace {

using grid::CellStatus;

constexpr grid::GeoPoint radar{35.3, -97.3};

struct Spot {
    double azimuth_deg = 0, range_m = 0;
    double per_s = 0;  // shear in the middle
};

// Small vortices in calm air. Each reaches 3 km.
double velocity_of(const std::vector<Spot>& spots, double azimuth_deg, double range_m) {
    double sum = 0;
    for (const Spot& spot : spots) {
        const double turn = turn_deg(spot.azimuth_deg, azimuth_deg) * degree;
        const double across = range_m * turn;
        const double away = std::hypot(across, range_m - spot.range_m) / 3000;
        sum += spot.per_s * across * std::exp(-away * away);
    }
    return sum;
}

SweepSpec sweep_at(double elevation_deg) {
    SweepSpec spec;
    spec.azimuths_deg = even_azimuths(720);
    spec.elevation_deg = elevation_deg;
    spec.gates = 600;
    return spec;
}

level2::Volume volume_of_spots(const std::vector<Spot>& spots, double elevation_deg = 0.5) {
    return volume_of(sweep_at(elevation_deg), [&](double azimuth_deg, double range_m) {
        return velocity_of(spots, azimuth_deg, range_m);
    });
}

ShearLayer layer_of(const level2::Volume& volume, const Dealiased& dealiased,
                    LayerBounds bounds = low_level) {
    auto layers = shear_layers(volume, dealiased, std::span(&bounds, 1));
    EXPECT_TRUE(layers) << (layers ? "" : layers.error().message);
    return layers ? std::move(layers->at(0)) : ShearLayer{};
}
ShearLayer layer_of(const level2::Volume& volume, LayerBounds bounds = low_level) {
    return layer_of(volume, no_folds(volume), bounds);
}

std::size_t count(const ShearLayer& layer, CellStatus status) {
    std::size_t cells = 0;
    for (const ShearCell& cell : layer.cells)
        cells += cell.status == status ? 1 : 0;
    return cells;
}

TEST(ShearLayer, FindsVorticesWhereTheyAre) {
    const std::vector<Spot> spots = {{255.3, 38.5e3, 0.01}, {80.1, 60e3, 0.02}, {0.1, 25e3, 0.006}};
    const ShearLayer layer = layer_of(volume_of_spots(spots));
    const auto maxima = strongest_maxima(layer, radar);
    ASSERT_GE(maxima.size(), 3U);
    const grid::SiteFrame frame(radar.latitude_deg, radar.longitude_deg);
    const grid::BeamGeometry beam(40, 0);
    const Spot* by_strength[] = {&spots[1], &spots[0], &spots[2]};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto gate = beam.forward({by_strength[i]->range_m, 0.5});
        const auto there = grid::SiteFrame::to_plane({by_strength[i]->azimuth_deg, gate.arc_m});
        const auto found = grid::SiteFrame::to_plane(frame.to_polar(maxima[i].position));
        EXPECT_LT(std::hypot(found.x_m - there.x_m, found.y_m - there.y_m), 400) << i;
        EXPECT_NEAR(maxima[i].height_m, gate.height_m, 10);
        EXPECT_NEAR(maxima[i].azimuthal_per_s, by_strength[i]->per_s, 0.15 * by_strength[i]->per_s);
        EXPECT_GT(maxima[i].error_per_s, 0);
    }
}

TEST(ShearLayer, MaximaKeepTheirDistance) {
    const ShearLayer layer =
        layer_of(volume_of_spots({{100, 50e3, 0.02}, {108, 50e3, 0.015}, {280, 40e3, 0.01}}));
    MaximaOptions options;
    options.least_separation_m = 10'000;  // the first two are 7 km apart
    auto maxima = strongest_maxima(layer, radar, options);
    ASSERT_GE(maxima.size(), 2U);
    EXPECT_NEAR(maxima[0].from_radar.azimuth_deg, 100, 1);
    EXPECT_NEAR(maxima[1].from_radar.azimuth_deg, 280, 1);
    options.least_separation_m = 5000;
    maxima = strongest_maxima(layer, radar, options);
    ASSERT_GE(maxima.size(), 3U);
    EXPECT_NEAR(maxima[1].from_radar.azimuth_deg, 108, 1);
    options.most = 1;
    EXPECT_EQ(strongest_maxima(layer, radar, options).size(), 1U);
    options.most = 0;
    EXPECT_TRUE(strongest_maxima(layer, radar, options).empty());
    options = {};
    options.least_errors = 1e6;
    EXPECT_TRUE(strongest_maxima(layer, radar, options).empty());
    EXPECT_TRUE(strongest_maxima({}, radar).empty());
}

// The lower sweep has the weaker vortex. A layer takes the strongest vortex of the sweeps in it.
TEST(ShearLayer, TakesTheLargestShearOfTheSweepsInIt) {
    const auto sweep = [](level2::Volume& volume, double elevation_deg, double per_s) {
        add_sweep(volume, sweep_at(elevation_deg), [=](double azimuth_deg, double range_m) {
            return velocity_of({{255, 40e3, per_s}}, azimuth_deg, range_m);
        });
    };
    level2::Volume volume;
    sweep(volume, 0.5, 0.008);
    sweep(volume, 1.5, 0.012);
    sweep(volume, 6, 0.02);  // at 4.3 km
    const auto strongest = [&](LayerBounds bounds) {
        return strongest_maxima(layer_of(volume, bounds), radar).at(0);
    };
    EXPECT_NEAR(strongest(low_level).azimuthal_per_s, 0.012, 0.0018);
    EXPECT_NEAR(strongest(low_level).height_m, 1140, 20);
    EXPECT_NEAR(strongest(mid_level).azimuthal_per_s, 0.02, 0.003);
    EXPECT_NEAR(strongest(mid_level).height_m, 4280, 30);
    EXPECT_NEAR(strongest({0, 1000}).azimuthal_per_s, 0.008, 0.0012);
}

TEST(ShearLayer, TellsItsStatesApart) {
    SweepSpec spec = sweep_at(0.5);
    std::erase_if(spec.azimuths_deg, [](float deg) { return deg > 300 && deg < 310; });
    const auto volume = volume_of(spec, [](double azimuth_deg, double range_m) {
        if (azimuth_deg < 90) return std::numeric_limits<double>::quiet_NaN();
        if (azimuth_deg < 180) return range_folded;
        return range_m * 4e-4;
    });
    Dealiased dealiased = no_folds(volume);
    for (std::size_t radial = 400; radial < 440; ++radial)  // 200 to 220 degrees
        std::fill_n(dealiased.sweeps[0].ambiguous.begin() + static_cast<long>(radial * 600), 600,
                    1);
    const ShearLayer layer = layer_of(volume, dealiased);
    const auto status = [&](std::size_t azimuth_deg, std::size_t arc_km) {
        return layer.at(2 * azimuth_deg, 4 * arc_km).status;
    };
    EXPECT_EQ(status(45, 50), CellStatus::no_echo);
    EXPECT_EQ(status(135, 50), CellStatus::range_folded);
    EXPECT_EQ(status(210, 50), CellStatus::ambiguous);
    EXPECT_EQ(status(250, 50), CellStatus::value);
    EXPECT_EQ(status(305, 50), CellStatus::not_seen) << "no radials";
    EXPECT_EQ(status(250, 140), CellStatus::not_seen) << "above the layer";
    EXPECT_EQ(status(45, 140), CellStatus::not_seen);
    for (const ShearCell& cell : layer.cells) {
        ASSERT_TRUE(std::isfinite(cell.azimuthal_per_s) && std::isfinite(cell.error_per_s));
        ASSERT_EQ(cell.error_per_s > 0, cell.status == CellStatus::value);
    }
}

TEST(ShearLayer, OddVolumesSeeNothing) {
    const level2::Volume empty;
    EXPECT_EQ(count(layer_of(empty), CellStatus::not_seen),
              ShearLayer::azimuths * ShearLayer::arcs);
    SweepSpec one_gate = sweep_at(0.5), unknown_nyquist = sweep_at(0.5);
    one_gate.gates = 1;
    one_gate.azimuths_deg = {10};
    unknown_nyquist.nyquist_mps = 0;
    for (const SweepSpec& odd : {one_gate, unknown_nyquist})
        EXPECT_EQ(
            count(layer_of(volume_of(odd, [](double, double) { return 5.0; })), CellStatus::value),
            0U);
    const level2::Volume quiet = volume_of(
        sweep_at(0.5), [](double, double) { return std::numeric_limits<double>::quiet_NaN(); });
    EXPECT_EQ(count(layer_of(quiet), CellStatus::value), 0U);
    EXPECT_GT(count(layer_of(quiet), CellStatus::no_echo), 200'000U);
    const LayerBounds upside_down{2000, 0};
    EXPECT_FALSE(shear_layers(quiet, no_folds(quiet), std::span(&upside_down, 1)));
    Dealiased wrong = no_folds(quiet);
    wrong.sweeps[0].folds.clear();
    EXPECT_FALSE(shear_layers(quiet, wrong, std::span(&low_level, 1)));
}

TEST(RotationTrack, KeepsTheLargestShearOfEachCell) {
    const auto at_minute = [](int minute, const Spot& spot) {
        SweepSpec spec = sweep_at(0.5);
        spec.time = UtcTime(std::chrono::minutes(minute));
        return layer_of(volume_of(spec, [&](double azimuth_deg, double range_m) {
            return velocity_of({spot}, azimuth_deg, range_m);
        }));
    };
    ShearLayer track;
    ASSERT_TRUE(add_to_track(track, at_minute(0, {250, 40e3, 0.01})));
    ASSERT_TRUE(add_to_track(track, at_minute(5, {262, 42e3, 0.02})));
    ASSERT_TRUE(add_to_track(track, at_minute(10, {274, 44e3, 0.015})));
    const auto maxima = strongest_maxima(track, radar);
    ASSERT_GE(maxima.size(), 3U);
    const double azimuths_deg[] = {262, 274, 250};
    const int minutes[] = {5, 10, 0};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(maxima[i].from_radar.azimuth_deg, azimuths_deg[i], 0.5);
        EXPECT_EQ(maxima[i].time, UtcTime(std::chrono::minutes(minutes[i])));
    }
    ShearLayer other = at_minute(15, {250, 40e3, 0.01});
    other.station = "KTLX";
    EXPECT_FALSE(add_to_track(track, other));
    other.station = track.station;
    other.bounds = mid_level;
    EXPECT_FALSE(add_to_track(track, other));
}

// The tornado is at 35.25 N 97.69 W in the lowest sweep. There are no stronger maxima in the sweep
// or in the layer.
TEST(GoldenShear, FindsTheTornadoOfMoore) {
    STORMCELLAR_NEED_DATA();
    const auto decoded = level2::decode_file(testing::real_file("volumes/KTLX19990503_235621.gz"));
    ASSERT_TRUE(decoded);
    const level2::Volume& volume = decoded->volume;
    const Dealiased dealiased = dealias(volume, Dealiasing::anchored);
    Dealiased lowest;
    lowest.sweeps = {dealiased.sweeps.at(0)};
    ASSERT_NEAR(volume.sweeps[lowest.sweeps[0].sweep].mean_elevation_deg(), 0.45, 0.1);
    const auto antenna = level2::antenna_position(volume);
    ASSERT_TRUE(antenna);
    const grid::SiteFrame tornado(35.25, -97.69);
    for (const Dealiased& folds : {lowest, dealiased}) {
        const auto maxima = strongest_maxima(layer_of(volume, folds),
                                             {antenna->latitude_deg, antenna->longitude_deg});
        ASSERT_FALSE(maxima.empty());
        EXPECT_LT(tornado.to_polar(maxima[0].position).arc_m, 1500);
        EXPECT_GT(maxima[0].azimuthal_per_s, 0.02);
        EXPECT_LT(maxima[0].height_m, 600);
    }
    ShearOptions options;
    options.median = MedianFilter::always;
    const auto filtered = shear_layers(volume, lowest, std::span(&low_level, 1), options);
    ASSERT_TRUE(filtered);
    const auto maxima =
        strongest_maxima(filtered->at(0), {antenna->latitude_deg, antenna->longitude_deg});
    ASSERT_FALSE(maxima.empty());
    EXPECT_LT(maxima[0].azimuthal_per_s, 0.02)
        << "a median of radials 1 degree apart removes the maximum";
}

}  // namespace
}  // namespace stormcellar::retrieve
