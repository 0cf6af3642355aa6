// cli/picture/frame_report.h -- what `frame` says when it is done.
#pragma once

#include "cli/picture/frame_options.h"
#include "cli/picture/frame_probe.h"

namespace stormcellar::cli {

struct FrameTiming {
    double read_s = 0, render_s = 0, write_s = 0, total_s = 0;
};

// Says on stderr what was written, or with --json prints a document; and what was probed.
void report_frame(const FrameOptions& options, const render::Scene& scene,
                  const cache::GridDescription& grid, const FrameTiming& timing,
                  const MaybeProbe& probe);

}  // namespace stormcellar::cli
