// cli/picture/frame_report.h -- the report that `frame` prints at its end.
#pragma once

#include "cli/picture/frame_options.h"
#include "cli/picture/frame_probe.h"
#include "cli/picture/picture_grid.h"

namespace stormcellar::cli {

struct FrameTiming {
    double read_s = 0;    // from the start until the grid and its view are ready
    double decode_s = 0;  // part of read_s
    double render_s = 0, write_s = 0, total_s = 0;
};

// Returns the seconds for reading and decoding the files, or 0 for a grid of the cache.
[[nodiscard]] double decode_s(const PictureGrid& grid);

// Reports the written file and the probe: as text on stderr, or with --json as a document.
void report_frame(const FrameOptions& options, const render::Scene& scene,
                  const cache::GridDescription& grid, const FrameTiming& timing,
                  const MaybeProbe& probe);

}  // namespace stormcellar::cli
