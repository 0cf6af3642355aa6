#include "stormcellar/render/product.h"

#include <array>
#include <cctype>
#include <vector>

#include "base/name_list.h"
#include "render/color/built_in_tables.h"
#include "render/image/unknown_name.h"
#include "render/view/length_text.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {
namespace {

std::string title_of_moment(const Scene& scene) {
    return std::string(look_of(scene.moment).title);
}
std::string volume_title(const Scene& scene) {
    return title_of_moment(scene) + ", 3D volume";
}
std::string composite_title(const Scene& scene) {
    std::string title = title_of_moment(scene);
    title.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(title.front())));
    return "Composite " + title + " (column maximum)";
}
std::string ppi_title(const Scene& scene) {
    return fmt::format("{} at {:.1f} degrees elevation (PPI)", title_of_moment(scene),
                       scene.elevation_deg);
}
std::string cappi_title(const Scene& scene) {
    const UnitFacts& unit = facts_of(scene.units.height);
    return fmt::format("{} at {} {} above sea level (CAPPI)", title_of_moment(scene),
                       number_text(scene.cappi_height_m / unit.si, 4), unit.symbol);
}
std::string section_title(const Scene& scene) {
    return title_of_moment(scene) + ", vertical section";
}
std::string echo_top_title(const Scene& scene) {
    return fmt::format("Echo tops, {:g} dBZ", scene.echo_top_dbz);
}
std::string vil_title(const Scene& /*scene*/) {
    return "Vertically integrated liquid";
}
std::string vil_density_title(const Scene& scene) {
    return fmt::format("VIL density, echo tops of {:g} dBZ", scene.echo_top_dbz);
}
std::string maximum_height_title(const Scene& scene) {
    return fmt::format("Height of the maximum reflectivity, from {:g} dBZ", scene.echo_top_dbz);
}
std::string lowest_seen_title(const Scene& /*scene*/) {
    return "Lowest height seen";
}
std::string highest_seen_title(const Scene& /*scene*/) {
    return "Highest height seen";
}

// The layers of MRMS (Smith et al. 2016), above the radar instead of the ground.
constexpr HeightLayer low_layer{0, 2000}, middle_layer{3000, 6000};

std::string title_of_layer(std::string_view what, const HeightLayer& layer, const Units& units) {
    const UnitFacts& unit = facts_of(units.height);
    return fmt::format("{}, largest azimuthal shear {} to {} {} above the radar", what,
                       number_text(layer.bottom_m / unit.si, 3),
                       number_text(layer.top_m / unit.si, 3), unit.symbol);
}
std::string rotation_title(const Scene& scene) {
    return title_of_layer("Rotation", low_layer, scene.units);
}
std::string rotation_aloft_title(const Scene& scene) {
    return title_of_layer("Rotation aloft", middle_layer, scene.units);
}
std::string rotation_tracks_title(const Scene& scene) {
    return title_of_layer("Rotation tracks", low_layer, scene.units);
}

// Adds the heights that the picture assumes to the name of a product of hail.
std::string title_of_hail(std::string_view what, const Scene& scene) {
    return fmt::format("{}, assuming 0 C at {} and -20 C at {}", what,
                       height_text(scene.freezing_levels.zero_c_m, scene.units),
                       height_text(scene.freezing_levels.minus_20_c_m, scene.units));
}
std::string mesh_title(const Scene& scene) {
    return title_of_hail("Maximum expected size of hail (MESH)", scene);
}
std::string posh_title(const Scene& scene) {
    return title_of_hail("Probability of severe hail (POSH)", scene);
}
std::string shi_title(const Scene& scene) {
    return title_of_hail("Severe hail index (SHI)", scene);
}
std::string rain_total_title(const Scene& /*scene*/) {
    return "Rain total at the lowest height seen";
}

constexpr auto product_facts = std::to_array<ProductFacts>({
    {.product = Product::volume, .name = "volume", .view = View::volume, .title = volume_title},
    {.product = Product::composite,
     .name = "composite",
     .aside = "column maximum",
     .title = composite_title,
     .is_smooth = true},
    {.product = Product::ppi,
     .name = "ppi",
     .aside = "one sweep as the radar saw it",
     .title = ppi_title,
     .is_of_sweep = true},
    {.product = Product::cappi, .name = "cappi", .title = cappi_title, .is_smooth = true},
    {.product = Product::section, .name = "section", .view = View::section, .title = section_title},
    {.product = Product::echo_top,
     .name = "echotop",
     .title = echo_top_title,
     .unit = "km",
     .colors = echo_top_colors,
     .only_moment = level2::Moment::ref,
     .threshold_dbz = &Scene::echo_top_dbz,
     .may_be_higher = true,
     .is_smooth = true},
    {.product = Product::vil,
     .name = "vil",
     .title = vil_title,
     .unit = "kg/m2",
     .colors = vil_colors,
     .only_moment = level2::Moment::ref,
     .is_smooth = true},
    {.product = Product::vil_density,
     .name = "vil-density",
     .title = vil_density_title,
     .unit = "g/m3",
     .colors = vil_density_colors,
     .only_moment = level2::Moment::ref,
     .threshold_dbz = &Scene::echo_top_dbz,
     .is_smooth = true},
    {.product = Product::maximum_height,
     .name = "maximum-height",
     .aside = "of the column maximum",
     .title = maximum_height_title,
     .unit = "km",
     .colors = height_colors,
     .only_moment = level2::Moment::ref,
     .threshold_dbz = &Scene::echo_top_dbz,
     .is_smooth = true},
    {.product = Product::lowest_seen,
     .name = "lowest-seen",
     .title = lowest_seen_title,
     .unit = "km",
     .colors = height_colors,
     .has_echo_states = false},
    {.product = Product::highest_seen,
     .name = "highest-seen",
     .title = highest_seen_title,
     .unit = "km",
     .colors = height_colors,
     .has_echo_states = false},
    {.product = Product::rotation,
     .name = "rotation",
     .aside = "largest azimuthal shear 0 to 2 km above the radar",
     .title = rotation_title,
     .only_moment = level2::Moment::azsh,
     .is_smooth = true,
     .layer = low_layer},
    {.product = Product::rotation_aloft,
     .name = "rotation-aloft",
     .aside = "3 to 6 km",
     .title = rotation_aloft_title,
     .only_moment = level2::Moment::azsh,
     .is_smooth = true,
     .layer = middle_layer},
    {.product = Product::rotation_tracks,
     .name = "rotation-tracks",
     .aside = "rotation, the largest of several volumes",
     .title = rotation_tracks_title,
     .only_moment = level2::Moment::azsh,
     .is_smooth = true,
     .layer = low_layer,
     .is_over_time = true},
    {.product = Product::mesh,
     .name = "mesh",
     .aside = "size of hail",
     .title = mesh_title,
     .unit = "mm",
     .colors = hail_size_colors,
     .only_moment = level2::Moment::ref,
     .may_be_higher = true,
     .is_smooth = true,
     .hail = &retrieve::Hail::mesh_mm},
    {.product = Product::posh,
     .name = "posh",
     .aside = "probability of severe hail",
     .title = posh_title,
     .unit = "%",
     .colors = hail_probability_colors,
     .only_moment = level2::Moment::ref,
     .may_be_higher = true,
     .is_smooth = true,
     .hail = &retrieve::Hail::posh_percent},
    {.product = Product::shi,
     .name = "shi",
     .aside = "severe hail index",
     .title = shi_title,
     .unit = "J/m/s",
     .colors = hail_index_colors,
     .only_moment = level2::Moment::ref,
     .may_be_higher = true,
     .is_smooth = true,
     .hail = &retrieve::Hail::shi_j_per_m_s},
    {.product = Product::rain_total,
     .name = "rain-total",
     .aside = "of several volumes",
     .title = rain_total_title,
     .unit = "mm",
     .colors = rain_total_colors,
     .only_moment = level2::Moment::rate,
     .is_smooth = true,
     .is_over_time = true,
     .is_sum = true},
});
static_assert(is_in_order(product_facts, &ProductFacts::product));

}  // namespace

std::span<const ProductFacts> all_products() {
    return product_facts;
}

const ProductFacts& facts_of(Product product) {
    return product_facts[static_cast<std::size_t>(product)];
}

std::string_view product_name(Product product) {
    return facts_of(product).name;
}

Result<Product> product_from_name(std::string_view name) {
    std::vector<std::string> names;
    for (const ProductFacts& facts : product_facts) {
        if (facts.name == name) return facts.product;
        names.emplace_back(facts.name);
    }
    return unknown_name("product", name, names, "products are " + names_in(product_facts));
}

std::string products_for_help() {
    struct Named {
        std::string name;
    };
    std::vector<Named> all;
    for (const ProductFacts& facts : product_facts) {
        all.push_back({std::string(facts.name)});
        if (!facts.aside.empty()) all.back().name += fmt::format(" ({})", facts.aside);
    }
    return names_in(all, ", ", " or ");
}

View view_of(Product product) {
    return facts_of(product).view;
}

bool is_map(Product product) {
    return view_of(product) == View::map;
}

std::string product_title(const Scene& scene) {
    return facts_of(scene.product).title(scene);
}

const ColorTable& colors_of(const Scene& scene) {
    if (scene.colors) return *scene.colors;
    const auto colors = facts_of(scene.product).colors;
    return colors != nullptr ? colors() : default_color_table(scene.moment);
}

std::string unit_shown(const Scene& scene) {
    const std::string_view unit = facts_of(scene.product).unit;
    return unit.empty() ? unit_of(scene.moment) : std::string(unit);
}

ShownUnit written_unit(const Scene& scene) {
    return shown_unit(unit_shown(scene), scene.units);
}

}  // namespace stormcellar::render
