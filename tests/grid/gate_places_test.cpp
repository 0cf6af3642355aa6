#include "grid/beam/gate_places.h"

#include <cmath>

#include <gtest/gtest.h>

namespace stormcellar::grid {
namespace {

constexpr double accuracy_m = 0.02;  // as in grid/beam/gate_places.h

level2::SweepMoment gates(int first_m, int spacing_m, int count) {
    level2::SweepMoment moment;
    moment.first_gate_m = first_m;
    moment.gate_spacing_m = spacing_m;
    moment.gate_stride = count;
    return moment;
}

double worst_of(const BeamModel& beam, double elevation_deg, double half_beam_deg) {
    const level2::SweepMoment moment = gates(-375, 250, 1882);  // to 470 km
    const GatePlaces places(moment, beam, elevation_deg, half_beam_deg);
    double worst_m = 0;
    for (const double halves : {-1.0, -0.6, -0.01, 0.0, 0.3, 0.58, 1.0}) {
        const double offset_deg = halves * half_beam_deg;
        const BeamPath path = beam.path(elevation_deg + offset_deg);
        for (std::int32_t gate = 0; gate < moment.gate_stride; gate += 7) {
            const auto place = places.at(gate, offset_deg);
            if (!place) return HUGE_VAL;
            const EarthPoint exact = path.at(moment.range_m(gate));
            const double off_m =
                std::hypot(place->arc_m - exact.arc_m, place->height_m - exact.height_m);
            worst_m = std::max(worst_m, off_m);
        }
    }
    return worst_m;
}

TEST(GatePlaces, AreThoseOfTheBeamModel) {
    double worst_m = 0;
    for (const auto& [latitude_deg, altitude_m] :
         {std::pair{35.3, 400.0}, {78.0, -100.0}, {0.0, 4000.0}, {-71.0, 0.0}}) {
        const BeamModel beam = BeamModel::four_thirds(latitude_deg, altitude_m);
        for (const double half_beam_deg : {0.275, 0.475}) {
            for (const double elevation_deg : {-5.0, -0.2, 0.0, 0.5, 4.3, 19.5, 45.0, 60.0}) {
                worst_m = std::max(worst_m, worst_of(beam, elevation_deg, half_beam_deg));
            }
        }
    }
    EXPECT_LT(worst_m, accuracy_m);
    EXPECT_GT(worst_m, accuracy_m / 10) << "the stated accuracy is too loose";
}

TEST(GatePlaces, ThereAreNoneWhereTheBeamDoesNotGo) {
    const GatePlaces places(gates(0, 1000, 400), BeamModel::four_thirds(35, 0), 0.5, 0.475);
    EXPECT_FALSE(places.at(-1, 0));
    EXPECT_FALSE(places.at(400, 0));
    // A traced ray half a beam below the sweep soon meets the ground. A ray that starts below the
    // horizon only falls.
    const BeamModel traced = BeamModel::traced(35, 0, RefractivityProfile::reference());
    const GatePlaces low(gates(0, 1000, 400), traced, -0.3, 0.475);
    EXPECT_TRUE(low.at(50, 0));
    EXPECT_TRUE(low.at(100, 0.3)) << "only the lower edge is below the ground";
    const GatePlaces buried(gates(0, 1000, 400), traced, -3, 0.475);
    EXPECT_FALSE(buried.at(100, 0));
}

}  // namespace
}  // namespace stormcellar::grid
