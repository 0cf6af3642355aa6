// cli/picture/frame_report.h -- what `frame` says when it is done.
#pragma once

#include "cli/picture/frame_options.h"
#include "cli/picture/frame_probe.h"
#include "cli/picture/picture_grid.h"

namespace stormcellar::cli {

struct FrameTiming {
    double read_s = 0;    // from the start until there is a grid and a view of it
    double decode_s = 0;  // a part of it
    double render_s = 0, write_s = 0, total_s = 0;
};

// Returns the seconds, within those of reading, that it took to read and decode the files; none for
// a grid of the cache.
[[nodiscard]] double decode_s(const PictureGrid& grid);

// Says on stderr what was written, or with --json prints a document; and what was probed.
void report_frame(const FrameOptions& options, const render::Scene& scene,
                  const cache::GridDescription& grid, const FrameTiming& timing,
                  const MaybeProbe& probe);

}  // namespace stormcellar::cli
