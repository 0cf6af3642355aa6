#include "capi/draw_options.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <variant>

#include <fmt/format.h>

#include "base/printable.h"
#include "capi/guarded.h"
#include "render/options/option_text.h"

namespace stormcellar::capi {
namespace {

// Sets one option from a text.
Status set_option(std::string_view name, const std::string& text, render::SceneOptions& options) {
    const auto rows = render::picture_options();
    const auto row = std::ranges::find_if(rows, [&](const render::PictureOption& one) {
        return !one.is_of_loop() && parameter_of(one) == name;
    });
    if (row == rows.end())
        return fail(ErrorCode::bad_argument, "pictures have no option '{}'", printable(name));
    if (contains(options.typed, *row))
        return fail(ErrorCode::bad_argument, "{} is given more than once", name);
    const render::PictureSettings to{options, options.scene, nullptr};
    Status taken =
        std::visit([&](const auto& value) { return take_text(value, std::string(name), text, to); },
                   row->value);
    if (taken) options.typed.push_back(&*row);
    return taken;
}

// Sets the options that are texts of the form NAME=VALUE.
Status set_texts(const stormcellar_draw_options& from, render::SceneOptions& options) {
    if (from.setting_count < 0 || (from.setting_count > 0 && from.settings == nullptr))
        return fail(ErrorCode::bad_argument, "setting_count is {}, and settings is {}",
                    from.setting_count, from.settings == nullptr ? "null" : "given");
    for (std::int32_t i = 0; i < from.setting_count; ++i) {
        if (from.settings[i] == nullptr) return is_null("a setting");
        const std::string_view setting = from.settings[i];
        const std::size_t equal = std::min(setting.find('='), setting.size());
        const std::string value(setting.substr(std::min(equal + 1, setting.size())));
        Status taken = set_option(setting.substr(0, equal), value, options);
        if (!taken) return taken;
    }
    return {};
}

}  // namespace

Result<render::SceneOptions> scene_options_of(const stormcellar_draw_options& from,
                                              std::optional<level2::Moment> own_moment) {
    render::SceneOptions options;
    options.spelling = render::Spelling::parameter;
    if (Status set = set_texts(from, options); !set) return pass_on(set);
    const auto set = [&](const render::PictureOption& row, const std::string& text) {
        return set_option(parameter_of(row), text, options);
    };
    Status done;
    if (from.product != nullptr) done = set_option("product", from.product, options);
    if (done && from.moment != nullptr) done = set(render::moment_option(), from.moment);
    if (done && from.width != 0) done = set(render::width_option(), std::to_string(from.width));
    if (done && from.height != 0) done = set(render::height_option(), std::to_string(from.height));
    if (!done) return pass_on(done);
    if (from.threads < 0) return fail(ErrorCode::bad_argument, "threads must be at least 0");
    if (from.threads > 0 || options.threads == 0) options.threads = std::max(1, from.threads);
    if (own_moment && !contains(options.typed, render::moment_option())) {
        Status own = set(render::moment_option(), std::string(level2::moment_name(*own_moment)));
        if (!own) return pass_on(own);
    }
    return options;
}

}  // namespace stormcellar::capi
