// render/still/map_attributes.h -- describes a 2D product in the terms of CF: its variable's name
// and attributes, and the states of its columns.
//
// The attributes are long_name, units, standard_name and cell_methods where CF has them, and the
// numbers on which the product depends: its threshold, height or layer, the assumed heights of 0
// and -20 C, and the least probability of weather.
//
// Threads   Pure functions.
// Errors    None. The scene's product must be a map.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "export/cf_attributes.h"
#include "render/products/flat_field.h"
#include "stormcellar/render/frame_facts.h"
#include "stormcellar/render/scene.h"
#include "stormcellar/render/still.h"

namespace stormcellar::render {

// A state of a column: a state of cells, or a value that may be larger.
struct StateClass {
    std::uint8_t code = 0;
    std::string_view name = {};
    std::array<std::uint8_t, 3> color = {};
};
inline constexpr std::uint8_t at_least_code = 4;

// Returns the states that columns of a moment may have. Their codes count up from 0.
[[nodiscard]] std::span<const StateClass> state_classes(level2::Moment moment);
// Return the code of a column's state. `at_least`: the true value may be larger.
[[nodiscard]] std::uint8_t state_code(grid::CellStatus status, bool at_least);
[[nodiscard]] std::uint8_t state_of(const FlatField& field, std::size_t place);

// Returns the name of the product's variable, such as "vil_density".
[[nodiscard]] std::string map_variable(Product product);
// Returns the attributes of the product's variable. `units` of the scene do not change them.
[[nodiscard]] netcdf::CfAttributes map_attributes(const Scene& scene, const FrameFacts& facts);
// Returns the attributes of the file: the texts of `options`, and facts of the grid.
[[nodiscard]] netcdf::CfAttributes map_file_attributes(const StillMap& map,
                                                       const StillOptions& options);
// Returns the attributes of the variable of states, without the flags.
[[nodiscard]] netcdf::CfAttributes map_state_attributes(const Scene& scene);
// Returns the word for a state: its name with underscores.
[[nodiscard]] std::string state_word(const StateClass& state);
// Returns true if a column of the product may have the state.
[[nodiscard]] bool may_have(Product product, const StateClass& state);

}  // namespace stormcellar::render
