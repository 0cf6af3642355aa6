#include "retrieve/cells/cell_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "retrieve/cells/cell_columns.h"

namespace stormcellar::retrieve {
namespace {

// Sums over the grid cells of a group.
struct GroupSums {
    int first_x = 0, end_x = 0, first_y = 0, end_y = 0, lowest = 0, highest = 0;
    float max_dbz = 0;
    int max_level = 0;  // lowest of the cells with the maximum
    double mass = 0, x = 0, y = 0;
};

// Returns the area of a column of a row in km2.
double column_km2(const grid::GridSpec& spec, const grid::GridProjection& projection, int iy) {
    if (!spec.in_degrees()) return spec.spacing_m * spec.spacing_m * 1e-6;
    const auto length = grid::degree_length(projection.row_latitude_deg(iy));
    return spec.spacing_deg * spec.spacing_deg * length.east_m * length.north_m * 1e-6;
}

// Returns the content of liquid water of each level of reflectivity, up to a factor.
std::array<double, 256> liquid_of_levels(const StrongEcho& echo) {
    std::array<double, 256> liquid{};
    for (std::size_t level = 1; level < liquid.size(); ++level) {
        const auto dbz = static_cast<double>(echo.dbz_of(static_cast<std::uint8_t>(level)));
        liquid[level] = std::pow(10.0, dbz / 10 * 4 / 7);
    }
    return liquid;
}

std::vector<GroupSums> sum_groups(const grid::BrickView& view, const StrongEcho& echo,
                                  const FloodedEcho& flooded) {
    const std::array<double, 256> liquid = liquid_of_levels(echo);
    const std::vector<double> thickness_m = layer_thickness_m(view.spec->levels_m);
    std::vector<GroupSums> sums(static_cast<std::size_t>(flooded.groups));
    for (std::size_t i = 0; i < echo.cells().size(); ++i) {
        const StrongGridCell& cell = echo.cells()[i];
        GroupSums& sum = sums[static_cast<std::size_t>(flooded.group_of[i])];
        const int ix = cell.ix, iy = cell.iy, iz = cell.iz;
        if (sum.mass == 0) sum = {ix, ix + 1, iy, iy + 1, iz, iz, -100, iz};
        sum.first_x = std::min(sum.first_x, ix);
        sum.end_x = std::max(sum.end_x, ix + 1);
        sum.first_y = std::min(sum.first_y, iy);
        sum.end_y = std::max(sum.end_y, iy + 1);
        sum.lowest = std::min(sum.lowest, iz);
        sum.highest = std::max(sum.highest, iz);
        const float dbz = view.value(ix, iy, iz);
        if (dbz > sum.max_dbz || (dbz == sum.max_dbz && iz < sum.max_level)) {
            sum.max_dbz = dbz;
            sum.max_level = iz;
        }
        const double depth_m = thickness_m[static_cast<std::size_t>(iz)];
        const double mass = liquid[cell.level] * std::max(depth_m, 1.0);
        sum.mass += mass;
        sum.x += mass * ix;
        sum.y += mass * iy;
    }
    return sums;
}

bool is_deep(const GroupSums& sum, const std::vector<double>& thickness_m, double least_m) {
    if (thickness_m.size() < 2) return true;
    double depth_m = 0;
    for (int iz = sum.lowest; iz <= sum.highest; ++iz)
        depth_m += thickness_m[static_cast<std::size_t>(iz)];
    return depth_m >= least_m;
}

// Melting layers are rarely stronger.
constexpr float melting_layer_dbz = 50;

// Marks the groups that are less deep than the least depth. A group does not count as shallow if
// the group is stronger than melting layers and the air above most of its upper cells was not seen,
// because the group is probably deeper than it looks.
std::vector<std::uint8_t> shallow_groups(const grid::BrickView& view, const StrongEcho& echo,
                                         const FloodedEcho& flooded,
                                         const std::vector<GroupSums>& sums, double least_depth_m) {
    const std::vector<double> thickness_m = layer_thickness_m(view.spec->levels_m);
    std::vector<std::uint8_t> is_shallow(sums.size());
    for (std::size_t group = 0; group < sums.size(); ++group)
        is_shallow[group] = is_deep(sums[group], thickness_m, least_depth_m) ? 0 : 1;
    std::vector<int> open_less_closed(sums.size(), 0);
    for (std::size_t i = 0; i < echo.cells().size(); ++i) {
        const auto group = static_cast<std::size_t>(flooded.group_of[i]);
        const StrongGridCell& cell = echo.cells()[i];
        if (is_shallow[group] == 0 || echo.at(cell.ix, cell.iy, cell.iz + 1) >= 0) continue;
        const bool is_closed =
            cell.iz + 1 < view.spec->nz() && is_seen(view.status(cell.ix, cell.iy, cell.iz + 1));
        open_less_closed[group] += is_closed ? -1 : 1;
    }
    for (std::size_t group = 0; group < sums.size(); ++group)
        if (open_less_closed[group] > 0 && sums[group].max_dbz >= melting_layer_dbz)
            is_shallow[group] = 0;
    return is_shallow;
}

// A mask of the columns of a group.
struct ColumnMask {
    GroupSums within;
    std::vector<std::uint8_t> is_in;

    explicit ColumnMask(const GroupSums& sum)
        : within(sum),
          is_in(static_cast<std::size_t>(sum.end_x - sum.first_x) *
                static_cast<std::size_t>(sum.end_y - sum.first_y)) {}
    std::uint8_t& at(int ix, int iy) {
        return is_in[static_cast<std::size_t>(iy - within.first_y) *
                         static_cast<std::size_t>(within.end_x - within.first_x) +
                     static_cast<std::size_t>(ix - within.first_x)];
    }
    std::vector<ColumnRun> runs() {
        std::vector<ColumnRun> found;
        for (int iy = within.first_y; iy < within.end_y; ++iy) {
            for (int ix = within.first_x; ix < within.end_x; ++ix) {
                if (at(ix, iy) == 0) continue;
                const int first = ix;
                while (ix < within.end_x && at(ix, iy) != 0)
                    ++ix;
                found.push_back({iy, first, ix});
            }
        }
        return found;
    }
};

StormCell shaped_cell(const grid::GridSpec& spec, const grid::GridProjection& projection,
                      const GroupSums& sum, ColumnMask& mask) {
    StormCell cell;
    cell.position = projection.to_geo({sum.x / sum.mass, sum.y / sum.mass});
    cell.max_dbz = sum.max_dbz;
    cell.max_dbz_height_m =
        static_cast<float>(spec.levels_m[static_cast<std::size_t>(sum.max_level)]);
    cell.columns = mask.runs();
    for (const ColumnRun& run : cell.columns)
        cell.area_km2 += (run.end_x - run.first_x) * column_km2(spec, projection, run.iy);
    return cell;
}

}  // namespace

std::vector<StormCell> shape_cells(const grid::BrickView& view, const StrongEcho& echo,
                                   const FloodedEcho& flooded, const CellOptions& options) {
    const std::vector<GroupSums> sums = sum_groups(view, echo, flooded);
    const std::vector<std::uint8_t> is_shallow =
        shallow_groups(view, echo, flooded, sums, options.least_depth_m);
    std::vector<std::int32_t> mask_of(sums.size(), -1);
    std::vector<ColumnMask> masks;
    for (std::size_t group = 0; group < sums.size(); ++group) {
        if (sums[group].max_dbz < options.least_peak_dbz || is_shallow[group] != 0) continue;
        mask_of[group] = static_cast<std::int32_t>(masks.size());
        masks.emplace_back(sums[group]);
    }
    for (std::size_t i = 0; i < echo.cells().size(); ++i) {
        const std::int32_t mask = mask_of[static_cast<std::size_t>(flooded.group_of[i])];
        const StrongGridCell& cell = echo.cells()[i];
        if (mask >= 0) masks[static_cast<std::size_t>(mask)].at(cell.ix, cell.iy) = 1;
    }
    const grid::GridProjection projection(*view.spec);
    std::vector<StormCell> cells;
    for (ColumnMask& mask : masks) {
        StormCell cell = shaped_cell(*view.spec, projection, mask.within, mask);
        if (cell.area_km2 >= options.least_area_km2) cells.push_back(std::move(cell));
    }
    std::ranges::stable_sort(cells, std::ranges::greater{}, &StormCell::max_dbz);
    return cells;
}

}  // namespace stormcellar::retrieve
