#include "render/options/panel_scenes.h"

#include <algorithm>
#include <utility>

#include "base/printable.h"
#include "base/split.h"
#include "stormcellar/render/panels.h"

namespace stormcellar::render {

Result<std::vector<level2::Moment>> moments_of_panels(const std::string& list,
                                                      std::string_view name) {
    std::vector<level2::Moment> moments;
    for (const std::string_view word : split(list, ',')) {
        const auto moment = level2::moment_from_name(word);
        if (!moment) {
            return fail(ErrorCode::bad_argument, "{} must name moments ({}), not '{}'", name,
                        level2::moment_names(", ", " or "), printable(word));
        }
        if (std::ranges::find(moments, *moment) != moments.end())
            return fail(ErrorCode::bad_argument, "{} names {} twice", name, word);
        moments.push_back(*moment);
    }
    return moments;
}

Result<std::vector<PanelScene>> panel_scenes(
    const std::string& list, const SceneOptions& options,
    const std::function<Result<Scene>(const SceneOptions&)>& scene_of_panel) {
    const bool is_typed = options.spelling == Spelling::option;
    const auto moments = moments_of_panels(list, is_typed ? "--panels" : "panels");
    if (!moments) return pass_on(moments);
    for (const PictureOption* row : {&moment_option(), &colors_option()}) {
        if (contains(options.typed, *row)) {
            return fail(ErrorCode::bad_argument,
                        "{} is for a picture of one moment; each of the panels has its own",
                        is_typed ? row->option : parameter_of(*row));
        }
    }
    SceneOptions panel = options;
    panel.panels = list;  // an option that only one panel's moment uses is no mistake
    panel.colors.clear();
    const auto is_given = [&](const PictureOption& row) {
        return contains(options.typed, row) || contains(options.in_file, row);
    };
    if (!is_given(width_option()) && !is_given(height_option())) {
        panel.scene.width = panels_width;
        panel.scene.height = panels_height;
    }
    std::vector<PanelScene> panels;
    for (const level2::Moment moment : *moments) {
        panel.moment = level2::moment_name(moment);
        panel.scene.glyphs = options.scene.glyphs && has_beam_glyphs(moment);
        auto scene = scene_of_panel(panel);
        if (!scene) return pass_on(scene);
        panels.push_back({scene->moment, std::move(*scene)});
    }
    return panels;
}

}  // namespace stormcellar::render
