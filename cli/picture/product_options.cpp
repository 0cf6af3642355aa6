#include "cli/picture/product_options.h"

#include <algorithm>
#include <array>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace stormcellar::cli {
namespace {

using render::Product;

// which products use an option
enum class Users { volume, all_but_section, cappi, section, echo_top };

struct Use {
    const char* option;
    const char* table;  // of a scene's file
    const char* key;
    Users users;
};
constexpr std::array<Use, 17> uses{{
    {"--height-km", "picture", "height_km", Users::cappi},
    {"--section", "picture", "section", Users::section},
    {"--echo-top-dbz", "picture", "echo_top_dbz", Users::echo_top},
    {"--azimuth", "camera", "azimuth_deg", Users::volume},
    {"--tilt", "camera", "tilt_deg", Users::volume},
    {"--zoom", "camera", "zoom", Users::all_but_section},
    {"--field-of-view", "camera", "field_of_view_deg", Users::volume},
    {"--camera-km", "camera", "at_km", Users::volume},
    {"--light", "light", "kinds", Users::volume},
    {"--sun", "light", "sun_deg", Users::volume},
    {"--haze", "volume", "haze", Users::volume},
    {"--curved-earth", "volume", "curved_earth", Users::volume},
    {"--slices", "volume", "slices", Users::volume},
    {"--exaggeration", "volume", "exaggeration", Users::volume},
    {"--opacity", "volume", "opacity", Users::volume},
    {"--ring-spacing-km", "labels", "ring_spacing_km", Users::all_but_section},
    {"--orbit", "loop", "orbit_deg", Users::volume},
}};

bool is_used(Users users, Product product) {
    switch (users) {
        case Users::volume:
            return product == Product::volume;
        case Users::all_but_section:
            return product != Product::section;
        case Users::cappi:
            return product == Product::cappi;
        case Users::section:
            return product == Product::section;
        case Users::echo_top:
            return product == Product::echo_top;
    }
    return true;
}

std::string_view text_of(Users users) {
    switch (users) {
        case Users::volume:
            return "volume";
        case Users::all_but_section:
            return "any product but section";
        case Users::cappi:
            return "cappi";
        case Users::section:
            return "section";
        case Users::echo_top:
            return "echotop";
    }
    return "";
}

std::string key_of(const Use& use) {
    return fmt::format("[{}] {}", use.table, use.key);
}

Status unused(const std::string& name, const Use& use, Product product) {
    return fail(ErrorCode::bad_argument, "{} is for {}: {} does not use it", name,
                text_of(use.users), render::product_name(product));
}

}  // namespace

bool has_name(const std::vector<std::string>& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

void note_typed_options(CLI::App& app, SceneOptions& options) {
    for (const Use& use : uses) {
        CLI::Option* option = app.get_option_no_throw(use.option);
        if (option == nullptr) continue;
        option->each([&options, &use](const std::string&) {
            if (!has_name(options.typed, use.option)) options.typed.emplace_back(use.option);
        });
    }
}

void note_keys(const TomlTable& table, std::string_view name, SceneOptions& options) {
    for (const Use& use : uses) {
        if (name == use.table && table.has(use.key)) options.in_file.push_back(key_of(use));
    }
}

Status check_product_options(Product product, const SceneOptions& options) {
    const auto files = render::product_from_name(options.file_product);
    for (const Use& use : uses) {
        if (is_used(use.users, product)) continue;
        if (has_name(options.typed, use.option)) return unused(use.option, use, product);
        const bool was_used = files && is_used(use.users, *files);
        if (!was_used && has_name(options.in_file, key_of(use))) {
            return unused(key_of(use), use, product);
        }
    }
    return {};
}

}  // namespace stormcellar::cli
