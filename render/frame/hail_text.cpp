#include "render/frame/hail_text.h"

#include <fmt/format.h>

#include "render/products/hail_field.h"
#include "stormcellar/render/product.h"

namespace stormcellar::render {

Result<std::string> hail_sensitivity(const grid::BrickView& view, const Scene& scene, int threads) {
    if (facts_of(scene.product).hail == nullptr) return std::string{};
    const auto largest = largest_hail(view, scene.freezing_levels, threads);
    if (!largest) return pass_on(largest);
    if (!*largest) return std::string{};
    return fmt::format("heights {:g} m off: MESH {:.1f} mm is {:.1f} to {:.1f} mm",
                       retrieve::usual_level_error_m, (*largest)->mesh_mm,
                       (*largest)->range.least_mm, (*largest)->range.most_mm);
}

}  // namespace stormcellar::render
