#include "stormcellar/render/render.h"

#include "render/frame/hail_text.h"
#include "render/frame/overlay_text.h"
#include "render/frame/sweep_text.h"
#include "render/frame/view_picture.h"
#include "render/image/shades.h"
#include "render/map/labels.h"
#include "render/map/map_lines.h"
#include "render/products/column_summary.h"
#include "render/volume/ray_packet.h"
#include "stormcellar/grid/sweep_lookup.h"

namespace stormcellar::render {

Status check_frame(const grid::BrickView& view, const FrameFacts& facts, const Scene& scene) {
    if (view.spec == nullptr) return fail(ErrorCode::bad_argument, "there is no grid to draw");
    if (auto valid = grid::validate(*view.spec); !valid) return valid;
    if (facts.moment != scene.moment) {
        return fail(ErrorCode::bad_argument, "the grid holds {}, but the scene shows {}",
                    level2::moment_name(facts.moment), level2::moment_name(scene.moment));
    }
    const bool of_sweep = facts_of(scene.product).is_of_sweep;
    if (of_sweep != (view.sweep != nullptr)) {
        return fail(ErrorCode::bad_argument, "{} shows a {}, but there is a {}",
                    product_name(scene.product), of_sweep ? "sweep" : "grid",
                    of_sweep ? "grid" : "sweep");
    }
    if (view_of(scene.product) == View::volume && !PacketVolume::can_address(view)) {
        return fail(ErrorCode::unsupported,
                    "a grid of {} x {} x {} cells is too large to be drawn as a volume",
                    view.spec->nx, view.spec->ny, view.spec->nz());
    }
    return validate(scene);
}

Scene scene_shown(const grid::BrickView& view, Scene scene) {
    if (view.sweep != nullptr) scene.elevation_deg = view.sweep->facts().fixed_angle_deg;
    return scene;
}

ViewGeometry picture_geometry(const grid::GridSpec& spec, const Scene& scene, int width,
                              int height) {
    if (is_map(scene.product)) {
        return {spec, Camera{180, 0, scene.camera.zoom}, 1, width, height};
    }
    return {spec, scene.camera, scene.vertical_exaggeration, width, height, scene.curved_earth};
}

Result<Image> render_frame(const grid::BrickView& view, const FrameFacts& facts, const Scene& asked,
                           int threads, FrameCache* kept, const Overlays& overlays) {
    if (auto valid = check_frame(view, facts, asked); !valid) return pass_on(valid);
    const Scene scene = scene_shown(view, asked);
    const bool of_sweep = view.sweep != nullptr;
    const auto columns = of_sweep ? std::vector<ColumnSummary>{} : summarize_columns(view, threads);
    const DrawnView drawn{view, facts, scene, columns, overlays};
    FrameCache own;
    FrameCache& cache = kept != nullptr ? *kept : own;
    if (!scene.labels) {
        return draw_view(drawn, {scene.width, scene.height, 1}, nullptr, threads, cache);
    }
    const auto fonts = Fonts::load();
    if (!fonts) return pass_on(fonts);
    DrawnFacts texts{legend_of(scene), drawn_ring_spacing(*view.spec, scene), std::nullopt};
    if (overlays.rotation != nullptr) add_rotation_rows(texts.legend);
    if (overlays.cells != nullptr) texts.marks = cell_notes(*overlays.cells);
    if (overlays.shapes != nullptr) {
        if (!texts.marks.empty()) texts.marks.back() += ";";
        texts.marks.push_back(overlays.shapes->name + ":");
        texts.marks.push_back(shapes_shown(*overlays.shapes, facts.time));
    }
    const auto sensitivity = hail_sensitivity(view, scene, threads);
    if (!sensitivity) return pass_on(sensitivity);
    texts.hail = *sensitivity;
    if (of_sweep) {
        const auto place = lay_out_labels(*fonts, scene, facts, texts);
        if (!place) return pass_on(place);
        texts.sweep = sweep_text(*view.sweep, *view.spec,
                                 picture_geometry(*view.spec, scene, place->width, place->height));
    } else {
        texts.coverage = coverage_of(columns, *view.spec);
    }
    const auto layout = lay_out_labels(*fonts, scene, facts, texts);
    if (!layout) return pass_on(layout);
    const auto picture =
        draw_view(drawn, {layout->width, layout->height, layout->scale}, &*fonts, threads, cache);
    if (!picture) return picture;
    Canvas canvas(scene.width, scene.height, layout->shades->page);
    canvas.place(*picture, layout->left, layout->top);
    if (layout->inset) {
        const Rect& box = *layout->inset;
        const PictureSize size{static_cast<int>(box.width), static_cast<int>(box.height),
                               layout->scale};
        const auto inset = draw_section_inset(drawn, size, *fonts, threads, cache);
        if (!inset) return inset;
        canvas.place(*inset, static_cast<int>(box.x), static_cast<int>(box.y));
    }
    draw_labels(canvas, *fonts, *layout);
    return canvas.image();
}

}  // namespace stormcellar::render
