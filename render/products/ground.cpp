#include "render/products/ground.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "render/products/smooth_field.h"
#include "render/products/water_rows.h"
#include "stormcellar/render/color_table.h"

namespace stormcellar::render {
namespace {

// Finds the column whose cell holds a point.
class ColumnFinder {
  public:
    explicit ColumnFinder(const grid::GridSpec& spec)
        : nx_(spec.nx),
          ny_(spec.ny),
          cell_width_m_(spec.cell_width_m()),
          cell_height_m_(spec.cell_height_m()) {}

    // Returns the column that holds a point; -1 beyond the grid.
    [[nodiscard]] std::ptrdiff_t at(GroundPoint p) const {
        return holding(p.x_m / cell_width_m_ + 0.5 * nx_, p.y_m / cell_height_m_ + 0.5 * ny_);
    }

    // Do the work of at() in two steps: places_of() converts the points of a row to places counted
    // in columns, and holding() returns the column that holds such a place.
    void places_of(const GroundRow& row, std::vector<double>& x, std::vector<double>& y) const {
        x.resize(row.x_m.size());
        y.resize(row.y_m.size());
        for (std::size_t i = 0; i < x.size(); ++i)
            x[i] = row.x_m[i] / cell_width_m_ + 0.5 * nx_;
        for (std::size_t i = 0; i < y.size(); ++i)
            y[i] = row.y_m[i] / cell_height_m_ + 0.5 * ny_;
    }
    [[nodiscard]] std::ptrdiff_t holding(double x, double y) const {
        if (!(x >= 0 && x < nx_ && y >= 0 && y < ny_)) return -1;
        return static_cast<std::ptrdiff_t>(y) * nx_ + static_cast<std::ptrdiff_t>(x);
    }

  private:
    int nx_, ny_;
    double cell_width_m_, cell_height_m_;
};

// Returns true for the pixels of the dots that mark an "at least" value.
bool is_dot(int x, int y, double scale) {
    const int period = std::max(4, static_cast<int>(std::lround(6 * scale)));
    const int size = std::max(1, static_cast<int>(std::lround(2 * scale)));
    const int shift = (y / period) % 2 == 0 ? 0 : period / 2;
    return (x + shift) % period < size && y % period < size;
}

// If seen at a slant, the ground continues beyond the grid by this many half widths of the grid.
constexpr double slanted_reach = 1.5;
// If seen from straight above, the ground continues as far as maps reach.
constexpr double farthest_m = 2e6;

constexpr int band_rows = 8;

// Calls work(first row, end) for bands of rows of a picture.
template <class Work>
void for_each_band(const ViewGeometry& geometry, int threads, Work work) {
    const int height = geometry.height();
    for_each_piece((height + band_rows - 1) / band_rows, threads, [&](int band) {
        work(band * band_rows, std::min((band + 1) * band_rows, height));
    });
}

// Finds the column and the share of water under the pixels of a row. It makes all divisions of a
// row first, in loops that the compiler vectorizes.
class RowFinder {
  public:
    // `water` may be null.
    RowFinder(const grid::GridSpec& spec, const WaterRows* water) : columns_(spec), water_(water) {}

    void find(const GroundRow& row) {
        columns_.places_of(row, column_x_, column_y_);
        if (water_ != nullptr) water_->find(row, water_at_);
    }
    // Returns the column under a pixel; -1 beyond the grid and in the sky.
    [[nodiscard]] std::ptrdiff_t column(std::size_t x) const {
        return columns_.holding(column_x_[x], column_y_[x]);
    }
    // Returns the share of water under a pixel, which must not show the sky.
    [[nodiscard]] double water(std::size_t x) const {
        return water_ == nullptr ? 0 : water_at_.share[x];
    }

  private:
    ColumnFinder columns_;
    const WaterRows* water_;
    std::vector<double> column_x_, column_y_;
    WaterRow water_at_;
};

// Calls shade(column, patch) for every pixel over the grid.
template <class Shade>
Image paint(const grid::GridSpec& spec, const ViewGeometry& geometry, const GroundLook& look,
            int threads, Shade shade) {
    Image image(geometry.width(), geometry.height(), look.shades->page);
    std::optional<WaterRows> water;
    if (look.water != nullptr && !look.water->water.empty()) water.emplace(*look.water);
    for_each_band(geometry, threads, [&](int first_row, int end_row) {
        RowFinder finder(spec, water ? &*water : nullptr);
        GroundRow row;
        for (int y = first_row; y < end_row; ++y) {
            geometry.ground_of_row(y, row);
            finder.find(row);
            for (int x = 0; x < image.width; ++x) {
                const auto place = static_cast<std::size_t>(x);
                if (row.is_sky(place)) continue;
                const std::ptrdiff_t column = finder.column(place);
                if (column < 0 && look.water == nullptr) continue;
                const GroundPatch patch{
                    x, y, finder.water(place), {row.x_m[place], row.y_m[place]}};
                image.set(x, y,
                          column >= 0 ? shade(static_cast<std::size_t>(column), patch)
                                      : patch.shade(look, &GroundShades::beyond));
            }
        }
    });
    return image;
}

// Returns how far from the grid a point of the ground is; 0 on the grid.
double beyond_grid_m(const ViewGeometry& geometry, double x_m, double y_m) {
    const double aside_m = std::max(0.0, std::abs(x_m) - geometry.half_x_m());
    const double ahead_m = std::max(0.0, std::abs(y_m) - geometry.half_y_m());
    return std::sqrt(aside_m * aside_m + ahead_m * ahead_m);
}

}  // namespace

bool is_from_above(const ViewGeometry& geometry) {
    return !geometry.is_perspective() && geometry.forward()[2] == -1;
}

std::ptrdiff_t column_at(const grid::GridSpec& spec, GroundPoint p) {
    return ColumnFinder(spec).at(p);
}

Image paint_ground(const grid::GridSpec& spec, const std::vector<ColumnSummary>& columns,
                   const ViewGeometry& geometry, GroundTells tells, const GroundLook& look,
                   int threads) {
    return paint(spec, geometry, look, threads, [&](std::size_t column, const GroundPatch& patch) {
        const std::uint16_t lowest = columns[column].lowest_seen;
        if (lowest == ColumnSummary::never) return patch.unseen(look);
        const bool low = spec.levels_m[lowest] < low_coverage_m;
        return patch.shade(look, low || tells == GroundTells::whether_seen
                                     ? &GroundShades::seen
                                     : &GroundShades::seen_aloft);
    });
}

Rgba8 shade_of(const FlatField& field, std::size_t place, const ColorTable& table,
               const GroundPatch& patch, const GroundLook& look) {
    const bool at_least = !field.at_least.empty() && field.at_least[place] != 0;
    return shade_of(field.status[place], field.values[place], at_least, table, patch, look);
}

Rgba8 shade_of(grid::CellStatus status, float value, bool at_least, const ColorTable& table,
               const GroundPatch& patch, const GroundLook& look) {
    const Rgba8 plain = patch.shade(look, &GroundShades::seen);
    switch (status) {
        case grid::CellStatus::value: {
            const auto color = color_of(table, value);
            if (!color) return plain;
            return at_least && is_dot(patch.x, patch.y, look.scale) ? look.shades->page
                                                                    : over(*color, plain);
        }
        case grid::CellStatus::range_folded:
            return over(table.range_folded, plain);
        case grid::CellStatus::ambiguous:
            return hatched(plain, table.range_folded, patch.x, patch.y, look.scale);
        case grid::CellStatus::no_echo:
            return plain;
        case grid::CellStatus::not_seen:
            break;
    }
    return patch.unseen(look);
}

Image paint_field(const grid::GridSpec& spec, const FlatField& field, const ColorTable& table,
                  const ViewGeometry& geometry, const GroundLook& look, int threads,
                  bool smoothed) {
    if (!smoothed) {
        return paint(spec, geometry, look, threads,
                     [&](std::size_t column, const GroundPatch& patch) {
                         return shade_of(field, column, table, patch, look);
                     });
    }
    const SmoothField smooth(field);
    return paint(spec, geometry, look, threads, [&](std::size_t column, const GroundPatch& patch) {
        const auto place = smooth.at(patch.point.x_m / spec.cell_width_m() + 0.5 * (spec.nx - 1),
                                     patch.point.y_m / spec.cell_height_m() + 0.5 * (spec.ny - 1));
        const bool at_least = !field.at_least.empty() && field.at_least[column] != 0;
        return shade_of(place.status, place.value, at_least, table, patch, look);
    });
}

double reach_beyond_m(const ViewGeometry& geometry) {
    if (is_from_above(geometry)) return farthest_m;
    return slanted_reach * std::max(geometry.half_x_m(), geometry.half_y_m());
}

void fade_beyond(const ViewGeometry& geometry, const Shades& shades, int threads, Image& picture) {
    if (is_from_above(geometry)) return;
    const double reach_m = reach_beyond_m(geometry);
    for_each_band(geometry, threads, [&](int first_row, int end_row) {
        GroundRow row;
        for (int y = first_row; y < end_row; ++y) {
            geometry.ground_of_row(y, row);
            for (int x = 0; x < picture.width; ++x) {
                const auto place = static_cast<std::size_t>(x);
                if (row.is_sky(place)) continue;
                const double beyond_m = beyond_grid_m(geometry, row.x_m[place], row.y_m[place]);
                if (beyond_m == 0) continue;
                const double share = std::min(1.0, beyond_m / reach_m);
                picture.set(x, y, mixed(picture.at(x, y), shades.page, share * (2 - share)));
            }
        }
    });
}

Image paint_pixels(const grid::GridSpec& spec, const FlatField& field, const ColorTable& table,
                   const ViewGeometry& geometry, const GroundLook& look, int threads) {
    return paint(spec, geometry, look, threads,
                 [&](std::size_t /*column*/, const GroundPatch& patch) {
                     return shade_of(field, field.index(patch.x, patch.y), table, patch, look);
                 });
}

}  // namespace stormcellar::render
