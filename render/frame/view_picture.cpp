#include "render/frame/view_picture.h"

#include <cmath>

#include "render/map/beam_glyphs.h"
#include "render/map/draw_marks.h"
#include "render/map/map_ground.h"
#include "render/map/map_layer.h"
#include "render/map/map_lines.h"
#include "render/products/flat_field.h"
#include "render/products/ground.h"
#include "render/products/rotation.h"
#include "render/products/section.h"
#include "render/products/smooth_field.h"
#include "render/products/sweep_field.h"
#include "render/volume/haze.h"
#include "stormcellar/render/render.h"

namespace stormcellar::render {
namespace {

constexpr double largest_inset = 4;  // compared with the map of the whole grid

// Paints the ground of a view from outside, or paints a map.
Result<Image> paint_base(const DrawnView& drawn, const ViewGeometry& geometry,
                         const GroundLook& look, int threads) {
    const grid::GridSpec& spec = *drawn.view.spec;
    if (view_of(drawn.scene.product) == View::volume) {
        const auto tells = drawn.scene.haze ? GroundTells::whether_seen : GroundTells::how_low;
        return paint_ground(spec, drawn.columns, geometry, tells, look, threads);
    }
    if (drawn.view.sweep != nullptr) {
        const FlatField field = sweep_in_picture(*drawn.view.sweep, spec, geometry, threads);
        return paint_pixels(spec, field, colors_of(drawn.scene), geometry, look, threads);
    }
    const auto field = map_field(drawn.view, drawn.facts, drawn.scene, drawn.columns, threads);
    if (!field) return pass_on(field);
    return paint_field(spec, *field, colors_of(drawn.scene), geometry, look, threads,
                       is_smoothed(drawn.scene));
}

void draw_volume(const DrawnView& drawn, const ViewGeometry& geometry, int threads,
                 FrameCache& cache, Image& picture) {
    const Scene& scene = drawn.scene;
    fade_beyond(geometry, shades_of(scene.theme), threads, picture);
    if (scene.haze) {
        draw_haze(drawn.view, geometry, shades_of(scene.theme).haze, threads, picture);
    }
    const VolumeSlicer slicer(
        colors_of(scene), drawn.view.quantization, geometry,
        {scene.slices, scene.integration, scene.opacity, scene.pixel_tolerance, scene.light},
        &cache.transfer, threads);
    slicer.prepare(drawn.view, threads, cache.room);
    slicer.cast(drawn.view, threads, cache.room);
    composite_over(cache.room.layer, picture, 0, 0, threads);
}

void draw_rotation(const DrawnView& drawn, const ViewGeometry& geometry, int threads,
                   Image& picture) {
    const Scene& scene = drawn.scene;
    const VolumeSlicer slicer(
        rotation_colors(), drawn.overlays.rotation->quantization, geometry,
        {scene.slices, scene.integration, 1, scene.pixel_tolerance, scene.light}, nullptr, threads);
    composite_over(slicer.draw(*drawn.overlays.rotation, threads), picture, 0, 0, threads);
}

Result<Image> draw_whole_section(const DrawnView& drawn, const PictureSize& size,
                                 const Fonts* fonts, int threads) {
    const Scene& scene = drawn.scene;
    const SectionPlace place = section_place(size.width, size.height, size.scale, fonts != nullptr);
    const Section section =
        cut_section(drawn.view, scene.moment, *scene.section, place.width, place.height, threads);
    if (auto in_grid = check_in_grid(section, *drawn.view.spec); !in_grid) return pass_on(in_grid);
    const GroundLook look{&shades_of(scene.theme), nullptr, size.scale};
    return draw_section(section, colors_of(scene), place, size.width, size.height, look,
                        scene.units, fonts, threads);
}

// Returns the line from A to B in pixels. It has at least two points, and all are finite.
std::vector<Point> line_in_picture(const grid::GridSpec& spec, const SectionLine& line,
                                   const ViewGeometry& geometry) {
    const grid::SiteFrame start(line.from.latitude_deg, line.from.longitude_deg);
    const grid::PolarPoint end = start.to_polar(line.to);
    const GroundMap ground(spec);
    std::vector<Point> points;
    constexpr int parts = 48;
    for (int i = 0; i <= parts; ++i) {
        const GroundPoint at =
            ground.ground(start.to_geo({end.azimuth_deg, end.arc_m * i / parts}));
        const Pixel pixel = geometry.project(at.x_m, at.y_m, geometry.ground_m());
        if (std::isfinite(pixel.x) && std::isfinite(pixel.y)) points.push_back({pixel.x, pixel.y});
    }
    const Point middle = {0.5 * geometry.width(), 0.5 * geometry.height()};
    while (points.size() < 2)
        points.push_back(middle);
    return points;
}

void draw_section_line(Canvas& canvas, const Fonts& fonts, std::vector<Point> line, Point offset,
                       const PictureSize& size, const Shades& shades) {
    for (Point& p : line)
        p = {p.x + offset.x, p.y + offset.y};
    canvas.line(line, 3.6 * size.scale, shades.halo, false);
    canvas.line(line, 1.5 * size.scale, shades.text, false);
    const double letter = 11 * size.scale;
    const double room = 2 * size.scale;
    // Writes the letters beyond the ends of the line, but inside the map.
    const auto put = [&](const char* name, Point end, Point next) {
        const double length = std::max(1e-9, std::hypot(end.x - next.x, end.y - next.y));
        const double width = fonts.width(name, letter, true);
        const double x = end.x + (end.x - next.x) / length * 0.85 * letter;
        const double y = end.y + (end.y - next.y) / length * 0.85 * letter;
        canvas.text(fonts, name,
                    {std::clamp(x - width / 2, room, size.width - width - room),
                     std::clamp(y + 0.36 * letter, letter, size.height - room)},
                    letter, true, shades.text, shades.halo);
    };
    put("A", line.front(), line[1]);
    put("B", line.back(), line[line.size() - 2]);
}

}  // namespace

Result<Image> draw_view(const DrawnView& drawn, const PictureSize& size, const Fonts* fonts,
                        int threads, FrameCache& cache) {
    const Scene& scene = drawn.scene;
    const grid::GridSpec& spec = *drawn.view.spec;
    const View view = view_of(scene.product);
    if (view == View::section) return draw_whole_section(drawn, size, fonts, threads);
    const ViewGeometry geometry = picture_geometry(spec, scene, size.width, size.height);
    MapLines lines{.geometry = &geometry,
                   .spec = &spec,
                   .sites = &drawn.facts.sites,
                   .ring_spacing_m = drawn_ring_spacing(spec, scene),
                   .units = scene.units,
                   .cells = drawn.overlays.cells,
                   .shapes = drawn.overlays.shapes,
                   .time = drawn.facts.time,
                   .heights = view == View::volume,
                   .scale = size.scale,
                   .shades = &shades_of(scene.theme)};
    GroundLook look{lines.shades, nullptr, size.scale};
    const bool has_glyphs = scene.glyphs && drawn.view.sweep != nullptr;
    if (fonts != nullptr) {
        if (has_glyphs) lines.glyph_key = size_of_glyph_key(*fonts, scene.units, size.scale);
        const auto map = cache.map.get(spec, geometry, size.scale, threads);
        if (!map) return pass_on(map);
        lines.map = *map;
        look.water = &lines.map->water;
    }
    auto base = paint_base(drawn, geometry, look, threads);
    if (!base) return base;
    Canvas canvas(*base);
    if (fonts != nullptr) draw_map(canvas, *lines.map, *lines.shades, size.scale);
    draw_border(canvas, lines);
    if (fonts != nullptr) draw_rings(canvas, lines);
    if (view == View::volume) {
        Image picture = canvas.image();
        draw_volume(drawn, geometry, threads, cache, picture);
        if (drawn.overlays.rotation != nullptr) draw_rotation(drawn, geometry, threads, picture);
        const bool has_marks = lines.cells != nullptr || lines.shapes != nullptr;
        if (fonts == nullptr && !has_marks) return picture;
        canvas.place(picture, 0, 0);
    }
    const MapMarks marks = fonts != nullptr ? plan_marks(*fonts, lines) : MapMarks{};
    if (has_glyphs)
        draw_beam_glyphs(canvas, plan_beam_glyphs(*drawn.view.sweep, lines, marks), lines);
    if (fonts != nullptr) draw_marks(canvas, *fonts, lines, marks);
    if (fonts == nullptr) {
        LabelPlaces places({});
        draw_shape_marks(canvas, plan_shape_marks(nullptr, lines, places), lines);
        draw_cell_marks(canvas, plan_cell_marks(nullptr, lines, places), lines);
    }
    if (marks.glyph_key) draw_glyph_key(canvas, *fonts, lines, *marks.glyph_key);
    return canvas.image();
}

Result<Image> draw_section_inset(const DrawnView& drawn, const PictureSize& size,
                                 const Fonts& fonts, int threads, FrameCache& cache) {
    const grid::GridSpec& spec = *drawn.view.spec;
    Scene scene = drawn.scene;
    scene.product = Product::composite;
    scene.camera.zoom = 1;
    // A short line would be lost in the map of the whole grid. So draw a larger map, and show the
    // part of it around the line.
    const auto whole = picture_geometry(spec, scene, size.width, size.height);
    const auto in_whole = line_in_picture(spec, *scene.section, whole);
    const double across =
        std::hypot(in_whole.back().x - in_whole.front().x, in_whole.back().y - in_whole.front().y);
    const double larger = std::clamp(
        0.6 * std::min(size.width, size.height) / std::max(1.0, across), 1.0, largest_inset);
    const int width = static_cast<int>(larger * size.width);
    const int height = static_cast<int>(larger * size.height);
    const ViewGeometry geometry = picture_geometry(spec, scene, width, height);
    const auto line = line_in_picture(spec, *scene.section, geometry);
    const Point middle = line[line.size() / 2];
    const auto first_shown = [](double at, int all, int shown) {
        return static_cast<int>(
            std::clamp(at - 0.5 * shown, 0.0, static_cast<double>(all - shown)));
    };
    const int left = first_shown(middle.x, width, size.width);
    const int top = first_shown(middle.y, height, size.height);

    const auto map = cache.map.get(spec, geometry, size.scale, threads);
    if (!map) return pass_on(map);
    const Shades& shades = shades_of(scene.theme);
    const auto base = paint_base({drawn.view, drawn.facts, scene, drawn.columns}, geometry,
                                 {&shades, &(*map)->water, 0.6 * size.scale}, threads);
    if (!base) return pass_on(base);
    Canvas canvas(size.width, size.height, shades.page);
    canvas.place(*base, -left, -top);
    const Point offset = {-static_cast<double>(left), -static_cast<double>(top)};
    draw_map(canvas, **map, shades, 0.8 * size.scale, offset);
    draw_section_line(canvas, fonts, line, offset, size, shades);
    return canvas.image();
}

}  // namespace stormcellar::render
