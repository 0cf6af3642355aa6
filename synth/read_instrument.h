// synth/read_instrument.h -- reads the [instrument] table of a scene; docs/scenes.md has its keys.
#pragma once

#include "base/toml_file.h"
#include "synth/instrument.h"

namespace stormcellar::synth {

// The azimuths that a scene file may give.
inline constexpr TomlRange directions_deg{-360, 360};

// Reads the table. `cuts` is the number of cuts in the pattern. For each wrong value, notes a
// complaint and uses the default.
[[nodiscard]] Instrument read_instrument(TomlTable table, int cuts);

}  // namespace stormcellar::synth
