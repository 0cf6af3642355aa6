#include "cli/picture/frame_options.h"

#include "cli/picture/still_output.h"
#include "render/options/picture_options.h"

namespace stormcellar::cli {

Status check_frame_options(const FrameOptions& options) {
    const bool probes = !options.probe.empty() || !options.probe_at.empty();
    if (!options.probe.empty() && !options.probe_at.empty()) {
        return fail(ErrorCode::bad_argument, "--probe and --probe-at cannot be used together");
    }
    if (options.output.empty()) {
        if (probes) return {};
        return fail(ErrorCode::bad_argument,
                    "there is nothing to do; give -o, --probe or --probe-at");
    }
    return {};
}

void take_panels(FrameOptions& options) {
    const bool is_one = render::contains(options.scene.typed, render::moment_option());
    if (options.panels.empty() && !is_one) options.panels = options.scene.panels;
}

Status check_frame_output(FrameOptions& options, render::Product product) {
    if (options.output.empty()) return {};
    if (Status fits = check_still_output(options.output, product, options.json); !fits) return fits;
    if (Status fits = check_overlay_output(options.output, options.scene.overlay); !fits)
        return fits;
    const auto tiff = parse_tiff_content(options.geotiff, options.output);
    if (!tiff) return pass_on(tiff);
    options.tiff = *tiff;
    return {};
}

}  // namespace stormcellar::cli
