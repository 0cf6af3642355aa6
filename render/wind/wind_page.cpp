#include "render/wind/wind_page.h"

#include <algorithm>
#include <cmath>

#include "base/degree.h"

namespace stormcellar::render {
namespace {

constexpr double usual_side_px = 800;
constexpr double least_letter_px = 6;

}  // namespace

double WindCanvas::scale_of(const WindPage& page) {
    return std::clamp(std::min(page.width, page.height) / usual_side_px, 0.7, 10.0);
}

WindCanvas::WindCanvas(const WindPage& page, const Fonts& fonts)
    : scale_(scale_of(page)),
      shades_(shades_of(page.theme)),
      fonts_(fonts),
      canvas_(page.width, page.height, shades_.page),
      width_(page.width) {}

double WindCanvas::write(const std::string& text, Point baseline, const Style& style) {
    double size = style.size * scale_;
    const double whole = fonts_.width(text, size, style.is_bold);
    const double room = std::max(style.room, 1.0);
    if (whole > room) size = std::max(size * room / whole, least_letter_px);
    const double width = fonts_.width(text, size, style.is_bold);
    const double left = baseline.x - style.share * width;
    canvas_.text(fonts_, text, {left, baseline.y}, size, style.is_bold,
                 style.is_quiet ? shades_.quiet_text : shades_.text,
                 style.has_halo ? shades_.halo : Rgba8{0, 0, 0, 0});
    return left + width;
}

void WindCanvas::write_title(const std::string& title, const std::string& below) {
    const double left = 14 * scale_, room = width_ - 28 * scale_;
    write(title, {left, 22 * scale_}, {.size = 15, .is_bold = true, .room = room});
    write(below, {left, 39 * scale_}, {.size = 11, .is_quiet = true, .room = room});
}

void WindCanvas::disc(Point middle, double radius, Rgba8 color) {
    std::vector<Point> circle;
    for (int i = 0; i < 32; ++i) {
        const double turn = i * 11.25 * degree;
        circle.push_back({middle.x + radius * std::sin(turn), middle.y - radius * std::cos(turn)});
    }
    canvas_.fill(circle, color);
}

std::string minute_text(UtcTime time) {
    const std::string text = format_utc(time);  // 1999-05-03T23:56:21.842Z
    return text.substr(0, 10) + " " + text.substr(11, 5) + " UTC";
}

}  // namespace stormcellar::render
