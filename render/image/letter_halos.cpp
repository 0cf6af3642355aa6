#include "render/image/letter_halos.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <cairo.h>

namespace stormcellar::render {
namespace {

struct SurfaceEnd {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct ContextEnd {
    void operator()(cairo_t* context) const { cairo_destroy(context); }
};
struct GlyphsEnd {
    void operator()(cairo_glyph_t* glyphs) const { cairo_glyph_free(glyphs); }
};
using SurfaceOwner = std::unique_ptr<cairo_surface_t, SurfaceEnd>;
using ContextOwner = std::unique_ptr<cairo_t, ContextEnd>;
using GlyphsOwner = std::unique_ptr<cairo_glyph_t, GlyphsEnd>;

CoverMask empty_mask(int left, int top, int width, int height) {
    const int stride = cairo_format_stride_for_width(CAIRO_FORMAT_A8, width);
    CoverMask mask{left, top, width, height, stride, {}};
    mask.cover.assign(static_cast<std::size_t>(stride) * static_cast<std::size_t>(height), 0);
    return mask;
}

SurfaceOwner surface_of(CoverMask& mask) {
    return SurfaceOwner(cairo_image_surface_create_for_data(mask.cover.data(), CAIRO_FORMAT_A8,
                                                            mask.width, mask.height, mask.stride));
}

void put_outline(cairo_t* context, cairo_scaled_font_t* font, cairo_glyph_t glyph, double pen) {
    cairo_set_scaled_font(context, font);
    cairo_glyph_path(context, &glyph, 1);
    cairo_set_line_width(context, pen);
    cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
}

// Draws a letter at the origin. If the letter has no lines, like a space, the mask is empty.
CoverMask draw_letter(cairo_scaled_font_t* font, unsigned long number, double pen) {
    const SurfaceOwner nowhere(cairo_recording_surface_create(CAIRO_CONTENT_ALPHA, nullptr));
    const ContextOwner ruler(cairo_create(nowhere.get()));
    put_outline(ruler.get(), font, {number, 0, 0}, pen);
    double left = 0, top = 0, right = 0, bottom = 0;
    cairo_stroke_extents(ruler.get(), &left, &top, &right, &bottom);
    if (!(right > left && bottom > top)) return {};
    const int first_x = static_cast<int>(std::floor(left)) - 1;
    const int first_y = static_cast<int>(std::floor(top)) - 1;
    CoverMask mask = empty_mask(first_x, first_y, static_cast<int>(std::ceil(right)) + 1 - first_x,
                                static_cast<int>(std::ceil(bottom)) + 1 - first_y);
    const SurfaceOwner surface = surface_of(mask);
    const ContextOwner context(cairo_create(surface.get()));
    put_outline(context.get(), font,
                {number, -static_cast<double>(first_x), -static_cast<double>(first_y)}, pen);
    cairo_set_source_rgba(context.get(), 0, 0, 0, 1);
    cairo_stroke(context.get());
    cairo_surface_flush(surface.get());
    return mask;
}

// A letter, and the place at which its mask begins.
struct PlacedLetter {
    const CoverMask* mask;
    int left, top;
};

CoverMask mask_about(const std::vector<PlacedLetter>& letters) {
    int left = std::numeric_limits<int>::max(), right = std::numeric_limits<int>::min();
    int top = left, bottom = right;
    for (const PlacedLetter& letter : letters) {
        left = std::min(left, letter.left);
        top = std::min(top, letter.top);
        right = std::max(right, letter.left + letter.mask->width);
        bottom = std::max(bottom, letter.top + letter.mask->height);
    }
    return letters.empty() ? CoverMask{} : empty_mask(left, top, right - left, bottom - top);
}

void add_letter(const PlacedLetter& letter, CoverMask& all) {
    for (int y = 0; y < letter.mask->height; ++y) {
        const std::uint8_t* const from =
            letter.mask->cover.data() + static_cast<std::ptrdiff_t>(y) * letter.mask->stride;
        std::uint8_t* const to =
            all.cover.data() + static_cast<std::ptrdiff_t>(letter.top - all.top + y) * all.stride +
            (letter.left - all.left);
        for (int x = 0; x < letter.mask->width; ++x)
            to[x] = static_cast<std::uint8_t>(std::min(to[x] + from[x], 255));
    }
}

}  // namespace

const CoverMask& LetterHalos::letter(cairo_scaled_font_t* font, const Key& key, double pen) {
    const auto found = letters_.find(key);
    if (found != letters_.end()) return found->second;
    return letters_.emplace(key, draw_letter(font, std::get<2>(key), pen)).first->second;
}

CoverMask LetterHalos::halo_of(cairo_scaled_font_t* font, bool bold, double size, const char* text,
                               int x, int y, double pen) {
    cairo_glyph_t* found = nullptr;
    int count = 0;
    const auto status = cairo_scaled_font_text_to_glyphs(font, x, y, text, -1, &found, &count,
                                                         nullptr, nullptr, nullptr);
    if (status != CAIRO_STATUS_SUCCESS) return {};
    const GlyphsOwner glyphs(found);
    std::vector<PlacedLetter> letters;
    for (int i = 0; i < count; ++i) {
        const cairo_glyph_t& glyph = found[i];
        const CoverMask& mask = letter(font, {bold, size, glyph.index}, pen);
        if (mask.width == 0) continue;
        letters.push_back({&mask, mask.left + static_cast<int>(std::lround(glyph.x)),
                           mask.top + static_cast<int>(std::lround(glyph.y))});
    }
    CoverMask all = mask_about(letters);
    for (const PlacedLetter& letter : letters)
        add_letter(letter, all);
    return all;
}

void paint_cover(cairo_t* context, CoverMask& mask) {
    if (mask.width == 0) return;
    const SurfaceOwner surface = surface_of(mask);
    cairo_mask_surface(context, surface.get(), mask.left, mask.top);
}

}  // namespace stormcellar::render
