#include "cli/picture/scene_arguments.h"

#include <functional>
#include <optional>
#include <string>
#include <variant>

#include <CLI/CLI.hpp>

#include "base/floating_point.h"

namespace stormcellar::cli {

namespace {

using render::Checked;
using render::FlagValue;
using render::NamesValue;
using render::NumbersValue;
using render::NumberValue;
using render::PictureSettings;
using render::TextValue;
using render::WholeValue;

// Keeps only the first problem, because only one is reported.
void note(SceneOptions& options, const Status& status) {
    if (!status && !options.problem) options.problem = status.error();
}

// Adds an option to the command line for a row of the table of options.
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
        // A default that is out of range means "not given", so help shows no default.
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
        // A default that is out of range means "not given", so help shows no default.
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
        return app.add_option_function<std::string>(name, taker(value), help);
    }

    CLI::Option* operator()(const TextValue& value) const {
        CLI::Option* option = app.add_option_function<std::string>(name, taker(value), help);
        return option->default_str(*value.field(to));
    }

    CLI::Option* operator()(const NamesValue& value) const {
        CLI::Option* option = app.add_option_function<std::string>(name, taker(value), help);
        return option->default_str(value.get(to));
    }

    // The lambda may keep a reference to `value`, because it is part of the static table.
    template <class Value>
    [[nodiscard]] std::function<void(const std::string&)> taker(const Value& value) const {
        return [&value, option = name, settings = to](const std::string& text) {
            note(settings.options, render::take_text(value, option, text, settings));
        };
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
            note(options,
                 fail(ErrorCode::bad_argument, "{}: is the older name of {}; give only one of them",
                      row.old_option, row.option));
        }
    });
    return option;
}

void add_rows(CLI::App& app, PictureSettings to) {
    for (const PictureOption& row : render::picture_options()) {
        if (row.is_of_loop() != (to.loop != nullptr)) continue;
        CLI::Option* option = add_row(app, row, row.option, to);
        if (!row.is_of_loop()) option->group("Picture");
        if (row.old_option.empty()) continue;
        add_row(app, row, row.old_option, to)->group("");
    }
}

}  // namespace

void add_scene_options(CLI::App& app, SceneOptions& options) {
    add_rows(app, {options, options.scene, nullptr});
}

void add_loop_settings(CLI::App& app, SceneOptions& options, LoopChoices& loop) {
    add_rows(app, {options, options.scene, &loop});
}

}  // namespace stormcellar::cli
