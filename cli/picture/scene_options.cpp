#include "cli/picture/scene_options.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <variant>

#include <CLI/CLI.hpp>

#include "base/floating_point.h"
#include "base/local_time.h"
#include "base/number_list.h"
#include "cli/shared/moment_option.h"
#include "render/colour/built_in_tables.h"
#include "render/colour/colour_file.h"

namespace stormcellar::cli {

namespace {

// The first problem is the one that is told.
void note(SceneOptions& options, std::string_view option, const Status& status) {
    if (status || options.problem) return;
    const Error& error = status.error();
    options.problem = Error{error.code, fmt::format("{}: {}", option, error.message)};
}

Status check_places(std::span<const NumberPlace> places, const std::vector<double>& numbers) {
    for (std::size_t i = 0; i < places.size(); ++i) {
        const NumberRange range = places[i].range;
        if (is_within(numbers[i], range.least, range.most)) continue;
        return fail(ErrorCode::bad_argument, "{} must be {} to {}, not {}", places[i].name,
                    range.least, range.most, numbers[i]);
    }
    return {};
}

// Puts one row on the command line, under a name and with a help text.
struct ValueAdder {
    CLI::App& app;
    std::string name;
    std::string help;
    PictureSettings to;

    CLI::Option* operator()(const FlagValue& value) const {
        return app.add_flag(name, *value.field(to), help);
    }

    CLI::Option* operator()(const WholeValue& value) const {
        int& field = *value.field(to);
        CLI::Option* option = app.add_option(name, field, help);
        // A default out of range stands for nothing given.
        if (is_within<double>(field, value.range.least, value.range.most)) {
            option->capture_default_str();
        }
        if (value.checked == Checked::by_the_parser) {
            option->check(CLI::Range(static_cast<int>(value.range.least),
                                     static_cast<int>(value.range.most)));
        }
        return option;
    }

    CLI::Option* operator()(const NumberValue& value) const {
        double* const field = value.field(to);
        const double unit = value.unit;
        CLI::Option* option = app.add_option_function<double>(
            name, [field, unit](const double& number) { *field = number * unit; }, help);
        // A default out of range stands for nothing given.
        const double usual = *field / unit;
        if (value.or_zero || is_within(usual, value.range.least, value.range.most)) {
            option->default_str(fmt::format("{}", usual));
        }
        if (value.checked == Checked::by_the_parser) {
            option->check(CLI::Range(value.range.least, value.range.most));
        }
        return option;
    }

    CLI::Option* operator()(const NumbersValue& value) const {
        const auto take = [&value, option = name, settings = to](const std::string& text) {
            const auto numbers = value.read != nullptr
                                     ? value.read(option, text)
                                     : numbers_of(option, text, value.places.size());
            if (!numbers) {
                if (!settings.options.problem) settings.options.problem = numbers.error();
                return;
            }
            note(settings.options, option, check_places(value.places, *numbers));
            value.set(settings, *numbers);
        };
        return app.add_option_function<std::string>(name, take, help);
    }

    CLI::Option* operator()(const TextValue& value) const {
        std::string* const field = value.field(to);
        const auto take = [&value, field, option = name, settings = to](const std::string& text) {
            *field = text;
            note(settings.options, option, value.check(text));
        };
        CLI::Option* option = app.add_option_function<std::string>(name, take, help);
        return option->default_str(*field);
    }

    CLI::Option* operator()(const NamesValue& value) const {
        const auto take = [&value, option = name, settings = to](const std::string& names) {
            note(settings.options, option, value.set(settings, names));
        };
        CLI::Option* option = app.add_option_function<std::string>(name, take, help);
        return option->default_str(value.get(to));
    }
};

CLI::Option* add_row(CLI::App& app, const PictureOption& row, std::string_view name,
                     PictureSettings to) {
    CLI::Option* option =
        std::visit(ValueAdder{app, std::string(name), help_of(row), to}, row.value);
    if (const std::string_view usual = default_of_the_view(row); !usual.empty())
        option->default_str(std::string(usual));
    const bool is_old = name != row.option;
    option->each([&options = to.options, &row, is_old](const std::string& /*text*/) {
        if (!contains(options.typed, row)) {
            options.typed.push_back(&row);
        } else if (is_old) {
            note(options, row.old_option,
                 fail(ErrorCode::bad_argument, "is the older name of {}; give only one of them",
                      row.option));
        }
    });
    return option;
}

void add_rows(CLI::App& app, PictureSettings to) {
    for (const PictureOption& row : picture_options()) {
        if (row.is_of_loop() != (to.loop != nullptr)) continue;
        CLI::Option* option = add_row(app, row, row.option, to);
        if (!row.is_of_loop()) option->group("Picture");
        if (row.old_option.empty()) continue;
        add_row(app, row, row.old_option, to)->group("");
    }
}

Status unused(std::string_view name, const PictureOption& row, render::Product product) {
    return fail(ErrorCode::bad_argument, "{} is for {}; {} does not use it", name,
                row.used_by.text(), render::product_name(product));
}

// bad_argument names the option, or the key of a file for this product, and who uses it.
Status check_uses(render::Product product, const SceneOptions& options) {
    const auto files = render::product_from_name(options.file_product);
    for (const PictureOption& row : picture_options()) {
        if (row.is_used_by(product)) continue;
        if (contains(options.typed, row)) return unused(row.option, row, product);
        const bool was_used = files && row.is_used_by(*files);
        if (!was_used && contains(options.in_file, row)) return unused(key_of(row), row, product);
    }
    return {};
}

// The number of a row that is out of its range; none: there is no such number.
struct OutOfRange {
    PictureSettings to;
    std::optional<std::string> operator()(const WholeValue& value) const {
        return said(value.range, *value.field(to), false);
    }
    std::optional<std::string> operator()(const NumberValue& value) const {
        NumberRange range = value.range;
        const double* const field = value.field(to);
        // Only a camera with a place of its own may look up.
        const bool looks_down = field == &to.scene.camera.tilt_deg && !to.scene.camera.eye;
        if (looks_down) range = render::limits::tilt_deg;
        return said(range, *field / value.unit, value.or_zero);
    }
    template <class Other>
    std::optional<std::string> operator()(const Other& /*value*/) const {
        return std::nullopt;
    }
    static std::optional<std::string> said(NumberRange range, double number, bool or_zero) {
        if (is_within(number, range.least, range.most)) return std::nullopt;
        if (or_zero && std::fpclassify(number) == FP_ZERO) return std::nullopt;
        return fmt::format("must be {} to {}{}, not {}", range.least, range.most,
                           or_zero ? ", or 0" : "", number);
    }
};

// bad_argument names the option, or the key if it is a scene file that has the number.
Status check_ranges(SceneOptions options) {
    const PictureSettings to{options, options.scene, nullptr};
    for (const PictureOption& row : picture_options()) {
        // A default out of range stands for nothing given.
        const bool is_given = contains(options.typed, row) || contains(options.in_file, row);
        if (row.is_of_loop() || !is_given) continue;
        const auto said = std::visit(OutOfRange{to}, row.value);
        if (!said) continue;
        const bool is_in_file = !contains(options.typed, row) && contains(options.in_file, row);
        return fail(ErrorCode::bad_argument, "{} {}",
                    is_in_file ? key_of(row) : std::string(row.option), *said);
    }
    return {};
}

}  // namespace

void add_scene_options(CLI::App& app, SceneOptions& options) {
    add_rows(app, {options, options.scene, nullptr});
}

void add_loop_settings(CLI::App& app, SceneOptions& options, LoopSettings& loop) {
    add_rows(app, {options, options.scene, &loop});
}

Result<render::Scene> scene_of(const SceneOptions& options) {
    if (options.problem) return tl::unexpected(*options.problem);
    const auto product = render::product_from_name(options.product);
    if (!product) return pass_on(product);
    if (auto used = check_uses(*product, options); !used) return pass_on(used);
    if (auto ranges = check_ranges(options); !ranges) return pass_on(ranges);
    render::Scene scene = options.scene;
    scene.product = *product;
    const auto moment = moment_named(options.moment);
    if (!moment) return fail(ErrorCode::bad_argument, "the moment {}", moment.error().message);
    scene.moment = *moment;
    const auto theme = render::theme_from_name(options.theme);
    if (!theme) return pass_on(theme);
    scene.theme = *theme;
    if (scene.product == render::Product::section && !scene.section) {
        return fail(ErrorCode::bad_argument,
                    "a section needs its two ends; give {} LAT,LON,LAT,LON or two names of places, "
                    "or {} in a scene file",
                    section_option().option, key_of(section_option()));
    }
    if (scene.elevation_deg != render::Scene::lowest_sweep &&
        scene.sweep_number != render::Scene::no_number) {
        return fail(ErrorCode::bad_argument,
                    "a sweep is named by its elevation or by its number; give only one of them");
    }
    // A picture that says nothing of colors has those without classes; a scene file has the
    // defaults that it was written for.
    const bool has_own_colours = render::facts_of(scene.product).colours != nullptr;
    if (options.colours.empty() && options.file_product.empty() && !has_own_colours) {
        scene.colours = render::smooth_colour_table(scene.moment);
    } else if (const auto* table = render::table_of_family(options.colours, scene.moment)) {
        scene.colours = *table;
    } else if (!options.colours.empty()) {
        auto colours = render::colours_from(options.colours);
        if (!colours) return pass_on(colours);
        scene.colours = std::move(*colours);
    }
    scene.smooth =
        options.smooth.empty() ? options.file_product.empty() : options.smooth == "cubic";
    // A camera with a place of its own looks in perspective.
    if (scene.camera.eye && scene.camera.field_of_view_deg == 0) {
        scene.camera.field_of_view_deg = 60;
    }
    scene.labels = !options.no_labels;
    if (auto valid = render::validate(scene); !valid) return pass_on(valid);
    return scene;
}

Result<std::vector<double>> numbers_of(const std::string& option, const std::string& text,
                                       std::size_t count) {
    auto numbers = parse_numbers(text, ',');
    if (numbers && numbers->size() == count) return std::move(*numbers);
    return fail(ErrorCode::bad_argument, "{} needs {} numbers separated by commas, not '{}'",
                option, count, text);
}

int thread_count(const SceneOptions& options) {
    if (options.threads > 0) return options.threads;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

render::FrameFacts facts_of(const std::string& domain, const cache::GridDescription& description,
                            const std::string& time_zone, UtcTime now) {
    render::FrameFacts facts{domain, description.moment, description.time, description.sites,
                             description.provenance.partial};
    facts.radar_troubles = description.provenance.radar_troubles;
    const std::string zone = time_zone.empty() ? machine_time_zone() : time_zone;
    const auto local = zone.empty() ? std::string{} : format_local(facts.time, zone).value_or("");
    if (!local.ends_with(" UTC")) facts.local_time = local;
    const auto age = std::chrono::floor<std::chrono::seconds>(now - description.end_time);
    if (age >= std::chrono::seconds(0) && age < std::chrono::hours(1)) {
        facts.antenna_to_picture = age;
    }
    return facts;
}

}  // namespace stormcellar::cli
