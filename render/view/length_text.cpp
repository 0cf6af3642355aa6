#include "render/view/length_text.h"

#include <fmt/format.h>

namespace stormcellar::render {

std::string distance_text(double metres) {
    return metres < 1000 ? fmt::format("{:g} m", metres) : fmt::format("{:g} km", metres / 1000);
}

}  // namespace stormcellar::render
