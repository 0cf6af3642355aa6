#include "render/image/area_mask.h"

#include <cstddef>

#include <cairo.h>

namespace stormcellar::render {

void AreaMask::Surface::operator()(cairo_surface_t* surface) const {
    cairo_surface_destroy(surface);
}
void AreaMask::Context::operator()(cairo_t* context) const {
    cairo_destroy(context);
}

AreaMask::AreaMask(int width, int height)
    : width_(width),
      height_(height),
      surface_(cairo_image_surface_create(CAIRO_FORMAT_A8, width, height)),
      context_(cairo_create(surface_.get())) {
    cairo_set_fill_rule(context_.get(), CAIRO_FILL_RULE_WINDING);
    cairo_set_source_rgba(context_.get(), 0, 0, 0, 1);
}

void AreaMask::add(const std::vector<Point>& ring) {
    cairo_new_sub_path(context_.get());
    for (const Point& p : ring)
        cairo_line_to(context_.get(), p.x, p.y);
    cairo_close_path(context_.get());
}

void AreaMask::put(bool inside) {
    cairo_set_operator(context_.get(), inside ? CAIRO_OPERATOR_OVER : CAIRO_OPERATOR_DEST_OUT);
    cairo_fill(context_.get());
}

std::vector<std::uint8_t> AreaMask::cells() const {
    cairo_surface_flush(surface_.get());
    const unsigned char* rows = cairo_image_surface_get_data(surface_.get());
    const int stride = cairo_image_surface_get_stride(surface_.get());
    std::vector<std::uint8_t> cells;
    cells.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    for (int y = 0; y < height_; ++y) {
        const unsigned char* row = rows + static_cast<std::ptrdiff_t>(y) * stride;
        cells.insert(cells.end(), row, row + width_);
    }
    return cells;
}

}  // namespace stormcellar::render
