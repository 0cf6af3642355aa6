#include "web/data/pictures/map_product.h"

#include <algorithm>
#include <array>
#include <charconv>

#include <fmt/ranges.h>

#include "base/printable.h"
#include "render/options/moment_name.h"
#include "render/options/scene_options.h"
#include "web/data/storms/rain_totals.h"

namespace stormcellar::web {
namespace {

constexpr std::size_t longest_shown = 80;
constexpr std::array usual_hours{1, 3, 24};

bool is_of_grids(const render::ProductFacts& facts) {
    return facts.view == render::View::map && !facts.is_of_sweep &&
           (!facts.is_over_time || facts.is_sum);
}

// Reads the length of a rain total, as in "3h".
std::optional<int> hours_in(std::string_view text) {
    int hours = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), hours);
    const bool is_number = error == std::errc{} && !text.starts_with('0');
    if (!is_number || std::string_view(rest, text.data() + text.size()) != "h") return std::nullopt;
    return hours >= 1 && hours <= RainTotals::most_hours ? std::optional(hours) : std::nullopt;
}

std::string names_of_products() {
    std::vector<std::string_view> names;
    for (const render::ProductFacts& facts : render::all_products())
        if (is_of_grids(facts)) names.push_back(facts.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::string MapProduct::name() const {
    const render::ProductFacts& facts = render::facts_of(product);
    if (hours > 0) return fmt::format("{}.{}h", facts.name, hours);
    if (facts.only_moment) return std::string(facts.name);
    return fmt::format("{}.{}", facts.name, level2::moment_name(moment));
}

Result<level2::Moment> moment_in_layer(std::string_view name) {
    const std::size_t dot = name.find('.');
    if (dot == name.npos) return level2::Moment::ref;
    const auto moment = level2::moment_from_name(name.substr(dot + 1));
    if (moment) return *moment;
    return fail(ErrorCode::not_found, "there is no moment '{}': it is {}",
                printable(name.substr(dot + 1, longest_shown)), level2::moment_names(", ", " or "));
}

Result<MapProduct> map_product_named(std::string_view name) {
    const std::size_t dot = name.find('.');
    const auto product = render::product_from_name(name.substr(0, dot));
    if (!product || !is_of_grids(render::facts_of(*product))) {
        return fail(ErrorCode::not_found,
                    "there is no map '{}': the maps are {}, and a moment follows as in "
                    "composite.VEL",
                    printable(name.substr(0, longest_shown)), names_of_products());
    }
    const auto only = render::facts_of(*product).only_moment;
    MapProduct layer{*product, only.value_or(level2::Moment::ref)};
    if (render::facts_of(*product).is_sum) {
        const auto hours = dot == name.npos ? std::nullopt : hours_in(name.substr(dot + 1));
        if (!hours)
            return fail(ErrorCode::not_found, "a rain total has 1 to {} hours, as in {}.3h",
                        RainTotals::most_hours, render::product_name(*product));
        layer.hours = *hours;
        return layer;
    }
    if (dot == std::string_view::npos) return layer;
    const auto moment = moment_in_layer(name);
    if (!moment) return pass_on(moment);
    layer.moment = *moment;
    if (only && layer.moment != *only) {
        return fail(ErrorCode::not_found, "{} is a map of {} alone", render::product_name(*product),
                    level2::moment_name(*only));
    }
    return layer;
}

std::vector<MapProduct> map_products_of(const std::vector<level2::Moment>& moments) {
    std::vector<MapProduct> layers;
    for (const render::ProductFacts& facts : render::all_products()) {
        if (!is_of_grids(facts)) continue;
        const auto is_listed = [&](level2::Moment moment) {
            return std::ranges::find(moments, moment) != moments.end();
        };
        const bool has_rain = is_listed(level2::Moment::ref) || is_listed(level2::Moment::rate);
        if (facts.is_sum) {
            for (const int hours : usual_hours)
                if (has_rain) layers.push_back({facts.product, level2::Moment::rate, hours});
            continue;
        }
        for (const level2::Moment moment : moments) {
            if (facts.only_moment.value_or(moment) != moment) continue;
            if (level2::facts_of(moment).is_categorical) continue;  // drawn as a ppi alone
            layers.push_back({facts.product, moment});
        }
    }
    return layers;
}

std::string title_of(const MapProduct& layer, const render::Scene& scene) {
    std::string title = render::product_title(scene);
    if (layer.hours > 0)
        title += fmt::format(", {} {}", layer.hours, layer.hours == 1 ? "hour" : "hours");
    return title;
}

std::string title_of(const MapProduct& layer) {
    render::Scene scene;
    scene.product = layer.product;
    scene.moment = layer.moment;
    return title_of(layer, scene);
}

bool is_of_layers(const render::PictureOption& option) {
    return is_of_bare_maps(option) && &option != &render::moment_option() &&
           option.used_by.only != render::Product::ppi;
}

Result<MapStyle> map_style(const MapProduct& layer, const Fields& query,
                           std::span<const std::string_view> others) {
    auto read = picture_query(query, is_of_layers, others);
    if (!read) return pass_on(read);
    render::SceneOptions& options = read->options;
    options.product = render::product_name(layer.product);
    options.moment = level2::moment_name(layer.moment);
    if (options.smooth.empty()) options.smooth = "none";
    auto scene = render::scene_of(options);
    if (!scene) return pass_on(scene);
    if (Status fits = render::check_stored_derivation(options, layer.product); !fits)
        return pass_on(fits);
    return MapStyle{layer, std::move(*scene), fmt::format("{}\n{}", layer.name(), read->key), {}};
}

}  // namespace stormcellar::web
