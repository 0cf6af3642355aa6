#include "render/options/still_frame.h"

#include <utility>

#include "render/frame/hail_text.h"
#include "render/frame/overlay_text.h"
#include "render/frame/picture_metadata.h"
#include "render/options/fitted_view.h"
#include "stormcellar/render/render.h"

namespace stormcellar::render {
namespace {

Metadata metadata_of_still(const StillSource& source, const Scene& scene,
                           const StillWriting& writing) {
    const UtcTime time = source.description.time;
    PictureFacts told{source.domain, time, time, std::nullopt, {}, writing.error};
    // If the sensitivity cannot be computed, drawing the picture fails with the reason.
    if (source.overlays.cells != nullptr) told.cells = cells_sentence(*source.overlays.cells);
    if (const ShapeOverlay* shapes = source.overlays.shapes)
        told.shapes = fmt::format("{}: {}", shapes->name, shapes_shown(*shapes, time));
    told.hail = hail_sensitivity(source.view, scene, writing.threads).value_or("");
    if (writing.format.encode_map == nullptr) return metadata_of(told, source.description, scene);
    // Data must be in the units of the grid. A map as data has no picture size.
    Scene in_grid_units = scene;
    in_grid_units.units = {};
    Metadata metadata = metadata_of(told, source.description, in_grid_units);
    std::erase_if(metadata, [](const auto& text) { return text.first == "Picture"; });
    return metadata;
}

}  // namespace

FrameFacts facts_of_still(const StillSource& source) {
    FrameFacts facts = frame_facts_of(source.domain, source.description, source.options.time_zone);
    if (!source.tells_age) facts.antenna_to_picture.reset();
    return facts;
}

Status fit_to_grid(const StillSource& source, Scene& scene) {
    if (source.view.sweep != nullptr) {
        scene = scene_shown(source.view, std::move(scene));
        return {};
    }
    const EchoOutline outline(source.view, scene.moment);
    const auto fitted =
        fit_picture(outline, source.view, facts_of_still(source), source.options, scene);
    return fitted ? Status{} : pass_on(fitted);
}

Result<std::vector<std::byte>> encode_still(const StillSource& source, const Scene& scene,
                                            const StillWriting& writing) {
    const FrameFacts facts = facts_of_still(source);
    const StillOptions options{.metadata = metadata_of_still(source, scene, writing),
                               .tiff = writing.tiff,
                               .threads = writing.threads};
    if (writing.format.encode_map != nullptr)
        return writing.format.encode_map({source.view, facts, scene}, options);
    const auto picture =
        render_frame(source.view, facts, scene, writing.threads, nullptr, source.overlays);
    if (!picture) return pass_on(picture);
    if (writing.drawn) writing.drawn();
    return writing.format.encode_picture(*picture, options);
}

}  // namespace stormcellar::render
