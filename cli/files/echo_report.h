// cli/files/echo_report.h -- reports how much of the echo of volumes is weather or of another kind,
// and where snow melts.
#pragma once

#include <nlohmann/json.hpp>

#include "stormcellar/level2/decode.h"

namespace stormcellar::cli {

// Prints a table for each volume of a file: the share of each kind of echo among the reflectivity
// gates with echo (stormcellar/retrieve/echo_kinds.h), and the melting layer or the reason why none
// was found (stormcellar/retrieve/melting_layer.h).
void print_echo(const level2::Decoded& decoded);

// Returns the same as a list with an entry for each volume: gates, percent by kind, and
// melting_layer.
[[nodiscard]] nlohmann::ordered_json echo_json(const level2::Decoded& decoded);

}  // namespace stormcellar::cli
