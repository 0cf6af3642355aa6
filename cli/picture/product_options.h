// cli/picture/product_options.h -- which options, and keys of a scene's file, apply to which
// product.
//
// An option that a product does not use is an error and is not ignored, because whoever gives it
// expects to see its effect. Only what a scene's file has for its own product is ignored if
// --product was typed.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/toml_file.h"
#include "cli/picture/scene_options.h"
#include "stormcellar/base/result.h"

namespace stormcellar::cli {

// Returns true if `name` is among the typed options, or the keys of a file.
[[nodiscard]] bool has_name(const std::vector<std::string>& names, std::string_view name);

// Fills SceneOptions::typed as options are parsed; covers the options that are on `app` now.
void note_typed_options(CLI::App& app, SceneOptions& options);

// Notes those keys of table `name` of a scene's file that not every product uses, by their names
// there: "[volume] slices".
void note_keys(const TomlTable& table, std::string_view name, SceneOptions& options);

// Errors: bad_argument, naming an option or key that this product does not use, and the products
// that do.
[[nodiscard]] Status check_product_options(render::Product product, const SceneOptions& options);

}  // namespace stormcellar::cli
