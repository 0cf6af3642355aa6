#include "grid/grid_spec.h"

#include <cmath>

namespace stormcellar::grid {
namespace {

constexpr int largest_side = 16384;
constexpr std::uint64_t largest_cell_count = std::uint64_t{1} << 30;  // 5 GiB in memory
constexpr int largest_level_count = 1024;
constexpr double lowest_level_m = -1000;
constexpr double highest_level_m = 60000;
constexpr double largest_spacing_m = 1e6;

Status validate_levels(const GridSpec& spec) {
    if (spec.levels_m.empty() || spec.nz() > largest_level_count) {
        return fail(ErrorCode::bad_argument, "a grid has 1 to {} levels, not {}",
                    largest_level_count, spec.levels_m.size());
    }
    double previous_m = -HUGE_VAL;
    for (const double level_m : spec.levels_m) {
        if (!(level_m >= lowest_level_m && level_m <= highest_level_m)) {
            return fail(ErrorCode::bad_argument,
                        "levels are {} to {} m above mean sea level, not {}", lowest_level_m,
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

}  // namespace

std::string_view projection_name(Projection projection) {
    switch (projection) {
        case Projection::azimuthal_equidistant:
            return "azimuthal_equidistant";
    }
    return "unknown";
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
    const bool sides_fit =
        spec.nx >= 1 && spec.nx <= largest_side && spec.ny >= 1 && spec.ny <= largest_side;
    if (!sides_fit) {
        return fail(ErrorCode::bad_argument, "a grid has 1 to {} columns and rows, not {} x {}",
                    largest_side, spec.nx, spec.ny);
    }
    if (!(spec.spacing_m > 0 && spec.spacing_m <= largest_spacing_m)) {
        return fail(ErrorCode::bad_argument, "the spacing must be above 0 and at most {} m, not {}",
                    largest_spacing_m, spec.spacing_m);
    }
    const bool on_earth =
        std::abs(spec.center_latitude_deg) <= 90 && std::abs(spec.center_longitude_deg) <= 180;
    if (!on_earth) {
        return fail(ErrorCode::bad_argument, "the centre {}, {} is not on the earth",
                    spec.center_latitude_deg, spec.center_longitude_deg);
    }
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
