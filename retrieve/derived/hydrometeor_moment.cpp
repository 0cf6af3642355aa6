#include "retrieve/derived/hydrometeor_moment.h"

#include <cstdint>
#include <utility>

#include "stormcellar/retrieve/hydrometeors.h"

namespace stormcellar::retrieve {
namespace {

using level2::SweepMoment;

// The first class has the first code that is a value.
constexpr std::uint16_t unclassified_code = 2;
constexpr float class_scale = 0.1F, class_offset = 2;

SweepMoment class_moment(const SweepMoment& reflectivity, const SweepHydrometeors& of) {
    SweepMoment made = reflectivity;
    made.moment = level2::Moment::hca;
    made.word_size_bits = 8;
    made.scale = class_scale;
    made.offset = class_offset;
    made.codes16.clear();
    made.codes8.assign(of.classes.size(), 0);
    for (std::size_t radial = 0; radial < made.gate_counts.size(); ++radial)
        for (std::int32_t gate = 0; gate < made.gate_counts[radial]; ++gate) {
            const std::size_t at = radial * static_cast<std::size_t>(made.gate_stride) +
                                   static_cast<std::size_t>(gate);
            const std::uint16_t code = reflectivity.code(radial, gate);
            made.codes8[at] = static_cast<std::uint8_t>(
                code < 2 ? code : unclassified_code + static_cast<unsigned>(of.classes[at]));
        }
    return made;
}

}  // namespace

std::string add_hydrometeor_moment(level2::Volume& volume, double zero_c_m) {
    const Hydrometeors found = hydrometeors(volume, zero_c_m);
    std::vector<std::pair<std::size_t, SweepMoment>> made;
    for (const SweepHydrometeors& of : found.sweeps)
        made.emplace_back(of.sweep, class_moment(volume.sweeps[of.sweep].moments[of.moment], of));
    for (auto& [sweep, moment] : made)
        volume.sweeps[sweep].moments.push_back(std::move(moment));
    return std::string(hydrometeor_words) + found.layer;
}

}  // namespace stormcellar::retrieve
