#include "render/still/map_attributes.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "retrieve/derived/quality_note.h"
#include "stormcellar/render/product.h"

namespace stormcellar::render {
namespace {

constexpr std::array all_state_classes{
    StateClass{0, "not seen", {96, 100, 108}},
    StateClass{1, "no echo", {232, 236, 242}},
    StateClass{2, "range folded", {119, 0, 125}},
    StateClass{3, "value", {47, 196, 98}},
    StateClass{at_least_code, "value or more", {255, 160, 42}},
    StateClass{5, "ambiguous", {187, 128, 190}},
};
static_assert(all_state_classes.back().code ==
              static_cast<std::uint8_t>(grid::CellStatus::ambiguous));

// The names that CF has for a product; empty if it has none.
struct CfNames {
    std::string_view standard_name = {};
    std::string_view cell_methods = {};
};

CfNames cf_names(const Scene& scene) {
    const std::string_view of_moment = level2::facts_of(scene.moment).netcdf.cf;
    switch (scene.product) {
        case Product::composite:
            return {of_moment, "altitude: maximum"};
        case Product::cappi:
            return {of_moment, "altitude: point"};
        case Product::ppi:
            return {of_moment, "area: point"};
        case Product::echo_top:
        case Product::maximum_height:
        case Product::lowest_seen:
        case Product::highest_seen:
            return {"altitude", ""};
        case Product::rotation:
        case Product::rotation_aloft:
            return {"", "altitude: maximum"};
        case Product::rotation_tracks:
            return {"", "altitude: maximum time: maximum"};
        case Product::rain_total:
            return {"thickness_of_rainfall_amount", "time: sum"};
        case Product::volume:
        case Product::section:
        case Product::vil:
        case Product::vil_density:
        case Product::mesh:
        case Product::posh:
        case Product::shi:
            break;
    }
    return {};
}

// Adds the numbers of the scene on which the product depends.
void add_numbers(const Scene& scene, netcdf::CfAttributes& attributes) {
    const ProductFacts& product = facts_of(scene.product);
    const auto add = [&](const char* name, double number) {
        attributes.emplace_back(name, number);
    };
    if (product.threshold_dbz != nullptr) add("threshold_dbz", scene.*product.threshold_dbz);
    if (scene.product == Product::cappi) add("height_above_sea_level_m", scene.cappi_height_m);
    if (scene.product == Product::ppi) add("elevation_deg", scene.elevation_deg);
    if (product.layer) {
        add("layer_bottom_above_radar_m", product.layer->bottom_m);
        add("layer_top_above_radar_m", product.layer->top_m);
    }
    if (product.hail == nullptr) return;
    add("assumed_height_of_0_C_m", scene.freezing_levels.zero_c_m);
    add("assumed_height_of_minus_20_C_m", scene.freezing_levels.minus_20_c_m);
}

// Returns the name of an attribute for a keyword of metadata: "Hail error" gives "hail_error".
std::string attribute_name(std::string_view keyword) {
    std::string name;
    for (const char c : keyword) {
        const bool is_letter = std::isalnum(static_cast<unsigned char>(c)) != 0;
        name += is_letter ? static_cast<char>(std::tolower(static_cast<unsigned char>(c))) : '_';
    }
    return name;
}

}  // namespace

std::span<const StateClass> state_classes(level2::Moment moment) {
    const bool is_derived = level2::facts_of(moment).is_derived;
    return std::span(all_state_classes).first(all_state_classes.size() - (is_derived ? 0 : 1));
}

std::uint8_t state_code(grid::CellStatus status, bool at_least) {
    const bool is_more = at_least && status == grid::CellStatus::value;
    return is_more ? at_least_code : static_cast<std::uint8_t>(status);
}

std::uint8_t state_of(const FlatField& field, std::size_t place) {
    return state_code(field.status[place], !field.at_least.empty() && field.at_least[place] != 0);
}

std::string map_variable(Product product) {
    std::string name{product_name(product)};
    std::ranges::replace(name, '-', '_');
    return name;
}

netcdf::CfAttributes map_attributes(const Scene& scene, const FrameFacts& facts) {
    Scene in_grid_units = scene;
    in_grid_units.units = {};
    const std::string unit = unit_shown(scene);
    netcdf::CfAttributes attributes = {{"long_name", product_title(in_grid_units)},
                                       {"units", unit.empty() ? std::string("1") : unit}};
    const CfNames names = cf_names(scene);
    if (!names.standard_name.empty())
        attributes.emplace_back("standard_name", std::string(names.standard_name));
    if (!names.cell_methods.empty())
        attributes.emplace_back("cell_methods", std::string(names.cell_methods));
    add_numbers(scene, attributes);
    if (facts_of(scene.product).layer && facts.sites.size() > 1)
        attributes.emplace_back("layer_is_above", "the lowest radar");
    const auto quality = retrieve::quality_note_in(std::span(&facts.quality, 1));
    if (quality) attributes.emplace_back("least_probability_of_weather", quality->least);
    if (quality && quality->share)
        attributes.emplace_back("share_of_echo_left_out", *quality->share);
    return attributes;
}

netcdf::CfAttributes map_state_attributes(const Scene& scene) {
    netcdf::CfAttributes attributes = netcdf::status_attributes(scene.moment);
    for (auto& [name, value] : attributes) {
        if (name == "long_name") value = "what a column holds";
        if (name != "comment" || !facts_of(scene.product).may_be_higher) continue;
        value = std::get<std::string>(value) +
                "; value_or_more: the true value may be larger, because air beside the echo was "
                "not seen";
    }
    return attributes;
}

std::string state_word(const StateClass& state) {
    std::string word{state.name};
    std::ranges::replace(word, ' ', '_');
    return word;
}

bool may_have(Product product, const StateClass& state) {
    return state.code != at_least_code || facts_of(product).may_be_higher;
}

netcdf::CfAttributes map_file_attributes(const StillMap& map, const StillOptions& options) {
    netcdf::CfAttributes attributes;
    for (const auto& [keyword, text] : options.metadata)
        if (keyword != "Units") attributes.emplace_back(attribute_name(keyword), text);
    const auto add = [&](const char* name, const std::string& text) {
        if (!text.empty()) attributes.emplace_back(name, text);
    };
    add("source", "weather radar Level II volumes");
    add("volume", map.facts.partial ? "partial" : "complete");
    add("quality", map.facts.quality);
    add("dealiasing", map.facts.dealiasing);
    add("nowcast", map.facts.nowcast);
    add("nowcast_score", map.facts.nowcast_score);
    return attributes;
}

}  // namespace stormcellar::render
