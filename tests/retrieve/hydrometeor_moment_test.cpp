// Tests flags and values of the moment HCA.
#include "retrieve/derived/hydrometeor_moment.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "stormcellar/retrieve/derived_moments.h"
#include "stormcellar/retrieve/hydrometeors.h"
#include "tests/retrieve/layered_volume.h"

namespace stormcellar::retrieve {
namespace {

using level2::GateStatus;
using level2::Moment;
using level2::SweepMoment;

level2::Volume rain_below_snow() {
    LayeredSpec spec;
    spec.radials = 90;
    return layered_volume(spec, [](double, double, double height_m) {
        return height_m < 7000 ? MeltingProfile{}.at(height_m) : DualPoint{};
    });
}

TEST(HydrometeorMoment, HasTheFlagsOfReflectivityAndNumbersOfClasses) {
    level2::Volume volume = rain_below_snow();
    auto& echo = volume.sweeps[0].moments[0].codes16;
    echo[20] = 0;
    echo[21] = 1;
    auto& zdr = volume.sweeps[0].moments[1].codes16;
    for (std::size_t radial = 9; radial <= 11; ++radial)  // no class without ZDR
        std::fill_n(zdr.begin() + static_cast<std::ptrdiff_t>(radial * 320), 60, std::uint16_t{0});
    const auto known = hydrometeors(volume);
    const auto derived = add_derived_moments(volume, std::array{Moment::hca});
    ASSERT_TRUE(derived) << derived.error().message;
    ASSERT_EQ(derived->notes.size(), 1U);
    EXPECT_EQ(derived->notes[0], std::string(hydrometeor_words) + known.layer);
    const SweepMoment* classes = volume.sweeps[0].find(Moment::hca);
    ASSERT_NE(classes, nullptr);
    EXPECT_EQ(classes->status(0, 20), GateStatus::below_threshold);
    EXPECT_EQ(classes->status(0, 21), GateStatus::range_folded);
    EXPECT_EQ(classes->status(10, 30), GateStatus::ambiguous);
    for (std::int32_t gate = 0; gate < classes->gate_stride; ++gate) {
        const Hydrometeor kind = known.sweeps[0].classes[static_cast<std::size_t>(gate)];
        if (classes->status(0, gate) != GateStatus::valid) {
            EXPECT_EQ(kind, Hydrometeor::none) << gate;
            continue;
        }
        EXPECT_FLOAT_EQ(classes->value_of(classes->code(0, gate)), hydrometeor_number(kind));
    }
    EXPECT_FLOAT_EQ(classes->value_of(classes->code(5, 10)), 60) << "rain near the radar";
}

TEST(HydrometeorMoment, NeedsDualPolarization) {
    level2::Volume volume = rain_below_snow();
    for (level2::Sweep& sweep : volume.sweeps)
        sweep.moments.resize(1);
    EXPECT_NE(add_hydrometeor_moment(volume, 4200).find("no dual polarization"), std::string::npos);
    for (const level2::Sweep& sweep : volume.sweeps)
        EXPECT_EQ(sweep.find(Moment::hca), nullptr);
}

TEST(HydrometeorMoment, AssumesTheGivenHeightWhereNoLayerIsSeen) {
    const auto note_of = [](level2::Volume volume, double zero_c_m) {
        auto derived = add_derived_moments(volume, std::array{Moment::hca}, {.zero_c_m = zero_c_m});
        return derived->notes.at(0);
    };
    // The volume shows its layer, so the given height does not count.
    EXPECT_EQ(note_of(rain_below_snow(), 1500), note_of(rain_below_snow(), 4200));
    EXPECT_EQ(assumed_zero_c_in_notes(std::array{note_of(rain_below_snow(), 1500)}), std::nullopt);
    // A sweep at 3 degrees shows none. With 0 C at 1500 m, the echo at 2000 m is no rain.
    LayeredSpec low;
    low.radials = 90;
    low.elevations_deg = {3};
    const auto rain = [](double, double, double) { return MeltingProfile{}.at(0); };
    const auto rain_gates = [&](double zero_c_m) {
        level2::Volume volume = layered_volume(low, rain);
        EXPECT_EQ(assumed_zero_c_in_notes(std::array{note_of(volume, zero_c_m)}), zero_c_m);
        std::ignore = add_hydrometeor_moment(volume, zero_c_m);
        return std::ranges::count(volume.sweeps[0].find(Moment::hca)->codes8,
                                  2 + static_cast<int>(Hydrometeor::rain));
    };
    EXPECT_LT(rain_gates(1500), rain_gates(4200) / 2);
}

TEST(HydrometeorMoment, NumbersNameTheirClass) {
    EXPECT_EQ(hydrometeor_of_number(80), Hydrometeor::big_drops);
    for (const float none : {0.0F, 5.0F, 85.0F, 110.0F, -10.0F})
        EXPECT_EQ(hydrometeor_of_number(none), Hydrometeor::none) << none;
}

}  // namespace
}  // namespace stormcellar::retrieve
