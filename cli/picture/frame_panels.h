// cli/picture/frame_panels.h -- `frame --panels`: draws several moments in one picture.
#pragma once

#include "base/steady_time.h"
#include "cli/picture/frame_options.h"

namespace stormcellar::cli {

// Draws and reports the picture; `start` is when the command began. Returns the exit status.
[[nodiscard]] int run_panels(FrameOptions& options, SteadyTime start);

}  // namespace stormcellar::cli
