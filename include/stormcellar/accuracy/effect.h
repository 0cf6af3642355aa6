// stormcellar/accuracy/effect.h -- one physical or optical effect: what it is, how large here, what
// it costs.
//
// An effect is one step up a ladder: with it on, a step of the chain is done as its next rung does
// it. The room that does the step predicts the effect's size and cost for the scene at hand; this
// room knows no physics.
// Thread contract: values and pure functions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/accuracy/quantity.h"
#include "stormcellar/base/result.h"

namespace stormcellar::accuracy {

// not_asked: the scene does not ask for it, so that the exact form is without it too and leaving it
// off is no error. Light is such: a picture without shadows is not wrong.
enum class Setting { automatic, on, off, not_asked };

// How a predicted size is known.
enum class Evidence {
    exact,         // computed for this very scene
    proven_bound,  // not exceeded anywhere in it, whatever rung the other steps are at
    sample,        // estimated on a sample: to be verified by measuring (accuracy/governor.h)
};
[[nodiscard]] std::string_view name_of(Evidence evidence);  // "exact", "proven", "sample"

struct Effect {
    std::string name;  // snake_case, e.g. "refraction"
    std::string what;  // one plain sentence: "The beam bends more or less than over a 4/3 earth."
    std::string rung;  // what its step is done by when it is on, e.g. "ray traced"
    ErrorSize predicted;  // this rung against the one below it, everything else exact
    Evidence evidence = Evidence::sample;
    double cost_s = 0;  // extra time when it is on; never negative
    Setting setting = Setting::automatic;
    // Extra time in a scale that is fixed for all scenes, not measured: it orders choices, so that
    // which is the cheapest does not hang on how busy the machine was.
    double effort = 0;
};

// An effect that nothing was predicted of yet: its name, the rung that it reaches, its sentence.
[[nodiscard]] Effect make_effect(std::string name, std::string rung, std::string what,
                                 double effort = 0);

// A lower-case letter, then lower-case letters, digits and single underscores; at most 40.
[[nodiscard]] bool is_effect_name(std::string_view name);

// What `--effect NAME=on|off|auto` asks for.
struct EffectOverride {
    std::string name;
    Setting setting = Setting::automatic;
};

// `names` are the effects that there are. Errors: bad_argument; a name that is nearly one of them
// is answered with "did you mean".
[[nodiscard]] Result<EffectOverride> parse_override(std::string_view text,
                                                    const std::vector<std::string>& names);

// Letters to insert, drop, replace or swap with their neighbour to make one of the other.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace stormcellar::accuracy
