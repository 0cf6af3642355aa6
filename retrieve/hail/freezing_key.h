// retrieve/hail/freezing_key.h -- reads the key `freezing_levels_m` of a configuration.
//
// Units     Meters above mean sea level.
// Threads   Pure function, except that it marks the key as read.
#pragma once

#include "base/toml_file.h"
#include "stormcellar/retrieve/hail.h"

namespace stormcellar::retrieve {

// Sets both levels if the table has the key. If the value is not two heights that validate()
// accepts, the table gets a complaint.
void read_freezing_levels(TomlTable& table, FreezingLevels& levels);

}  // namespace stormcellar::retrieve
