// cli/picture/frame_probe.h -- `frame --probe` and `--probe-at`: report the value at one place of a
// picture.
#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include "cli/picture/frame_options.h"
#include "cli/picture/picture_grid.h"
#include "render/frame/probe.h"
#include "stormcellar/base/result.h"

namespace stormcellar::cli {

using MaybeProbe = std::optional<render::Probe>;

// Probes the grid at the place that an option names. Returns none if no option names a place.
// Errors: bad_argument, naming the option, for a text that is not a place of the picture; those of
// probe_pixel() and probe_place().
[[nodiscard]] Result<MaybeProbe> probe_grid(const FrameOptions& options, const render::Scene& scene,
                                            const PictureGrid& file);

// Prints three lines: the place, its value, and the heights that the radar sees above the place or
// its gate.
void print_probe(const render::Probe& probe, const FrameOptions& options,
                 const render::Scene& scene, const cache::GridDescription& grid);
// Returns the place, its value and the heights as JSON.
[[nodiscard]] nlohmann::ordered_json json_of(const render::Probe& probe);

}  // namespace stormcellar::cli
