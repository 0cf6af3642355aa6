#include "cli/picture/scene_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>

#include "base/floating_point.h"
#include "base/local_time.h"
#include "base/toml_file.h"
#include "cli/picture/product_options.h"
#include "cli/shared/commands.h"
#include "render/colour/colour_file.h"
#include "render/plan/volume_plan.h"
#include "stormcellar/accuracy/budget.h"
#include "stormcellar/accuracy/chain.h"
#include "stormcellar/accuracy/effect.h"
#include "stormcellar/cache/grid_name.h"

namespace stormcellar::cli {
namespace {

constexpr std::array sections{"picture", "camera", "light", "volume", "labels", "plan", "loop"};

struct NamedPlace {
    const char* name;
    TomlRange range;
};

// Reads exactly as many numbers as there are names, each within its range.
std::optional<std::vector<double>> read_numbers(TomlTable& table, std::string_view key,
                                                const std::vector<NamedPlace>& places) {
    auto numbers = table.numbers(key);
    if (!numbers) return std::nullopt;
    std::vector<std::string> names;
    names.reserve(places.size());
    for (const NamedPlace& place : places)
        names.emplace_back(place.name);
    if (numbers->size() != places.size()) {
        table.complain(key, fmt::format("must be [{}]", fmt::join(names, ", ")));
        return std::nullopt;
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto& [least, most] = places[i].range;
        if (is_within((*numbers)[i], least, most)) continue;
        table.complain(key, fmt::format("the {} {} is out of range, must be {} to {}", names[i],
                                        (*numbers)[i], least, most));
        return std::nullopt;
    }
    return numbers;
}

// Reads a list in the form of the option.
void read_list(TomlTable& table, std::string_view key, const std::vector<NamedPlace>& places,
               std::string& text) {
    if (const auto numbers = read_numbers(table, key, places)) {
        text = fmt::format("{}", fmt::join(*numbers, ","));
    }
}

void read_number(TomlTable& table, std::string_view key, TomlRange range, double& value) {
    if (const auto number = table.number(key, range)) value = *number;
}

void read_whole(TomlTable& table, std::string_view key, TomlRange range, int& value) {
    if (const auto number = table.whole_number(key, range)) value = *number;
}

void read_flag(TomlTable& table, std::string_view key, bool& value) {
    if (const auto flag = table.flag(key)) value = *flag;
}

// Reads a text that is not empty and in which `problem` finds nothing wrong; else none, or the
// message of the error.
template <class Problem>
void read_text(TomlTable& table, std::string_view key, std::string& value, Problem problem) {
    const auto text = table.text(key);
    if (!text) return;
    if (text->empty()) return table.complain(key, "must not be empty");
    const Status fine = problem(*text);
    if (!fine) return table.complain(key, fine.error().message);
    value = *text;
}

template <class T>
Status status_of(const Result<T>& result) {
    if (!result) return pass_on(result);
    return {};
}

std::string from_directory(const std::filesystem::path& directory, const std::string& path) {
    return (directory / path).native();
}

bool is_colour_file(const std::string& name) {
    std::string ending = std::filesystem::path(name).extension().native();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending == ".pal" || ending == ".toml";
}

void read_picture(TomlTable picture, const std::filesystem::path& directory,
                  SceneOptions& options) {
    note_keys(picture, "picture", options);
    read_text(picture, "product", options.product,
              [](const std::string& name) { return status_of(render::product_from_name(name)); });
    read_text(picture, "moment", options.moment, [](const std::string& name) -> Status {
        if (level2::moment_from_name(name)) return {};
        return fail(ErrorCode::bad_argument, "must be REF, VEL, SW, ZDR, PHI, RHO or CFP, is '{}'",
                    printable(name));
    });
    read_text(picture, "colours", options.colours, [&](const std::string& name) {
        return status_of(
            render::colours_from(is_colour_file(name) ? from_directory(directory, name) : name));
    });
    if (picture.has("colours") && is_colour_file(options.colours)) {
        options.colours = from_directory(directory, options.colours);
    }
    read_number(picture, "height_km", {-1, 60}, options.height_km);
    constexpr TomlRange latitudes{-90, 90};
    constexpr TomlRange longitudes{-180, 360};
    read_list(picture, "section",
              {{"latitude", latitudes},
               {"longitude", longitudes},
               {"latitude", latitudes},
               {"longitude", longitudes}},
              options.section);
    read_number(picture, "echo_top_dbz", {-30, 80}, options.scene.echo_top_dbz);
    read_whole(picture, "width", {16, 8192}, options.scene.width);
    read_whole(picture, "height", {16, 8192}, options.scene.height);
}

void read_camera(TomlTable camera, SceneOptions& options) {
    note_keys(camera, "camera", options);
    render::Camera& view = options.scene.camera;
    read_number(camera, "azimuth_deg", {-3600, 3600}, view.azimuth_deg);
    read_number(camera, "tilt_deg", {0, 180}, view.tilt_deg);
    read_number(camera, "zoom", {0.01, 1000}, view.zoom);
    if (const auto degrees = camera.number("field_of_view_deg", {0, 150})) {
        if (*degrees > 0 && *degrees < 1) {
            camera.complain("field_of_view_deg", "must be 0 (parallel rays) or 1 to 150");
        }
        view.field_of_view_deg = *degrees;
    }
    read_list(camera, "at_km", {{"east", {-1e4, 1e4}}, {"north", {-1e4, 1e4}}, {"up", {-1, 1e4}}},
              options.camera_at);
}

void read_light(TomlTable light, SceneOptions& options) {
    note_keys(light, "light", options);
    if (const auto kinds = light.texts("kinds")) {
        render::Light lit;
        const std::string names =
            kinds->empty() ? "none" : fmt::format("{}", fmt::join(*kinds, ","));
        const Status known = render::set_light(names, lit);
        if (!known) light.complain("kinds", known.error().message);
        options.light = names;
    }
    read_list(light, "sun_deg", {{"azimuth", {-3600, 3600}}, {"elevation", {5, 90}}}, options.sun);
}

void read_volume(TomlTable volume, SceneOptions& options) {
    note_keys(volume, "volume", options);
    render::Scene& scene = options.scene;
    read_whole(volume, "slices", {8, 4096}, scene.slices);
    read_number(volume, "exaggeration", {0.1, 100}, scene.vertical_exaggeration);
    read_number(volume, "opacity", {1e-3, 1e3}, scene.opacity);
    read_flag(volume, "curved_earth", scene.curved_earth);
    read_flag(volume, "haze", scene.haze);
}

void read_labels(TomlTable labels, SceneOptions& options) {
    note_keys(labels, "labels", options);
    if (const auto show = labels.flag("show")) options.no_labels = !*show;
    read_number(labels, "ring_spacing_km", {1, 1000}, options.range_ring_spacing_km);
    read_text(labels, "time_zone", options.time_zone, [](const std::string& zone) -> Status {
        if (format_local(UtcTime{}, zone)) return {};
        return fail(ErrorCode::bad_argument, "'{}' is no time zone known here", printable(zone));
    });
}

void read_plan(TomlTable plan, PicturePlanOptions& options) {
    read_text(plan, "tolerance", options.tolerance,
              [](const std::string& text) { return status_of(accuracy::parse_budget(text)); });
    TomlTable effects = plan.section("effects");
    const auto names = accuracy::effect_names(render::volume_chain());
    for (const std::string& name : names) {
        const auto state = effects.text(name);
        if (!state) continue;
        const std::string text = fmt::format("{}={}", name, *state);
        const auto known = accuracy::parse_override(text, names);
        if (!known) effects.complain(name, "must be \"on\", \"off\" or \"auto\"");
        options.effects.push_back(text);
    }
}

void read_loop(TomlTable table, const std::filesystem::path& directory, SceneOptions& options,
               LoopSettings& loop) {
    note_keys(table, "loop", options);
    read_text(table, "domain", loop.domain, [](const std::string& name) -> Status {
        if (cache::is_domain_name(name)) return {};
        return fail(ErrorCode::bad_argument, "'{}' is no domain's name", printable(name));
    });
    const auto is_time = [](const std::string& text) {
        return status_of(parse_utc(text, now_utc()));
    };
    read_text(table, "from", loop.range.from, is_time);
    read_text(table, "to", loop.range.to, is_time);
    if (const auto last = table.whole_number("last", {1, 1'000'000})) {
        loop.last = static_cast<std::size_t>(*last);
    }
    read_number(table, "fps", {0.1, 60}, loop.animation.frames_per_second);
    read_number(table, "dwell_s", {0, 60}, loop.animation.last_frame_dwell_s);
    read_number(table, "orbit_deg", {-3600, 3600}, loop.orbit_deg);
    read_flag(table, "ping_pong", loop.ping_pong);
    if (const auto outputs = table.texts("outputs")) {
        loop.outputs.clear();
        for (const std::string& output : *outputs) {
            loop.outputs.push_back(from_directory(directory, output));
            if (output.empty()) {
                table.complain("outputs", "must not be empty");
            } else if (auto fine = render::check_animation_name(loop.outputs.back()); !fine) {
                table.complain("outputs", fine.error().message);
            }
        }
    }
}

// Recognizes our other .toml files by a section that only they have.
Status check_kind(const TomlTable& root, const std::filesystem::path& file) {
    constexpr std::array<std::pair<const char*, const char*>, 3> others{
        std::pair{"radar", "a scene of simulated storms, for stormcellar synth"},
        {"point", "a colour table, for --colours"},
        {"paths", "a configuration of stormcellard"}};
    const bool is_ours = std::any_of(sections.begin(), sections.end(),
                                     [&](const char* name) { return root.has(name); });
    for (const auto& [section, kind] : others) {
        // the configuration has [[loop]] too
        if (!root.has(section) || (is_ours && section != std::string_view("paths"))) continue;
        return fail(ErrorCode::bad_argument, "{}: {}; a picture's scene has [{}]", file.native(),
                    kind, fmt::join(sections, "], ["));
    }
    return {};
}

void need_no_more(CLI::App& app, const char* option) {
    if (CLI::Option* found = app.get_option_no_throw(option)) found->required(false);
}

}  // namespace

Status read_scene_file(const std::filesystem::path& file, SceneOptions& scene,
                       PicturePlanOptions& plan, LoopSettings& loop) {
    auto toml = TomlFile::open(file);
    if (!toml) return pass_on(toml);
    TomlTable root = toml->root();
    if (auto kind = check_kind(root, file); !kind) return kind;
    SceneOptions new_scene = scene;
    PicturePlanOptions new_plan = plan;
    LoopSettings new_loop = loop;
    read_picture(root.section("picture"), file.parent_path(), new_scene);
    new_scene.file_product = new_scene.product;
    read_camera(root.section("camera"), new_scene);
    read_light(root.section("light"), new_scene);
    read_volume(root.section("volume"), new_scene);
    read_labels(root.section("labels"), new_scene);
    read_plan(root.section("plan"), new_plan);
    read_loop(root.section("loop"), file.parent_path(), new_scene, new_loop);
    if (auto fine = toml->finish(); !fine) return fine;
    scene = std::move(new_scene);
    plan = std::move(new_plan);
    loop = std::move(new_loop);
    return {};
}

Result<render::Scene> scene_with(const SceneFile& file, const SceneOptions& options) {
    auto scene = scene_of(options);
    if (scene || file.path.empty()) return scene;
    const Error& error = scene.error();
    if (file.alone && file.alone->message == error.message) {
        return fail(error.code, "{}: {}", file.path, error.message);
    }
    return fail(error.code, "{} (beside --scene {})", error.message, file.path);
}

void add_scene_file(CLI::App& app, SceneFile& file, SceneOptions& scene, PicturePlanOptions& plan,
                    LoopSettings* loop) {
    const auto read = [&app, &file, &scene, &plan, loop](const std::string& path) {
        file.path = path;
        LoopSettings unused;
        LoopSettings& settings = loop != nullptr ? *loop : unused;
        if (auto done = read_scene_file(path, scene, plan, settings); !done) {
            file.error = done.error();
        } else {
            plan.scene = ScenePlan{path, plan.tolerance, plan.effects, scene.product == "volume"};
            if (const auto alone = scene_of(scene); !alone) file.alone = alone.error();
        }
        // An error in the file comes before anything that the file might have set.
        if (file.error || (loop != nullptr && !loop->domain.empty())) need_no_more(app, "--domain");
        if (file.error || (loop != nullptr && !loop->outputs.empty())) {
            need_no_more(app, "--output");
        }
    };
    app.add_option_function<std::string>(
           "--scene", read,
           "A .toml file that says what the picture is; options given beside it win")
        ->group("Picture");
}

}  // namespace stormcellar::cli
