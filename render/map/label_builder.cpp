#include "render/map/label_builder.h"

#include <utility>

namespace stormcellar::render {
namespace {

double share_before(Align align) {
    switch (align) {
        case Align::left:
            return 0;
        case Align::middle:
            return 0.5;
        case Align::right:
            break;
    }
    return 1;
}

}  // namespace

double LabelBuilder::put(std::string text, double x, double baseline, double room,
                         const LabelStyle& style, Align align) {
    if (text.empty() || room <= 0) return 0;
    double size = scaled(style.size);
    const double smallest = 0.75 * size;
    while (fonts_.width(text, size, style.bold) > room && size > smallest)
        size -= 0.25;
    text = shortened(std::move(text), size, style.bold, room);
    if (text.empty()) return 0;
    const double width = fonts_.width(text, size, style.bold);
    const double left = x - share_before(align) * width;
    parts_.texts.push_back({{left, baseline - 0.8 * size, width, 1.05 * size},
                            baseline,
                            size,
                            style.bold,
                            style.color,
                            std::move(text)});
    return width;
}

// Returns the text. If it does not fit into the room, shortens it and adds an ellipsis. Returns an
// empty text if not even the ellipsis fits.
std::string LabelBuilder::shortened(std::string text, double size, bool bold, double room) const {
    if (fonts_.width(text, size, bold) <= room) return text;
    // Removes only whole characters of UTF-8. Also removes spaces before the ellipsis.
    const auto cut = [&text](std::size_t bytes) {
        while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0U) == 0x80U)
            --bytes;
        while (bytes > 0 && text[bytes - 1] == ' ')
            --bytes;
        return text.substr(0, bytes) + "\u2026";
    };
    std::size_t fits = 0;
    std::size_t too_long = text.size();
    while (too_long - fits > 1) {
        const std::size_t middle = (fits + too_long) / 2;
        (fonts_.width(cut(middle), size, bold) <= room ? fits : too_long) = middle;
    }
    return fits == 0 ? std::string{} : cut(fits);
}

}  // namespace stormcellar::render
