// synth/read_instrument.h -- the [instrument] table of a scene; docs/scenes.md has its keys.
#pragma once

#include "base/toml_file.h"
#include "synth/instrument.h"

namespace stormcellar::synth {

// `cuts`: how many the pattern has. What is wrong is complained about, its default stands for it.
[[nodiscard]] Instrument read_instrument(TomlTable table, int cuts);

}  // namespace stormcellar::synth
