// cli/loop/sweep_loop.h -- makes loops of sweeps as the radar saw them (product ppi). Each volume
// gives one frame. With --all-elevations, each elevation of each volume gives a frame, from the
// lowest up; with --repeats, each sweep of one elevation gives a frame.
//
// Sweeps are drawn from raw files: the named files, the files of an archive's catalog, or the raw
// files of a domain's grids. If a volume repeats a sweep (SAILS, MRLE), the newest sweep is shown,
// or with --repeats each sweep in order of time. All frames have the plane of the first frame, so
// that the map does not move.
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
