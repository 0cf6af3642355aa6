#include "web/data/pictures/sweep_layer.h"

#include <utility>

#include "render/options/scene_options.h"
#include "stormcellar/render/product.h"

namespace stormcellar::web {
namespace {

constexpr render::Product ppi = render::Product::ppi;

}  // namespace

bool is_sweep_layer(std::string_view name) {
    return name.substr(0, name.find('.')) == render::product_name(ppi);
}

bool is_of_sweep_layers(const render::PictureOption& option) {
    return is_of_bare_maps(option) && (option.is_used_by(ppi) || option.used_by_moment) &&
           &option != &render::moment_option() && option.key != "smooth" && option.key != "glyphs";
}

Result<SweepLayer> sweep_layer(std::string_view name, const Fields& query) {
    const auto moment = moment_in_layer(name);
    if (!moment) return pass_on(moment);
    auto read = picture_query(query, is_of_sweep_layers, {});
    if (!read) return pass_on(read);
    SweepLayer layer;
    layer.frame.options = std::move(read->options);
    layer.frame.options.product = render::product_name(ppi);
    layer.frame.options.moment = level2::moment_name(*moment);
    layer.frame.options.smooth = "none";
    auto scene = render::scene_of(layer.frame.options);
    if (!scene) return pass_on(scene);
    layer.frame.panels = {{*moment, *scene}};
    layer.frame.key = fmt::format("layer {}\n{}", level2::moment_name(*moment), read->key);
    layer.map = {{ppi, *moment}, std::move(*scene), layer.frame.key, {}};
    return layer;
}

}  // namespace stormcellar::web
