// Tests the classes of hydrometeors on synthetic layers, and where there is nothing to classify.
#include "stormcellar/retrieve/hydrometeors.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/degree.h"
#include "stormcellar/grid/beam_geometry.h"
#include "tests/retrieve/layered_volume.h"

namespace stormcellar::retrieve {
namespace {

constexpr double melted_below_m = 2500, frozen_above_m = 3000, echo_top_m = 8000;
constexpr double core_arc_m = 30e3, core_radius_m = 5e3;

enum class Core : std::uint8_t { none, hail, heavy_rain };

// Two cores are 30 km east and west of the radar, in stratiform rain.
Core core_at(double azimuth_deg, double arc_m) {
    const double x = arc_m * std::sin(azimuth_deg * degree),
                 y = arc_m * std::cos(azimuth_deg * degree);
    if (std::hypot(x - core_arc_m, y) < core_radius_m) return Core::hail;
    return std::hypot(x + core_arc_m, y) < core_radius_m ? Core::heavy_rain : Core::none;
}

DualPoint point_at(double azimuth_deg, double arc_m, double height_m) {
    if (height_m > echo_top_m) return {};
    switch (core_at(azimuth_deg, arc_m)) {
        case Core::hail:
            return height_m < frozen_above_m ? DualPoint{60, 0.3, 0.93, 1}
                                             : DualPoint{45, 0.2, 0.985, 0};
        case Core::heavy_rain:
            if (height_m < melted_below_m) return {50, 2.3, 0.985, 2};
            break;
        case Core::none:
            break;
    }
    return MeltingProfile{melted_below_m, frozen_above_m}.at(height_m);
}

// Returns the class of the air at a point; none where two classes are within 250 m.
Hydrometeor truth_at(double azimuth_deg, double arc_m, double height_m) {
    const auto is_at = [&](double edge_m) { return std::abs(height_m - edge_m) < 250; };
    const Core core = core_at(azimuth_deg, arc_m);
    if (height_m < melted_below_m - 250)
        return core == Core::hail         ? Hydrometeor::hail
               : core == Core::heavy_rain ? Hydrometeor::heavy_rain
                                          : Hydrometeor::rain;
    if (height_m > echo_top_m - 500) return Hydrometeor::none;
    if (core == Core::hail)
        return height_m > frozen_above_m + 500 ? Hydrometeor::graupel : Hydrometeor::none;
    // The lowest correlation is three fifths of the way down the melting layer.
    if (std::abs(height_m - 2700) < 100) return Hydrometeor::wet_snow;
    if (is_at(melted_below_m) || is_at(frozen_above_m) || height_m < frozen_above_m)
        return Hydrometeor::none;
    return Hydrometeor::dry_snow;
}

using Confusion = std::array<std::array<std::int64_t, hydrometeor_count>, hydrometeor_count>;

LayeredSpec scene_spec(int radials = 120) {
    LayeredSpec spec;
    spec.elevations_deg = {0.5, 2.4, 4.3, 6, 9.9};
    spec.radials = radials;
    spec.gates = 200;
    return spec;
}

Confusion confusion_of(const level2::Volume& volume) {
    Confusion table{};
    const grid::BeamGeometry beam(40, 0);
    for (const SweepHydrometeors& of : hydrometeors(volume).sweeps) {
        const level2::Sweep& sweep = volume.sweeps[of.sweep];
        const level2::SweepMoment& moment = sweep.moments[of.moment];
        std::size_t at = 0;
        for (const level2::Radial& radial : sweep.radials)
            for (std::int32_t gate = 0; gate < moment.gate_stride; ++gate, ++at) {
                const auto place = beam.forward({moment.range_m(gate), sweep.mean_elevation_deg()});
                const Hydrometeor truth =
                    truth_at(static_cast<double>(radial.azimuth_deg), place.arc_m, place.height_m);
                ++table[static_cast<std::size_t>(truth)][static_cast<std::size_t>(of.classes[at])];
            }
    }
    return table;
}

// Returns the share of the gates of class `truth` that were named `named`.
double share_of(const Confusion& table, Hydrometeor truth, Hydrometeor named) {
    const auto& row = table[static_cast<std::size_t>(truth)];
    std::int64_t all = 0;
    for (const std::int64_t count : row)
        all += count;
    return static_cast<double>(row[static_cast<std::size_t>(named)]) / static_cast<double>(all);
}

std::string table_text(const Confusion& table) {
    std::string text;
    for (std::size_t truth = 1; truth < hydrometeor_count; ++truth) {
        const auto kind = static_cast<Hydrometeor>(truth);
        if (share_of(table, kind, kind) != share_of(table, kind, kind)) continue;  // no gates
        text += fmt::format("{:<15}", hydrometeor_name(kind));
        for (std::size_t named = 0; named < hydrometeor_count; ++named) {
            const auto other = static_cast<Hydrometeor>(named);
            const double share = share_of(table, kind, other);
            if (share > 0.0005)
                text += fmt::format("  {} {:.1f} %", hydrometeor_name(other), 100 * share);
        }
        text += "\n";
    }
    return text;
}

TEST(Hydrometeors, AreNamedInSyntheticLayers) {
    const Confusion table = confusion_of(layered_volume(scene_spec(360), point_at));
    const std::string text = table_text(table);
    const auto expect = [&](Hydrometeor kind, double least) {
        EXPECT_GE(share_of(table, kind, kind), least) << text;
    };
    expect(Hydrometeor::rain, 0.99);
    expect(Hydrometeor::heavy_rain, 0.83);
    expect(Hydrometeor::dry_snow, 0.99);
    expect(Hydrometeor::wet_snow, 0.99);
    expect(Hydrometeor::graupel, 0.93);
    expect(Hydrometeor::hail, 0.88);
}

TEST(Hydrometeors, NameTheLayerInUse) {
    const level2::Volume volume = layered_volume(scene_spec(), point_at);
    EXPECT_EQ(hydrometeors(volume).layer.substr(0, 6), "from 2");
    LayeredSpec low = scene_spec();
    low.elevations_deg = {0.5};
    // The antenna of KTLX is 390 m above sea level, and 0 C is assumed at 4200 m.
    EXPECT_EQ(hydrometeors(layered_volume(low, point_at)).layer,
              "assumed from 3310 to 3810 m above the antenna, with 0 C at 4200 m above sea level: "
              "no melting layer found: no sweep from 4 to 10 degrees has dual polarization");
}

TEST(Hydrometeors, NeedDualPolarization) {
    EXPECT_TRUE(hydrometeors(level2::Volume{}).sweeps.empty());
    level2::Volume single = layered_volume(scene_spec(), point_at);
    for (level2::Sweep& sweep : single.sweeps)
        sweep.moments.resize(1);
    EXPECT_TRUE(hydrometeors(single).sweeps.empty());
}

TEST(Hydrometeors, StandDamagedAzimuthsAndClearAir) {
    level2::Volume volume =
        layered_volume(scene_spec(), [](double, double, double) { return DualPoint{}; });
    for (const SweepHydrometeors& of : hydrometeors(volume).sweeps)
        for (const Hydrometeor kind : of.classes)
            ASSERT_EQ(kind, Hydrometeor::none);
    volume = layered_volume(scene_spec(), point_at);
    volume.sweeps[0].radials[7].azimuth_deg = std::nanf("");
    EXPECT_EQ(hydrometeors(volume).sweeps.size(), volume.sweeps.size());
}

}  // namespace
}  // namespace stormcellar::retrieve
