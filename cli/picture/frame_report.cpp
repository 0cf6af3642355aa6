#include "cli/picture/frame_report.h"

#include <fmt/format.h>

#include "cli/picture/still_output.h"
#include "cli/shared/commands.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::cli {

void report_frame(const FrameOptions& options, const render::Scene& scene,
                  const cache::GridDescription& grid, const FrameTiming& timing,
                  const MaybeProbe& probe) {
    if (!options.json) {
        if (probe) print_probe(*probe, options, scene, grid);
        if (options.output.empty()) return;
        const bool is_data = still_format(options.output).encode_map != nullptr;
        fmt::print(stderr, "{}: {} {}, {}, {} x {} {}, {:.0f} ms\n", printable(options.output),
                   printable(options.domain), format_utc(grid.time), options.scene.product,
                   is_data ? grid.spec.nx : scene.width, is_data ? grid.spec.ny : scene.height,
                   is_data ? "cells" : "pixels", timing.total_s * 1e3);
        return;
    }
    nlohmann::ordered_json json;
    if (!options.output.empty()) json["output"] = options.output;
    json["domain"] = options.domain;
    json["time"] = format_utc(grid.time);
    json["product"] = options.scene.product;
    json["moment"] = render::moment_asked(options.scene);
    json["width"] = scene.width;
    json["height"] = scene.height;
    json["partial"] = grid.provenance.partial;
    if (probe) json["probe"] = json_of(*probe);
    json["read_s"] = timing.read_s;
    json["decode_s"] = timing.decode_s;
    json["render_s"] = timing.render_s;
    json["write_s"] = timing.write_s;
    json["total_s"] = timing.total_s;
    fmt::print("{}\n", json.dump(1, ' ', true, nlohmann::ordered_json::error_handler_t::replace));
}

double decode_s(const PictureGrid& grid) {
    double sum_s = 0;
    for (const SourceVolume& source : grid.volumes())
        sum_s += source.read_s + source.decode_s;
    return sum_s;
}

}  // namespace stormcellar::cli
