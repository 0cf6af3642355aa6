// cli/picture/product_options.h -- which options and keys of a scene's file say something of which
// product.
//
// What a product does not use is an error and not dropped: who gives it expects to see it. Only
// what a scene's file says for its own product is left out beside a --product that was typed.
// Thread contract: pure functions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/toml_file.h"
#include "cli/picture/scene_options.h"
#include "stormcellar/base/result.h"

namespace stormcellar::cli {

// Whether `name` is among the options that were typed, or the keys of a file.
[[nodiscard]] bool has_name(const std::vector<std::string>& names, std::string_view name);

// Fills SceneOptions::typed as they are parsed; of the options that are on `app` by now.
void note_typed_options(CLI::App& app, SceneOptions& options);

// Notes those of a table `name` of a scene's file that not every product uses, as they are named
// there: "[volume] slices".
void note_keys(const TomlTable& table, std::string_view name, SceneOptions& options);

// bad_argument names the option, or the key of a file for this product, and who uses it.
[[nodiscard]] Status check_product_options(render::Product product, const SceneOptions& options);

}  // namespace stormcellar::cli
