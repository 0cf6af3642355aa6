// cli/loop/loop_report.h -- reports the result of `loop`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/loop/archive_loop.h"
#include "cli/loop/loop_grids.h"
#include "cli/loop/loop_options.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {

struct Skipped {
    std::filesystem::path path;
    std::string reason;
};

struct LoopReport {
    std::size_t frames = 0;
    std::vector<Skipped> skipped;
    UtcTime from, to;              // range of the drawn frames
    std::size_t interpolated = 0;  // number of frames made between volumes
    double between_s = 0;          // seconds for making them
    double read_s = 0, render_s = 0, encode_s = 0, total_s = 0;
    bool interrupted = false;
};

void warn_skipped(const Skipped& skipped);  // prints to stderr

// Prints the report as text to stderr, or with --json as one document to stdout.
void print_report(const LoopOptions& options, const render::Scene& scene, const LoopReport& report,
                  const std::optional<ArchiveGrids>& archive = std::nullopt);

}  // namespace stormcellar::cli
