#include "render/colour_table.h"

#include <cmath>

namespace stormcellar::render {

std::optional<Rgba8> nws_reflectivity_colour(float dbz) {
    std::optional<Rgba8> colour;
    for (const ColourClass& c : nws_reflectivity) {
        if (std::isgreaterequal(dbz, c.from_dbz)) colour = c.colour;
    }
    return colour;
}

}  // namespace stormcellar::render
