#include "render/render.h"

#include "render/canvas.h"
#include "render/map/labels.h"
#include "render/map/map_lines.h"
#include "render/products/column_summary.h"
#include "render/products/ground.h"
#include "render/shades.h"
#include "render/volume/slicer.h"

namespace stormcellar::render {
namespace {

Status check(const grid::BrickView& view, const FrameFacts& facts, const Scene& scene) {
    if (view.spec == nullptr) return fail(ErrorCode::bad_argument, "no grid to draw");
    if (auto valid = grid::validate(*view.spec); !valid) return valid;
    if (facts.moment != level2::Moment::ref) {
        return fail(ErrorCode::unsupported, "only reflectivity (REF) can be drawn, not {}",
                    level2::moment_name(facts.moment));
    }
    return validate(scene);
}

// A map is the view straight down with north up.
ViewGeometry geometry_of(const grid::GridSpec& spec, const Scene& scene, int width, int height) {
    if (scene.product == Product::composite) {
        return {spec, Camera{180, 0, scene.camera.zoom}, 1, width, height};
    }
    return {spec, scene.camera, scene.vertical_exaggeration, width, height, scene.curved_earth};
}

// Where the picture is, and how its lines and letters are drawn.
struct Frame {
    LabelLayout layout;
    MapLines lines;
    Fonts fonts;
};

// The picture with its lines, without the labels round it.
Image draw_picture(const grid::BrickView& view, const Scene& scene, const ViewGeometry& geometry,
                   const Frame& frame, int threads) {
    const auto columns = summarize_columns(view, threads);
    const double scale = frame.layout.scale;
    const bool volume = scene.product == Product::volume;
    const Image base =
        volume ? paint_ground(*view.spec, columns, geometry, scale, threads)
               : paint_composite(view, nws_reflectivity(), columns, geometry, scale, threads);
    Canvas canvas(base);
    draw_border(canvas, frame.lines);
    if (scene.labels) draw_rings(canvas, frame.fonts, frame.lines);
    Image picture = canvas.image();
    if (volume) {
        const VolumeSlicer slicer(nws_reflectivity(), view.quantization, geometry,
                                  {scene.slices, Integration::second_order, scene.opacity});
        const Layer layer = slicer.draw(view, threads);
        composite_over(layer, picture, 0, 0);
    }
    return picture;
}

}  // namespace

Result<Image> render_frame(const grid::BrickView& view, const FrameFacts& facts, const Scene& scene,
                           int threads) {
    if (auto valid = check(view, facts, scene); !valid) return pass_on(valid);
    Frame frame;
    frame.lines.ring_spacing_m = drawn_ring_spacing(*view.spec, scene.range_ring_spacing_m);
    frame.layout.width = scene.width;
    frame.layout.height = scene.height;
    if (scene.labels) {
        auto fonts = Fonts::load();
        if (!fonts) return pass_on(fonts);
        frame.fonts = *fonts;
        auto layout = lay_out_labels(frame.fonts, scene, facts, frame.lines.ring_spacing_m);
        if (!layout) return pass_on(layout);
        frame.layout = *layout;
    }
    const ViewGeometry geometry =
        geometry_of(*view.spec, scene, frame.layout.width, frame.layout.height);
    frame.lines.geometry = &geometry;
    frame.lines.spec = view.spec;
    frame.lines.sites = &facts.sites;
    frame.lines.camera = scene.product == Product::composite ? Camera{180, 0, 1} : scene.camera;
    frame.lines.heights = scene.product == Product::volume;
    frame.lines.scale = frame.layout.scale;

    Image picture = draw_picture(view, scene, geometry, frame, threads);
    if (!scene.labels) return picture;
    Canvas canvas(scene.width, scene.height, shades::page);
    canvas.place(picture, frame.layout.left, frame.layout.top);
    frame.lines.left = frame.layout.left;
    frame.lines.top = frame.layout.top;
    draw_marks(canvas, frame.fonts, frame.lines);
    draw_labels(canvas, frame.fonts, frame.layout);
    return canvas.image();
}

}  // namespace stormcellar::render
