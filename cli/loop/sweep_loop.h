// cli/loop/sweep_loop.h -- loops of a ppi: sweeps as the radar saw them, one of each volume; with
// --all-elevations each elevation of each volume, from the lowest up; with --repeats each sweep of
// one elevation.
//
// They are drawn from raw files: those that are named, those of an archive's catalog, or those of
// which the grids of a domain were made. Of sweeps that come back (SAILS, MRLE) the newest of its
// volume is shown, or with --repeats each in order of time. All frames have the plane of the first,
// so that the map stands still.
//
// Threads   One thread at a time.
#pragma once

#include "base/steady_time.h"
#include "cli/loop/loop_options.h"
#include "cli/shared/interrupt.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {

// Draws and writes the loop, reports it, and returns the exit status.
[[nodiscard]] int run_sweep_loop(LoopOptions options, const render::Scene& scene,
                                 Interrupt& interrupt, SteadyTime start);

}  // namespace stormcellar::cli
