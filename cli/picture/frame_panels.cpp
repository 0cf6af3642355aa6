#include "cli/picture/frame_panels.h"

#include <vector>

#include "cli/picture/frame_report.h"
#include "cli/picture/frame_sources.h"
#include "cli/picture/picture_panels.h"
#include "cli/picture/still_output.h"
#include "cli/shared/commands.h"
#include "render/frame/picture_metadata.h"

namespace stormcellar::cli {
namespace {

Result<FrameTiming> make_panels(FrameOptions& options, const std::vector<PanelScene>& panels,
                                const std::vector<PictureGrid>& grids, SteadyTime start) {
    FrameTiming timing;
    timing.read_s = seconds_since(start);
    timing.decode_s = decode_s(grids.front());
    const auto picture = draw_panels(options.domain, panels, grids, options.scene);
    if (!picture) return pass_on(picture);
    timing.render_s = seconds_since(start) - timing.read_s;
    const auto& first = grids.front().description();
    const render::StillOptions still{
        .metadata =
            render::metadata_of({options.domain, first.time, first.time, std::nullopt, {}, {}},
                                first, panels.front().scene)};
    const auto bytes = still_format(options.output).encode_picture(*picture, still);
    if (!bytes) return pass_on(bytes);
    if (auto written = write_still(options.output, *bytes); !written) return pass_on(written);
    timing.total_s = seconds_since(start);
    timing.write_s = timing.total_s - timing.read_s - timing.render_s;
    return timing;
}

}  // namespace

int run_panels(FrameOptions& options, SteadyTime start) {
    if (!options.probe.empty() || !options.probe_at.empty()) {
        return report_error({ErrorCode::bad_argument,
                             "--probe and --probe-at are for a picture of one moment, not for "
                             "--panels"});
    }
    if (!options.scene.overlay.empty()) {
        return report_error({ErrorCode::bad_argument,
                             "--overlay is for a picture of one moment, not for --panels"});
    }
    if (options.plan.asked()) {
        return report_error({ErrorCode::bad_argument,
                             "--tolerance, --effect and --explain plan a picture of one volume; "
                             "they are not for --panels"});
    }
    const auto panels = panel_scenes(options.panels, options.scene_file, options.scene);
    if (!panels) return report_error(panels.error());
    // Check this before the requirements of a map's format, because panels can never meet those.
    if (still_format(options.output).encode_picture == nullptr) {
        return report_error(
            {ErrorCode::bad_argument,
             fmt::format(
                 "{}: GeoTIFF, netCDF and KMZ hold a map of one moment; give --moment instead of "
                 "--panels, or name a picture such as panels.png",
                 options.output)});
    }
    if (const Status fine = check_frame_output(options, panels->front().scene.product); !fine)
        return report_error(fine.error());
    const auto grids = grids_of_panels(options, *panels);
    if (!grids) return report_error(grids.error());
    if (grids->empty()) return exit_nothing_matched;
    const auto timing = make_panels(options, *panels, *grids, start);
    if (!timing) return report_error(timing.error());
    options.scene.moment = options.panels;
    report_frame(options, panels->front().scene, grids->front().description(), *timing, {});
    return exit_done;
}

}  // namespace stormcellar::cli
