#include "pipeline/mosaic/mosaic_effects.h"

#include <algorithm>

namespace stormcellar::pipeline {
namespace {

using accuracy::Effect;
using accuracy::Step;

Effect effect(std::string name, std::string rung, std::string what) {
    Effect made;
    made.name = std::move(name);
    made.rung = std::move(rung);
    made.what = std::move(what);
    return made;
}

Step time_step() {
    return {"time",
            "nearest",
            {effect("time_blend", "blend",
                    "Between two volumes the weather is partly the earlier, partly the later."),
             effect("echo_motion", "advected",
                    "Between two volumes echo moves from where it was to where it will be.")}};
}

Step sweeps_step() {
    return {"sweeps",
            "as one",
            {effect("sweep_times", "each at its own time",
                    "The antenna climbs for minutes: each height was seen at a time of its own.")}};
}

Step overlap_step(grid::Overlap overlap) {
    Step step{"overlap", "nearest", {}};
    if (overlap == grid::Overlap::nearest) return step;
    step.effects.push_back(effect("site_overlap", std::string(grid::overlap_name(overlap)),
                                  "Where several sites see a cell, each of them has a say."));
    return step;
}

Step codes_step() {
    return {"codes",
            "default steps",
            {effect("fine_codes", "fine steps",
                    "What is kept of a value is rounded, in the cache as in the radar's data.")}};
}

std::size_t rung_of(const accuracy::Chain& chain, const accuracy::Choice& choice,
                    std::string_view name) {
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        if (chain.steps[i].name == name) return choice.rungs[i];
    }
    return 0;
}

}  // namespace

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
    made.time = static_cast<grid::TimeMethod>(rung_of(chain, choice, "time"));
    made.sweep_times = rung_of(chain, choice, "sweeps") > 0;
    made.mixes_sites = rung_of(chain, choice, "overlap") > 0;
    made.fine_codes = rung_of(chain, choice, "codes") > 0;
    return made;
}

accuracy::Choice default_mosaic_choice(const accuracy::Chain& chain, const grid::GridSpec& domain,
                                       double beam_width_deg) {
    accuracy::Choice choice = grid::default_choice(chain, domain, beam_width_deg);
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        const Step& step = chain.steps[i];
        const bool highest = step.name == "time" || step.name == "sweeps" || step.name == "overlap";
        if (!highest && step.name != "codes") continue;
        const accuracy::RungRange allowed = accuracy::allowed_rungs(step);
        choice.rungs[i] = highest ? allowed.most : allowed.least;
    }
    return choice;
}

accuracy::Choice exact_mosaic_choice(const accuracy::Chain& chain) {
    accuracy::Choice choice;
    for (const Step& step : chain.steps)
        choice.rungs.push_back(step.name == "frame" ? 1 : step.effects.size());
    return choice;
}

grid::Quantization quantization_of(level2::Moment moment, bool fine) {
    grid::Quantization quantization = grid::default_quantization(moment);
    if (!fine) return quantization;
    // The least value stays where it is, and the largest is beyond what radars send.
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
