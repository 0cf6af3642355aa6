#include "stormcellar/grid/grid_spec.h"

#include <cmath>

#include "base/degree.h"
#include "base/floating_point.h"
#include "base/name_list.h"
#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::grid {
namespace {

static_assert(is_in_order(projection_facts, &ProjectionFacts::projection));

constexpr std::uint64_t largest_cell_count = std::uint64_t{1} << 30;  // 5 GiB in memory
constexpr double lowest_level_m = -1000;
constexpr double highest_level_m = 60000;
constexpr double largest_spacing_m = 1e6;
constexpr double largest_spacing_deg = 10;

Status validate_levels(const GridSpec& spec) {
    if (spec.levels_m.empty() || spec.nz() > GridSpec::greatest_level_count) {
        return fail(ErrorCode::bad_argument, "a grid must have 1 to {} levels, not {}",
                    GridSpec::greatest_level_count, spec.levels_m.size());
    }
    double previous_m = -HUGE_VAL;
    for (const double level_m : spec.levels_m) {
        if (!is_within(level_m, lowest_level_m, highest_level_m)) {
            return fail(ErrorCode::bad_argument,
                        "levels must be {} to {} m above mean sea level, not {}", lowest_level_m,
                        highest_level_m, level_m);
        }
        if (!(level_m > previous_m)) {
            return fail(ErrorCode::bad_argument, "levels must rise: {} m follows {} m", level_m,
                        previous_m);
        }
        previous_m = level_m;
    }
    return {};
}

// Checks the spacing. Fields that the projection does not use must be 0, so that specs of equal
// grids are equal.
Status validate_spacing(const GridSpec& spec) {
    const bool in_degrees = spec.in_degrees();
    const double spacing = in_degrees ? spec.spacing_deg : spec.spacing_m;
    const double largest = in_degrees ? largest_spacing_deg : largest_spacing_m;
    if (!is_within(spacing, 0.0, largest) || spacing == 0) {
        return fail(ErrorCode::bad_argument,
                    "the spacing must be above 0 and at most {} {}, not {}", largest,
                    in_degrees ? "degrees" : "m", spacing);
    }
    if ((in_degrees ? spec.spacing_m : spec.spacing_deg) != 0) {
        return fail(ErrorCode::bad_argument, "a grid of projection {} has no spacing in {}",
                    projection_name(spec.projection), in_degrees ? "meters" : "degrees");
    }
    const bool no_parallels = spec.parallels_deg == std::array<double, 2>{};
    if (!facts_of(spec.projection).takes_parallels && !no_parallels) {
        return fail(ErrorCode::bad_argument, "a grid of projection {} has no standard parallels",
                    projection_name(spec.projection));
    }
    return {};
}

// Returns true if an offset in cells is a multiple of one half, and a grid with this offset is
// within the largest possible grid about the center.
bool is_window_offset(double offset_cells, int cells) {
    constexpr double farthest = 0.5 * GridSpec::greatest_side;
    const double most = farthest - 0.5 * cells;
    return is_within(offset_cells, -most, most) &&
           2 * offset_cells == std::nearbyint(2 * offset_cells);
}

}  // namespace

std::optional<Projection> projection_from_name(std::string_view name) {
    return key_named(projection_facts, &ProjectionFacts::projection, name);
}

DegreeLength degree_length(double latitude_deg) noexcept {
    constexpr double e2 = wgs84_flattening * (2 - wgs84_flattening);
    const double sine = std::sin(latitude_deg * degree);
    const double w2 = 1 - e2 * sine * sine;
    const double prime_vertical_m = wgs84_semi_major_m / std::sqrt(w2);
    return {prime_vertical_m * std::cos(latitude_deg * degree) * degree,
            prime_vertical_m * (1 - e2) / w2 * degree};
}

double GridSpec::width_at_center_m() const {
    return degree_length(center_latitude_deg).east_m * spacing_deg;
}

double GridSpec::height_at_center_m() const {
    return degree_length(center_latitude_deg).north_m * spacing_deg;
}

GridSpec default_spec(double center_latitude_deg, double center_longitude_deg) {
    GridSpec spec;
    spec.center_latitude_deg = center_latitude_deg;
    spec.center_longitude_deg = center_longitude_deg;
    for (int level = 1; level <= 32; ++level)
        spec.levels_m.push_back(500.0 * level);
    return spec;
}

Status validate(const GridSpec& spec) {
    constexpr int most = GridSpec::greatest_side;
    const bool sides_fit = spec.nx >= 1 && spec.nx <= most && spec.ny >= 1 && spec.ny <= most;
    if (!sides_fit) {
        return fail(ErrorCode::bad_argument,
                    "a grid must have 1 to {} columns and rows, not {} x {}", most, spec.nx,
                    spec.ny);
    }
    if (!is_window_offset(spec.offset_x_cells, spec.nx) ||
        !is_window_offset(spec.offset_y_cells, spec.ny)) {
        return fail(ErrorCode::bad_argument,
                    "{} x {} columns cannot lie {}, {} cells off the center; offsets are halves, "
                    "within {} columns and rows around it",
                    spec.nx, spec.ny, spec.offset_x_cells, spec.offset_y_cells, most);
    }
    if (Status spacing = validate_spacing(spec); !spacing) return spacing;
    const bool on_earth = is_within(spec.center_latitude_deg, -90.0, 90.0) &&
                          is_within(spec.center_longitude_deg, -180.0, 180.0);
    if (!on_earth) {
        return fail(ErrorCode::bad_argument, "the center {}, {} is not on the earth",
                    spec.center_latitude_deg, spec.center_longitude_deg);
    }
    if (Status covered = validate_projection(spec); !covered) return covered;
    if (Status levels = validate_levels(spec); !levels) return levels;
    const auto cells = static_cast<std::uint64_t>(spec.nx) * static_cast<std::uint64_t>(spec.ny) *
                       static_cast<std::uint64_t>(spec.nz());
    if (cells > largest_cell_count) {
        return fail(ErrorCode::bad_argument, "{} x {} x {} are {} cells, more than {}", spec.nx,
                    spec.ny, spec.nz(), cells, largest_cell_count);
    }
    return {};
}

}  // namespace stormcellar::grid
