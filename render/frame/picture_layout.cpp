#include "render/frame/picture_layout.h"

#include "render/map/map_lines.h"

namespace stormcellar::render {

Result<LabelLayout> layout_of(const grid::BrickView& view, const FrameFacts& facts,
                              const Scene& scene, const std::optional<Coverage>& coverage) {
    LabelLayout layout;
    layout.width = scene.width;
    layout.height = scene.height;
    if (!scene.labels) return layout;
    const auto fonts = Fonts::load();
    if (!fonts) return pass_on(fonts);
    return lay_out_labels(*fonts, scene, facts,
                          {legend_of(scene), drawn_ring_spacing(*view.spec, scene), coverage});
}

}  // namespace stormcellar::render
