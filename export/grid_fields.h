// export/grid_fields.h -- the variables of a grid's cells and the facts about them, for every
// format that has named arrays and attributes; internal.
//
// The names, the attributes and the provenance are those of netCDF files
// (stormcellar/export/grid_netcdf.h).
//
// Threads   Pure functions.
// Errors    See check_grids(). The other functions expect grids that passed it.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "export/cf_attributes.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::netcdf {

// Checks that the arrays of each grid fit its spec, and that one file can hold the grids, which it
// can if they have the same coordinates. Errors: bad_argument.
[[nodiscard]] Status check_grids(std::span<const grid::Grid> grids);

// A variable on the cells of a grid. The grid must outlive it.
struct GridField {
    enum class Kind { value, status, detail, site_count, site_weight };
    const grid::Grid* grid = nullptr;
    Kind kind = Kind::value;
    grid::Detail detail = grid::Detail::age;  // of kind `detail`
    std::string name = {};
    CfAttributes attributes = {};  // those that place the cells are added by the writer
    std::vector<signed char> flags = {};
    std::string flag_meanings = {};  // of the flags, separated by blanks

    // Returns true if cells may have no number.
    [[nodiscard]] bool has_fill() const { return kind == Kind::value || kind == Kind::detail; }
    // Returns the number of a cell, or `fill` if it has none.
    [[nodiscard]] float number(std::size_t cell, float fill) const {
        switch (kind) {
            case Kind::value:
                return grid->status[cell] == grid::CellStatus::value ? grid->values[cell] : fill;
            case Kind::status:
                return static_cast<float>(grid->status[cell]);
            case Kind::detail:
                return grid->details.at(detail, cell).value_or(fill);
            case Kind::site_count:
                return static_cast<float>(grid->site_counts[cell]);
            case Kind::site_weight:
                return grid->site_weights[cell];
        }
        return fill;
    }
};

// Returns the variables of all grids. If there are several grids, names of variables that belong to
// a moment begin with its name (REF_status).
[[nodiscard]] std::vector<GridField> fields_of(std::span<const grid::Grid> grids);

// Returns the attributes of the file: the facts that all grids share. Facts that may differ between
// moments are among them only if there is a single grid; otherwise the fields have these facts.
[[nodiscard]] CfAttributes provenance_attributes(std::span<const grid::Grid> grids);

// Returns the time of a grid in seconds since 1970, and the long_name of this time.
[[nodiscard]] double seconds_of(const grid::Grid& grid);
[[nodiscard]] std::string_view time_name(const grid::Grid& grid);

}  // namespace stormcellar::netcdf
