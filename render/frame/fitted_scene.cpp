#include "render/frame/fitted_scene.h"

#include "render/frame/picture_layout.h"
#include "stormcellar/render/render.h"

namespace stormcellar::render {

Result<FittedView> fit_scene(const EchoOutline& outline, const grid::BrickView& view,
                             const FrameFacts& facts, const FitParts& parts, Scene& scene,
                             bool orbits) {
    if (view_of(scene.product) != View::volume) return FittedView{};
    if (auto valid = check_frame(view, facts, scene); !valid) return pass_on(valid);
    const auto layout = layout_of(view, facts, scene);
    if (!layout) return pass_on(layout);
    const FittedView fitted =
        fit_view(outline, scene, layout->width, layout->height, parts, orbits);
    apply(fitted, scene);
    return fitted;
}

}  // namespace stormcellar::render
