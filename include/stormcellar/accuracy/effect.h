// stormcellar/accuracy/effect.h -- one physical or optical effect: its meaning, its size in a
// scene, and its cost.
//
// An effect is the difference between two neighboring rungs of a step: if the effect is on, the
// step uses the upper rung. The module that does the step predicts the effect's size and cost for
// each scene. This module knows no physics.
//
// Units     Costs are in seconds; the units of sizes are in stormcellar/accuracy/quantity.h.
// Threads   Effects are plain values and all functions are pure.
// Errors    parse_override() returns bad_argument; nothing else can fail.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/accuracy/quantity.h"
#include "stormcellar/base/result.h"

namespace stormcellar::accuracy {

// The requested state of an effect. An effect is not_asked if the scene does not ask for it. The
// exact form then lacks the effect too, and leaving it off is no error. For example, a picture
// without shadows is not wrong.
enum class Setting { automatic, on, off, not_asked };

// The source of the predicted size.
enum class Evidence {
    exact,         // computed for this very scene
    proven_bound,  // never exceeded in this scene, whatever rungs the other steps use
    sample,        // estimated from a sample; measuring must verify it (accuracy/governor.h)
};
[[nodiscard]] std::string_view name_of(Evidence evidence);  // "exact", "proven", "sample"

struct Effect {
    std::string name;  // snake_case, e.g. "refraction"
    std::string what;  // one plain sentence: "The beam bends more or less than over a 4/3 earth."
    std::string rung;  // the rung that is used if the effect is on, e.g. "ray traced"
    ErrorSize predicted;  // this rung against the next lower rung, with everything else exact
    Evidence evidence = Evidence::sample;
    double cost_s = 0;  // extra time if the effect is on; never negative
    Setting setting = Setting::automatic;
    // The extra time in a fixed scale that is the same for all scenes and is not measured. Choices
    // are ordered by effort, so that the cheapest does not depend on how busy the machine was.
    double effort = 0;
};

// Returns an effect with predicted size and cost 0, which the caller fills in.
[[nodiscard]] Effect make_effect(std::string name, std::string rung, std::string what,
                                 double effort = 0);

// Returns true for a lower-case letter followed by lower-case letters, digits and single
// underscores, 40 characters at most.
[[nodiscard]] bool is_effect_name(std::string_view name);

// The setting that `--effect NAME=on|off|auto` asks for.
struct EffectOverride {
    std::string name;
    Setting setting = Setting::automatic;
};

// Parses "NAME=on", "NAME=off" or "NAME=auto", where `names` lists the effects that exist. Returns
// bad_argument for any other text; the message suggests a similar name if there is one.
[[nodiscard]] Result<EffectOverride> parse_override(std::string_view text,
                                                    const std::vector<std::string>& names);

}  // namespace stormcellar::accuracy
