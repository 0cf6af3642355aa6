#include "web/data/pictures/picture_query.h"

#include <algorithm>
#include <variant>
#include <vector>

#include <fmt/ranges.h>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "render/options/option_text.h"

namespace stormcellar::web {
namespace {

constexpr std::size_t longest_value = 256;

bool names_file(const render::PictureOption& row, const std::string& text) {
    const auto* value = std::get_if<render::TextValue>(&row.value);
    return value != nullptr && value->is_file != nullptr && value->is_file(text);
}

std::vector<std::string> parameters_of_options(TakesOption takes) {
    std::vector<std::string> names;
    for (const render::PictureOption& row : render::picture_options()) {
        if (takes(row)) names.emplace_back(parameter_of(row));
    }
    return names;
}

const render::PictureOption* option_named(std::string_view name, TakesOption takes) {
    for (const render::PictureOption& row : render::picture_options()) {
        if (takes(row) && parameter_of(row) == name) return &row;
    }
    return nullptr;
}

Status take_parameter(const render::PictureOption& row, const std::string& name,
                      const std::string& text, render::SceneOptions& options) {
    if (contains(options.typed, row))
        return fail(ErrorCode::bad_argument, "{} is given more than once", name);
    if (text.size() > longest_value)
        return fail(ErrorCode::bad_argument, "{} is longer than {} bytes", name, longest_value);
    // The server reads no file that a client names.
    if (&row == &render::overlay_option() && text != render::overlay_cells)
        return fail(ErrorCode::bad_argument, "{} is {} here", name, render::overlay_cells);
    if (names_file(row, text))
        return fail(ErrorCode::bad_argument, "{}: a table is named here, not a file", name);
    const render::PictureSettings to{options, options.scene, nullptr};
    Status taken =
        std::visit([&](const auto& value) { return take_text(value, name, text, to); }, row.value);
    if (taken) options.typed.push_back(&row);
    return taken;
}

}  // namespace

bool is_of_frames(const render::PictureOption& option) {
    return !option.is_of_loop() && !option.section.empty();
}

bool is_of_bare_maps(const render::PictureOption& option) {
    const bool is_of_page = &option == &render::width_option() ||
                            &option == &render::height_option() || option.key == "theme" ||
                            option.key == "product" || &option == &render::overlay_option();
    return option.section == "picture" && !is_of_page && is_of_frames(option) &&
           !(option.used_by.only && !render::is_map(*option.used_by.only));
}

Result<PictureQuery> picture_query(const Fields& query, TakesOption takes,
                                   std::span<const std::string_view> others) {
    PictureQuery read;
    read.options.spelling = render::Spelling::parameter;
    std::vector<std::string> asked;
    for (const auto& [name, text] : query) {
        if (std::ranges::find(others, name) != others.end()) continue;
        const render::PictureOption* row = option_named(name, takes);
        if (row == nullptr) {
            std::vector<std::string> known = parameters_of_options(takes);
            known.insert(known.end(), others.begin(), others.end());
            return fail(ErrorCode::bad_argument, "there is no parameter '{}'{}",
                        printable(name.substr(0, longest_value)),
                        did_you_mean(name.substr(0, longest_value), known));
        }
        if (Status taken = take_parameter(*row, name, text, read.options); !taken)
            return pass_on(taken);
        asked.push_back(fmt::format("{}={}", name, text));
    }
    std::ranges::sort(asked);
    // A line feed can separate the parameters, because the server refuses control characters in
    // them.
    read.key = fmt::format("{}", fmt::join(asked, "\n"));
    return read;
}

std::string parameters_for_help(TakesOption takes) {
    return fmt::format("{}", fmt::join(parameters_of_options(takes), ", "));
}

}  // namespace stormcellar::web
