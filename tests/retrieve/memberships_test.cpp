// Tests the class of single gates whose variables are those of textbook cases.
#include "retrieve/hydrometeors/memberships.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar::retrieve {
namespace {

constexpr float no_kdp_signal = -30;

GateVariables smooth_gate(float dbz, float zdr_db, float correlation, float log_kdp) {
    return {dbz, zdr_db, correlation, log_kdp, 1, 3};
}

TEST(Memberships, NameTextbookGates) {
    struct Known {
        GateVariables gate;
        BeamPlace place = BeamPlace::below;
        Hydrometeor kind = Hydrometeor::none;
    };
    const std::vector<Known> known = {
        {smooth_gate(30, 0.8F, 0.99F, -8), BeamPlace::below, Hydrometeor::rain},
        {smooth_gate(51, 2.2F, 0.98F, 3), BeamPlace::below, Hydrometeor::heavy_rain},
        {smooth_gate(33, 3, 0.98F, -8), BeamPlace::below, Hydrometeor::big_drops},
        {smooth_gate(62, 0.2F, 0.92F, 0), BeamPlace::below, Hydrometeor::hail},
        {smooth_gate(36, 1.4F, 0.93F, -10), BeamPlace::inside, Hydrometeor::wet_snow},
        {smooth_gate(24, 0.15F, 0.99F, no_kdp_signal), BeamPlace::above, Hydrometeor::dry_snow},
        {smooth_gate(14, 1.5F, 0.99F, 2), BeamPlace::above, Hydrometeor::ice_crystals},
        {smooth_gate(44, 0.3F, 0.98F, no_kdp_signal), BeamPlace::above, Hydrometeor::graupel},
        {{14, 4, 0.7F, no_kdp_signal, 2.5F, 25}, BeamPlace::below, Hydrometeor::biological},
        {{40, -0.5F, 0.75F, no_kdp_signal, 7, 45}, BeamPlace::below, Hydrometeor::ground_clutter},
    };
    for (const Known& one : known)
        EXPECT_EQ(hydrometeor_name(best_class(one.gate, one.place)), hydrometeor_name(one.kind));
}

// The melting layer decides between classes that look alike.
TEST(Memberships, DependOnTheMeltingLayer) {
    const GateVariables weak = smooth_gate(24, 0.2F, 0.99F, no_kdp_signal);
    EXPECT_EQ(best_class(weak, BeamPlace::below), Hydrometeor::rain);
    EXPECT_EQ(best_class(weak, BeamPlace::center_below), Hydrometeor::rain);
    EXPECT_EQ(best_class(weak, BeamPlace::inside), Hydrometeor::dry_snow);
    EXPECT_EQ(best_class(weak, BeamPlace::center_above), Hydrometeor::dry_snow);
    EXPECT_EQ(best_class(weak, BeamPlace::above), Hydrometeor::dry_snow);
}

TEST(Memberships, MovingEchoIsNoGroundClutter) {
    GateVariables gate = {40, -0.5F, 0.75F, no_kdp_signal, 7, 45};
    gate.speed_mps = 0.5F;
    EXPECT_EQ(best_class(gate, BeamPlace::below), Hydrometeor::ground_clutter);
    gate.speed_mps = 5;
    EXPECT_NE(best_class(gate, BeamPlace::below), Hydrometeor::ground_clutter);
}

TEST(Memberships, LeaveOutUnknownVariables) {
    EXPECT_EQ(best_class({}, BeamPlace::below), Hydrometeor::none);
    GateVariables gate;
    gate.reflectivity_dbz = 30;
    EXPECT_EQ(best_class(gate, BeamPlace::below), Hydrometeor::none) << "reflectivity alone";
    gate.zdr_db = 0.8F;
    gate.correlation = 0.99F;
    EXPECT_EQ(best_class(gate, BeamPlace::below), Hydrometeor::rain);
    EXPECT_EQ(best_class(smooth_gate(-25, 0, 0.3F, no_kdp_signal), BeamPlace::above),
              Hydrometeor::none)
        << "nothing fits";
    for (const float wild : {-1e30F, 1e30F, std::nanf("")})
        for (const BeamPlace place : {BeamPlace::below, BeamPlace::inside, BeamPlace::above})
            EXPECT_LE(static_cast<int>(best_class({30, wild, wild, wild, wild, wild, wild}, place)),
                      static_cast<int>(Hydrometeor::hail));
}

}  // namespace
}  // namespace stormcellar::retrieve
