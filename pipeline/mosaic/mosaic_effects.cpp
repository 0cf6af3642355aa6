#include "pipeline/mosaic/mosaic_effects.h"

#include <algorithm>
#include <array>

namespace stormcellar::pipeline {
namespace {

using accuracy::make_effect;
using accuracy::rung_of;
using accuracy::Step;

Step time_step() {
    return {
        std::string{step::time},
        "nearest",
        {make_effect("time_blend", "blend",
                     "Between two volumes the weather is partly the earlier, partly the later."),
         make_effect("echo_motion", "advected",
                     "Between two volumes echo moves from where it was to where it will be.")}};
}

Step sweeps_step() {
    return {std::string{step::sweeps},
            "as one",
            {make_effect(
                "sweep_times", "each at its own time",
                "The antenna climbs for minutes: each height was seen at a time of its own.")}};
}

Step overlap_step(grid::Overlap overlap) {
    Step made{std::string{step::overlap}, "nearest", {}};
    if (overlap == grid::Overlap::nearest) return made;
    made.effects.push_back(make_effect("site_overlap", std::string(grid::overlap_name(overlap)),
                                       "Where several sites see a cell, each of them has a say."));
    return made;
}

Step codes_step() {
    return {
        std::string{step::codes},
        "default steps",
        {make_effect("fine_codes", "fine steps",
                     "What is kept of a value is rounded, in the cache as in the radar's data.")}};
}

}  // namespace

bool is_of_merging(const accuracy::Step& step) {
    constexpr std::array names = {step::time, step::sweeps, step::overlap, step::codes};
    return std::find(names.begin(), names.end(), step.name) != names.end();
}

accuracy::Chain mosaic_effects_of(level2::Moment moment, grid::Averaging averaging,
                                  grid::Overlap overlap) {
    accuracy::Chain chain = grid::effects_of(moment, averaging);
    chain.steps.push_back(time_step());
    chain.steps.push_back(sweeps_step());
    chain.steps.push_back(overlap_step(overlap));
    chain.steps.push_back(codes_step());
    return chain;
}

MosaicChoice mosaic_choice(const accuracy::Chain& chain, const accuracy::Choice& choice) {
    MosaicChoice made;
    made.gridding = grid::scene_choice(chain, choice);
    made.time = static_cast<grid::TimeMethod>(rung_of(chain, choice, step::time));
    made.sweep_times = rung_of(chain, choice, step::sweeps) > 0;
    made.mixes_sites = rung_of(chain, choice, step::overlap) > 0;
    made.fine_codes = rung_of(chain, choice, step::codes) > 0;
    return made;
}

accuracy::Choice default_mosaic_choice(const accuracy::Chain& chain, const grid::GridSpec& domain,
                                       double beam_width_deg) {
    accuracy::Choice choice = grid::default_choice(chain, domain, beam_width_deg);
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        const Step& each = chain.steps[i];
        if (!is_of_merging(each)) continue;
        const accuracy::RungRange allowed = accuracy::allowed_rungs(each);
        choice.rungs[i] = each.name == step::codes ? allowed.least : allowed.most;
    }
    return choice;
}

grid::Quantization quantization_of(level2::Moment moment, bool fine) {
    grid::Quantization quantization = grid::default_quantization(moment);
    if (!fine) return quantization;
    // The smallest value stays the same. The largest value still exceeds all values that radars
    // send.
    quantization.step /= quantization.code_bytes == 1 ? 64 : 16;
    quantization.code_bytes = 2;
    return quantization;
}

PartialOptions with_choice(PartialOptions options, const MosaicChoice& choice) {
    options.gridder.method = choice.gridding.method;
    options.frame = choice.gridding.frame;
    options.quantization = quantization_of(options.gridder.moment, choice.fine_codes);
    return options;
}

FrameOptions with_choice(FrameOptions options, const MosaicChoice& choice) {
    options.time = choice.time;
    options.sweep_times = choice.sweep_times;
    if (!choice.mixes_sites) options.overlap.overlap = grid::Overlap::nearest;
    return options;
}

}  // namespace stormcellar::pipeline
