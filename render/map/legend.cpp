#include "render/map/legend.h"

#include <fmt/format.h>

#include "render/color/built_in_tables.h"
#include "render/image/shades.h"
#include "render/products/ground.h"
#include "render/products/rotation.h"
#include "render/view/length_text.h"
#include "render/volume/haze.h"
#include "stormcellar/render/product.h"
#include "stormcellar/retrieve/hydrometeors.h"

namespace stormcellar::render {
namespace {

// Returns a text such as "no echo and < 5 dBZ" for a table that begins at 5 dBZ. Returns "no echo"
// for a table that covers all values.
std::string clear_words(const Scene& scene, std::string_view between) {
    const ColorTable& table = colors_of(scene);
    const bool takes_all = table.bar_begin || level2::facts_of(scene.moment).is_categorical ||
                           (look_of(scene.moment).is_never_negative && !(table.lowest() > 0));
    if (takes_all) return "no echo";
    const ShownUnit unit = written_unit(scene);
    return fmt::format("no echo {} < {}", between, value_text(table.lowest(), unit, 4));
}

void add_volume_rows(const Scene& scene, Legend& legend) {
    const std::string height = height_text(low_coverage_m, scene.units);
    const Shades& shades = shades_of(scene.theme);
    if (scene.haze) {
        legend.heading = "Coverage";
        legend.rows = {{"air seen", shades.land.seen},
                       {"air not seen", veiled(shades.land.seen, shades.haze, most_haze)},
                       {"nothing seen", shades.land.not_seen, shades.hatch}};
    } else {
        legend.heading = "Coverage (ground)";
        legend.rows = {{"seen below " + height, shades.land.seen},
                       {"seen above " + height, shades.land.seen_aloft},
                       {"not seen", shades.land.not_seen, shades.hatch}};
    }
    legend.notes = {clear_words(scene, "and"), "are clear"};
    if (level2::facts_of(scene.moment).is_derived) legend.notes.front() += ", ambiguous";
}

void add_flat_rows(const Scene& scene, Legend& legend) {
    const ProductFacts& facts = facts_of(scene.product);
    const Shades& shades = shades_of(scene.theme);
    if (facts.may_be_higher) {
        legend.rows.push_back({"dotted: at least", shades.page});
    }
    if (facts.threshold_dbz != nullptr) {
        legend.rows.push_back(
            {fmt::format("no echo or < {:g} dBZ", scene.*facts.threshold_dbz), shades.land.seen});
    } else if (facts.has_echo_states) {
        legend.rows.push_back({clear_words(scene, "or"), shades.land.seen});
    }
    if (facts.has_echo_states) {
        const Rgba8 folded = colors_of(scene).range_folded;
        legend.rows.push_back({"range folded", folded});
        if (level2::facts_of(scene.moment).is_derived)
            legend.rows.push_back({"ambiguous", shades.land.seen, folded});
    }
    legend.rows.push_back({"not seen", shades.land.not_seen, shades.hatch});
}

// Puts the names of the classes in place of the color bar.
void add_class_rows(const Scene& scene, Legend& legend) {
    legend.table = nullptr;
    for (std::size_t i = 1; i < retrieve::hydrometeor_count; ++i) {
        const auto kind = static_cast<retrieve::Hydrometeor>(i);
        const auto color = color_of(colors_of(scene), retrieve::hydrometeor_number(kind));
        if (color) legend.rows.push_back({std::string(retrieve::hydrometeor_name(kind)), *color});
    }
}

}  // namespace

Legend legend_of(const Scene& scene) {
    Legend legend;
    legend.product = product_title(scene);
    legend.table = &colors_of(scene);
    const ShownUnit unit = written_unit(scene);
    legend.bar_heading = unit.symbol;
    legend.shown_per_value = unit.per_stored;
    if (legend.bar_heading.empty()) legend.bar_heading = level2::moment_name(scene.moment);
    if (level2::facts_of(scene.moment).is_categorical) add_class_rows(scene, legend);
    if (view_of(scene.product) == View::volume) {
        add_volume_rows(scene, legend);
    } else {
        add_flat_rows(scene, legend);
    }
    return legend;
}

void add_rotation_rows(Legend& legend) {
    legend.rows.push_back({"cyclonic shear", cyclonic_color});
    legend.rows.push_back({"anticyclonic shear", anticyclonic_color});
}

}  // namespace stormcellar::render
