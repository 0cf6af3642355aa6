#include "cli/grid/surface_options.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/number_list.h"
#include "render/color/built_in_tables.h"
#include "stormcellar/level2/moment.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {
namespace {

constexpr const char* usual_surfaces = "30,45,60";  // of reflectivity

Status check_taken(const SurfaceOptions& options, const grid_export::GridFormat& format) {
    if (format.has_surfaces || (options.values.empty() && !options.exaggeration)) return {};
    return fail(ErrorCode::bad_argument, "{} is for files with surfaces (.glb), not for {}",
                options.values.empty() ? "--exaggeration" : "--surfaces", format.name);
}

Result<std::vector<double>> parse_values(const std::string& text) {
    auto values = parse_numbers(text, ',');
    if (!values || values->size() > grid_export::most_surfaces) {
        return fail(ErrorCode::bad_argument, "--surfaces takes 1 to {} numbers, as in {}, not '{}'",
                    grid_export::most_surfaces, usual_surfaces, text);
    }
    std::ranges::sort(*values, [](double a, double b) {
        return std::pair(std::abs(a), a) < std::pair(std::abs(b), b);
    });
    values->erase(std::unique(values->begin(), values->end()), values->end());
    return std::move(*values);
}

}  // namespace

void add_surface_options(CLI::App& app, SurfaceOptions& options) {
    app.add_option(
        "--surfaces", options.values,
        fmt::format("Values of the surfaces in a glTF file, in the moment's unit, separated by "
                    "commas. Default for REF: {}",
                    usual_surfaces));
    app.add_option("--exaggeration", options.exaggeration,
                   "Factor that stretches the heights of surfaces. Default: 1")
        ->check(CLI::Range(render::limits::exaggeration.least, render::limits::exaggeration.most));
}

Result<grid_export::GridFormatOptions> parse_surfaces(const SurfaceOptions& options,
                                                      const grid_export::GridFormat& format,
                                                      std::span<const level2::Moment> moments) {
    grid_export::GridFormatOptions parsed;
    if (Status taken = check_taken(options, format); !taken) return pass_on(taken);
    if (!format.has_surfaces) return parsed;
    if (moments.size() != 1)
        return fail(ErrorCode::bad_argument, "{} has the surfaces of one --moment, not of {}",
                    format.name, moments.size());
    const level2::Moment moment = moments.front();
    if (options.values.empty() && moment != level2::Moment::ref)
        return fail(ErrorCode::bad_argument,
                    "--surfaces: say at which values of {} there are surfaces",
                    level2::moment_name(moment));
    const auto values = parse_values(options.values.empty() ? usual_surfaces : options.values);
    if (!values) return pass_on(values);
    for (const double value : *values) {
        grid_export::GridSurface surface{.value = value};
        const auto color = color_of(render::default_color_table(moment), static_cast<float>(value));
        if (color) surface.color = {(*color)[0], (*color)[1], (*color)[2]};
        parsed.surfaces.push_back(surface);
    }
    parsed.height_scale = options.exaggeration.value_or(1);
    return parsed;
}

}  // namespace stormcellar::cli
