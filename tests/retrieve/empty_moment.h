// tests/retrieve/empty_moment.h -- a moment of a sweep whose gates are all below the threshold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

struct GateLayout {
    int radials = 0;
    int gates = 0;
    int first_gate_m = 0;
    int gate_spacing_m = 0;
};

struct CodeScale {
    float scale = 1;
    float offset = 0;
};

// The usual scales of NEXRAD: a code is value * scale + offset, in the units of the moment.
inline const std::map<level2::Moment, CodeScale> usual_scales = {
    {level2::Moment::ref, {2, 66}},      {level2::Moment::vel, {2, 129}},
    {level2::Moment::sw, {2, 129}},      {level2::Moment::zdr, {16, 128}},
    {level2::Moment::phi, {2.8361F, 2}}, {level2::Moment::rho, {300, -60.5F}}};

// Returns the moment in codes of 16 bits. Throws for any moment that is not in usual_scales.
inline level2::SweepMoment empty_moment(const GateLayout& layout, level2::Moment kind) {
    level2::SweepMoment moment;
    moment.moment = kind;
    moment.word_size_bits = 16;
    moment.first_gate_m = layout.first_gate_m;
    moment.gate_spacing_m = layout.gate_spacing_m;
    moment.gate_stride = layout.gates;
    moment.scale = usual_scales.at(kind).scale;
    moment.offset = usual_scales.at(kind).offset;
    const auto radials = static_cast<std::size_t>(layout.radials);
    moment.gate_counts.assign(radials, static_cast<std::uint16_t>(layout.gates));
    moment.codes16.assign(radials * static_cast<std::size_t>(layout.gates), 0);
    return moment;
}

}  // namespace stormcellar::retrieve
