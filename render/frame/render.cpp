#include "stormcellar/render/render.h"

#include "render/frame/frame_cache.h"
#include "render/image/canvas.h"
#include "render/image/shades.h"
#include "render/map/draw_marks.h"
#include "render/map/labels.h"
#include "render/map/map_layer.h"
#include "render/map/map_lines.h"
#include "render/products/column_summary.h"
#include "render/products/flat_field.h"
#include "render/products/ground.h"
#include "render/products/section.h"
#include "render/products/sweep_field.h"
#include "render/volume/haze.h"

namespace stormcellar::render {
namespace {

// Where the picture is, and how its lines and letters are drawn.
struct Frame {
    LabelLayout layout;
    MapLines lines;
    Fonts fonts;
    MapMarks marks;
};

// Draws the picture with its lines, but without the labels around it.
Result<Image> draw_picture(const grid::BrickView& view, const FrameFacts& facts,
                           const std::vector<ColumnSummary>& columns, const Scene& scene,
                           const ViewGeometry& geometry, const Frame& frame, int threads,
                           FrameCache& cache) {
    const double scale = frame.layout.scale;
    const bool volume = view_of(scene.product) == View::volume;
    const ColourTable& colours = colours_of(scene);
    Image base;
    if (volume) {
        const auto tells = scene.haze ? GroundTells::whether_seen : GroundTells::how_low;
        base = paint_ground(*view.spec, columns, geometry, tells, scale, threads);
    } else if (view.sweep != nullptr) {
        base =
            paint_pixels(*view.spec, sweep_in_picture(*view.sweep, *view.spec, geometry, threads),
                         colours, geometry, scale, threads);
    } else {
        const auto field = map_field(view, facts, scene, columns, threads);
        if (!field) return pass_on(field);
        base = paint_field(*view.spec, *field, colours, geometry, scale, threads);
    }
    Canvas canvas(base);
    draw_border(canvas, frame.lines);
    if (scene.labels) {
        draw_map(canvas, *frame.lines.map, scale);
        draw_rings(canvas, frame.lines);
        draw_ground_marks(canvas, frame.fonts, frame.lines, frame.marks);
    }
    Image picture = canvas.image();
    if (volume) {
        if (scene.haze) draw_haze(view, geometry, threads, picture);
        const VolumeSlicer slicer(
            colours, view.quantization, geometry,
            {scene.slices, scene.integration, scene.opacity, scene.pixel_tolerance, scene.light},
            &cache.transfer);
        slicer.prepare(view, threads, cache.room);
        slicer.cast(view, threads, cache.room);
        composite_over(cache.room.layer, picture, 0, 0, threads);
    }
    return picture;
}

Result<Image> draw_section_picture(const grid::BrickView& view, const Scene& scene,
                                   const Frame& frame, int threads) {
    const LabelLayout& layout = frame.layout;
    const SectionPlace place =
        section_place(layout.width, layout.height, layout.scale, scene.labels);
    const Section section =
        cut_section(view, scene.moment, *scene.section, place.width, place.height, threads);
    if (auto in_grid = check_in_grid(section, *view.spec); !in_grid) return pass_on(in_grid);
    return draw_section(section, colours_of(scene), place, layout.width, layout.height,
                        layout.scale, scene.labels ? &frame.fonts : nullptr);
}

}  // namespace

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
                           int threads, FrameCache* kept) {
    if (auto valid = check_frame(view, facts, asked); !valid) return pass_on(valid);
    const Scene scene = scene_shown(view, asked);
    const bool of_sweep = view.sweep != nullptr;
    const auto columns = of_sweep ? std::vector<ColumnSummary>{} : summarize_columns(view, threads);
    Frame frame;
    frame.lines.ring_spacing_m = drawn_ring_spacing(*view.spec, scene.range_ring_spacing_m);
    frame.layout.width = scene.width;
    frame.layout.height = scene.height;
    if (scene.labels) {
        auto fonts = Fonts::load();
        if (!fonts) return pass_on(fonts);
        frame.fonts = *fonts;
        auto layout = lay_out_labels(
            frame.fonts, scene, facts,
            {legend_of(scene), frame.lines.ring_spacing_m,
             of_sweep ? std::nullopt : std::optional(coverage_of(columns, *view.spec))});
        if (!layout) return pass_on(layout);
        frame.layout = *layout;
    }
    const ViewGeometry geometry =
        picture_geometry(*view.spec, scene, frame.layout.width, frame.layout.height);
    frame.lines.geometry = &geometry;
    frame.lines.spec = view.spec;
    frame.lines.sites = &facts.sites;
    frame.lines.heights = view_of(scene.product) == View::volume;
    frame.lines.scale = frame.layout.scale;
    FrameCache own;
    FrameCache& cache = kept != nullptr ? *kept : own;
    if (scene.labels) {
        const auto map = cache.map.get(*view.spec, geometry, frame.layout.scale);
        if (!map) return pass_on(map);
        frame.lines.map = *map;
        frame.marks = plan_marks(frame.fonts, frame.lines);
    }

    const bool section = view_of(scene.product) == View::section;
    auto picture = section
                       ? draw_section_picture(view, scene, frame, threads)
                       : draw_picture(view, facts, columns, scene, geometry, frame, threads, cache);
    if (!picture || !scene.labels) return picture;
    Canvas canvas(scene.width, scene.height, shades::page);
    canvas.place(*picture, frame.layout.left, frame.layout.top);
    frame.lines.left = frame.layout.left;
    frame.lines.top = frame.layout.top;
    if (!section) draw_marks(canvas, frame.fonts, frame.lines, frame.marks);
    draw_labels(canvas, frame.fonts, frame.layout);
    return canvas.image();
}

}  // namespace stormcellar::render
