#include "cli/picture/scene_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>

#include "base/floating_point.h"
#include "base/toml_file.h"
#include "cli/shared/commands.h"
#include "render/options/panel_scenes.h"
#include "render/options/picture_options.h"
#include "render/plan/volume_plan.h"
#include "stormcellar/accuracy/budget.h"
#include "stormcellar/accuracy/chain.h"
#include "stormcellar/accuracy/effect.h"
#include "stormcellar/cache/grid_name.h"

namespace stormcellar::cli {
namespace {

using render::FlagValue;
using render::NamesValue;
using render::NumberPlace;
using render::NumbersValue;
using render::NumberValue;
using render::PictureSettings;
using render::TextValue;
using render::WholeValue;

constexpr std::array sections{"picture", "camera", "light", "volume", "labels", "plan", "loop"};

template <class T>
Status status_of(const Result<T>& result) {
    if (!result) return pass_on(result);
    return {};
}

// A key of a scene file, and the object that the key's value changes.
struct Place {
    TomlTable& table;
    std::string_view key;
    const std::filesystem::path& directory;  // of the file
    PictureSettings to;

    void complain(std::string_view why) const { table.complain(key, why); }
};

// Reads a text. Sets nothing if the text is empty or `problem` finds an error in it, and then notes
// a complaint.
template <class Problem>
void read_text(TomlTable& table, std::string_view key, std::string& value, Problem problem) {
    const auto text = table.text(key);
    if (!text) return;
    if (text->empty()) return table.complain(key, "must not be empty");
    const Status fine = problem(*text);
    if (!fine) return table.complain(key, fine.error().message);
    value = *text;
}

void read_value(const FlagValue& value, const Place& at) {
    if (const auto flag = at.table.flag(at.key)) *value.field(at.to) = *flag != value.is_reversed;
}

void read_value(const WholeValue& value, const Place& at) {
    if (const auto number = at.table.whole_number(at.key, value.range)) {
        *value.field(at.to) = *number;
    }
}

void read_value(const NumberValue& value, const Place& at) {
    const auto [least, most] = value.range;
    const auto number = at.table.number(at.key, {value.or_zero ? 0 : least, most});
    if (!number) return;
    if (value.or_zero && *number > 0 && *number < least) {
        at.complain(fmt::format("must be 0 or {} to {}", least, most));
    }
    *value.field(at.to) = *number * value.unit;
}

// Reads exactly as many numbers as there are fields, each within its range.
void read_value(const NumbersValue& value, const Place& at) {
    const auto numbers = at.table.numbers(at.key);
    if (!numbers) return;
    if (numbers->size() != value.places.size()) {
        std::vector<std::string_view> names;
        for (const NumberPlace& place : value.places)
            names.push_back(place.name);
        return at.complain(fmt::format("must be [{}]", fmt::join(names, ", ")));
    }
    for (std::size_t i = 0; i < numbers->size(); ++i) {
        const auto& [name, range] = value.places[i];
        if (is_within((*numbers)[i], range.least, range.most)) continue;
        return at.complain(fmt::format("the {} {} is out of range, must be {} to {}", name,
                                       (*numbers)[i], range.least, range.most));
    }
    value.set(at.to, *numbers);
}

void read_value(const TextValue& value, const Place& at) {
    const auto full = [&](const std::string& text) {
        return value.beside == nullptr ? text : value.beside(at.directory, text);
    };
    std::string& field = *value.field(at.to);
    std::string text;
    read_text(at.table, at.key, text,
              [&](const std::string& given) { return value.check(full(given)); });
    if (!text.empty()) field = full(text);
}

void read_value(const NamesValue& value, const Place& at) {
    const auto names = at.table.texts(at.key);
    if (!names) return;
    const Status known =
        value.set(at.to, names->empty() ? "none" : fmt::format("{}", fmt::join(*names, ",")));
    if (!known) at.complain(known.error().message);
}

// The sections of a file. Each has one TomlTable, which remembers the keys that were read and so
// finds unknown keys.
class Sections {
  public:
    explicit Sections(TomlTable root) : root_(root) {}
    TomlTable& operator[](std::string_view name) {
        const auto found = tables_.find(name);
        if (found != tables_.end()) return found->second;
        return tables_.emplace(name, root_.section(name)).first->second;
    }

  private:
    TomlTable root_;
    std::map<std::string_view, TomlTable> tables_;
};

void read_row(const PictureOption& row, TomlTable& table, const std::filesystem::path& directory,
              PictureSettings to) {
    for (const std::string_view key : {row.key, row.old_key}) {
        if (key.empty() || !table.has(key)) continue;
        if (key == row.old_key && table.has(row.key)) {
            table.complain(key,
                           fmt::format("is the older name of {}; give only one of them", row.key));
        }
        to.options.in_file.push_back(&row);
        std::visit(
            [&](const auto& value) {
                read_value(value, {table, key, directory, to});
            },
            row.value);
    }
}

// Reads the moments of a picture with several panels. Each moment has its own colors.
void read_panels(TomlTable& picture, SceneOptions& scene) {
    const auto names = picture.texts("panels");
    if (!names) return;
    const std::string list = fmt::format("{}", fmt::join(*names, ","));
    if (const auto moments = render::moments_of_panels(list, "the list"); !moments)
        return picture.complain("panels", moments.error().message);
    for (const PictureOption* row : {&render::moment_option(), &render::colors_option()}) {
        if (render::contains(scene.in_file, *row)) {
            return picture.complain(
                "panels", fmt::format("each panel has a moment and colors of its own; leave out {}",
                                      row->key));
        }
    }
    scene.panels = list;
}

void read_plan(TomlTable& plan, PicturePlanOptions& options) {
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

// Reads into `key` the keys that [camera] has, too. Returns false if one of them is refused.
bool read_camera(TomlTable& table, const std::filesystem::path& directory, render::CameraKey& key) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    SceneOptions read;
    render::Camera& camera = read.scene.camera;
    camera.azimuth_deg = camera.tilt_deg = camera.zoom = camera.field_of_view_deg = none;
    for (const PictureOption& row : render::picture_options()) {
        if (row.section == "camera") read_row(row, table, directory, {read, read.scene, nullptr});
    }
    std::size_t taken = 0;
    const auto take = [&](double number, std::optional<double>& into) {
        if (std::isnan(number)) return;
        into = number;
        ++taken;
    };
    take(camera.azimuth_deg, key.azimuth_deg);
    take(camera.tilt_deg, key.tilt_deg);
    take(camera.zoom, key.zoom);
    take(camera.field_of_view_deg, key.field_of_view_deg);
    key.eye = camera.eye;
    key.look_at = camera.look_at;
    taken += (key.eye ? 1U : 0U) + (key.look_at ? 1U : 0U);
    return taken == read.in_file.size();
}

// Reads the camera's path from [[loop.camera]]. CameraPath finds invalid combinations.
void read_camera_keys(TomlTable& loop, const std::filesystem::path& directory,
                      const render::Camera& usual, std::vector<render::CameraKey>& keys) {
    constexpr NumberRange whole_turns{-100, 100}, day_s{0, 86'400};
    if (!loop.has("camera")) return;
    keys.clear();
    bool are_read = true;
    for (TomlTable& table : loop.tables("camera")) {
        render::CameraKey key;
        const auto time_s = table.number("time_s", day_s);
        if (!time_s && !table.has("time_s")) table.complain("time_s", "is missing");
        key.time_s = time_s.value_or(0);
        key.turns = table.whole_number("turns", whole_turns).value_or(0);
        are_read = read_camera(table, directory, key) && time_s && are_read;
        keys.push_back(key);
    }
    if (!are_read) return;
    if (const auto path = render::CameraPath::make(keys, usual); !path) {
        loop.complain("camera", path.error().message);
    }
}

// Reads the keys of [loop] that have no row in the table: the domain, the times, and the outputs.
void read_loop(TomlTable& table, const std::filesystem::path& directory, LoopSettings& loop) {
    read_text(table, "domain", loop.domain, [](const std::string& name) -> Status {
        if (cache::is_domain_name(name)) return {};
        return fail(ErrorCode::bad_argument, "'{}' is not the name of a domain", printable(name));
    });
    const auto is_time = [](const std::string& text) {
        return status_of(parse_utc(text, now_utc()));
    };
    read_text(table, "from", loop.range.from, is_time);
    read_text(table, "to", loop.range.to, is_time);
    const auto outputs = table.texts("outputs");
    if (!outputs) return;
    loop.outputs.clear();
    for (const std::string& output : *outputs) {
        loop.outputs.push_back((directory / output).native());
        if (output.empty()) {
            table.complain("outputs", "must not be empty");
        } else if (auto fine = render::check_animation_name(loop.outputs.back()); !fine) {
            table.complain("outputs", fine.error().message);
        }
    }
}

// Refuses other .toml files of the project. A section that only such a file has identifies it.
Status check_kind(const TomlTable& root, const std::filesystem::path& file) {
    constexpr std::array<std::pair<const char*, const char*>, 3> others{
        std::pair{"radar", "this is a simulated scene for stormcellar synth"},
        {"point", "this is a color table, which a scene can name"},
        {"paths", "this is a configuration of stormcellard"}};
    const bool is_ours = std::any_of(sections.begin(), sections.end(),
                                     [&](const char* name) { return root.has(name); });
    for (const auto& [section, kind] : others) {
        // A section of our own does not rule out a configuration, which may have [[loop]], too.
        if (!root.has(section) || (is_ours && section != std::string_view("paths"))) continue;
        return fail(ErrorCode::bad_argument, "{}: {}; a picture scene has [{}]", file.native(),
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
    Sections tables(root);
    const PictureSettings to{new_scene, new_scene.scene, &new_loop};
    for (const PictureOption& row : render::picture_options()) {
        if (!row.section.empty()) read_row(row, tables[row.section], file.parent_path(), to);
    }
    new_scene.file_product = new_scene.product;
    read_panels(tables["picture"], new_scene);
    read_plan(tables["plan"], new_plan);
    read_loop(tables["loop"], file.parent_path(), new_loop);
    read_camera_keys(tables["loop"], file.parent_path(), new_scene.scene.camera, new_loop.camera);
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
    return fail(error.code, "{} (together with --scene {})", error.message, file.path);
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
        // Report an error in the file before reporting a missing option, because the file might
        // have set that option.
        if (file.error || (loop != nullptr && !loop->domain.empty())) need_no_more(app, "--domain");
        if (file.error || (loop != nullptr && !loop->outputs.empty())) {
            need_no_more(app, "--output");
        }
    };
    app.add_option_function<std::string>(
           "--scene", read,
           "A .toml file that describes the picture; options on the command line override it")
        ->group("Picture");
}

}  // namespace stormcellar::cli
