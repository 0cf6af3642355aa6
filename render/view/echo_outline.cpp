#include "render/view/echo_outline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stormcellar::render {
namespace {

constexpr int column_step = 2;  // of the columns that are read, along both axes
constexpr double top_dbz = 18;
constexpr double clear_air_20_dbz_km2 = 150, clear_air_30_dbz_km2 = 60;

}  // namespace

// Reads the columns of a view, brick by brick.
class EchoOutline::Reader {
  public:
    Reader(const grid::BrickView& view, level2::Moment moment) : view_(view) {
        const auto code_of = [&](double value) {
            const auto& q = view.quantization;
            const double code =
                grid::first_value_code +
                (value - static_cast<double>(q.first_value)) / static_cast<double>(q.step);
            return static_cast<int>(std::ceil(code));
        };
        for (std::size_t k = 0; k < thresholds_dbz.size(); ++k) {
            codes_[k] = moment == level2::Moment::ref ? code_of(thresholds_dbz[k])
                                                      : std::numeric_limits<int>::max();
        }
        top_code_ =
            moment == level2::Moment::ref ? code_of(top_dbz) : view.quantization.first_code();
    }
    void read(int bx, int by, std::vector<Tile>& tiles, int tiles_up) const {
        for (int x = bx * grid::brick_edge; x < (bx + 1) * grid::brick_edge; x += column_step) {
            if (x >= view_.spec->nx) break;
            for (int y = by * grid::brick_edge; y < (by + 1) * grid::brick_edge; y += column_step) {
                if (y >= view_.spec->ny) break;
                add_column(x, y,
                           tiles[static_cast<std::size_t>(x / tile_columns) *
                                     static_cast<std::size_t>(tiles_up) +
                                 static_cast<std::size_t>(y / tile_columns)]);
            }
        }
    }

  private:
    void add_column(int x, int y, Tile& tile) const {
        const std::size_t column = view_.offset_x(x) + view_.offset_y(y);
        int largest = 0, top = -1, highest = -1;
        for (int bz = 0; bz < view_.bricks_z; ++bz) {
            const auto& brick =
                view_.bricks[view_.brick_index(x / grid::brick_edge, y / grid::brick_edge, bz)];
            if (brick.kind != grid::BrickKind::stored || brick.value_count == 0) continue;
            const int end = std::min((bz + 1) * grid::brick_edge, view_.spec->nz());
            for (int z = bz * grid::brick_edge; z < end; ++z) {
                const int code = view_.code_at(column + view_.offset_z(z));
                largest = std::max(largest, code);
                if (code >= view_.quantization.first_code()) highest = z;
                if (code >= top_code_) top = z;
            }
        }
        if (largest < view_.quantization.first_code()) return;
        for (std::size_t k = 0; k < codes_.size(); ++k)
            tile.columns[k] += largest >= codes_[k] ? 1 : 0;
        ++tile.columns[all_columns];
        // If no cell reaches the usual threshold of tops, the highest cell counts as the top.
        const int level = top >= 0 ? top : highest;
        tile.top_m = std::max(
            tile.top_m, static_cast<float>(view_.spec->levels_m[static_cast<std::size_t>(level)]));
    }

    const grid::BrickView& view_;
    std::array<int, thresholds_dbz.size()> codes_{};
    int top_code_ = 0;
};

void EchoOutline::add(const grid::BrickView& view, level2::Moment moment) {
    if (tiles_.empty()) {
        spec_ = *view.spec;
        across_ = (spec_.nx + tile_columns - 1) / tile_columns;
        up_ = (spec_.ny + tile_columns - 1) / tile_columns;
        tiles_.resize(static_cast<std::size_t>(across_) * static_cast<std::size_t>(up_));
    }
    if (!(spec_ == *view.spec)) return;
    const Reader reader(view, moment);
    for (int bx = 0; bx < view.bricks_x; ++bx) {
        for (int by = 0; by < view.bricks_y; ++by)
            reader.read(bx, by, tiles_, up_);
    }
}

std::array<double, EchoOutline::all_columns + 1> EchoOutline::columns() const {
    std::array<double, all_columns + 1> sums{};
    for (const Tile& tile : tiles_) {
        for (std::size_t k = 0; k < sums.size(); ++k)
            sums[k] += tile.columns[k];
    }
    return sums;
}

double EchoOutline::west_m(int x) const {
    return (std::min(x * tile_columns, spec_.nx) - 0.5 * spec_.nx) * spec_.cell_width_m();
}

double EchoOutline::south_m(int y) const {
    return (std::min(y * tile_columns, spec_.ny) - 0.5 * spec_.ny) * spec_.cell_height_m();
}

double EchoOutline::column_km2() const {
    return column_step * column_step * spec_.cell_width_m() * spec_.cell_height_m() / 1e6;
}

bool is_clear_air(const EchoOutline& outline) {
    if (outline.empty()) return false;
    const auto columns = outline.columns();
    const auto km2 = [&](std::size_t k) { return columns[k] * outline.column_km2(); };
    constexpr std::size_t of_30_dbz = 2, of_20_dbz = 3;
    static_assert(EchoOutline::thresholds_dbz[of_30_dbz] == 30 &&
                  EchoOutline::thresholds_dbz[of_20_dbz] == 20);
    return columns[EchoOutline::all_columns] > 0 && km2(of_20_dbz) < clear_air_20_dbz_km2 &&
           km2(of_30_dbz) < clear_air_30_dbz_km2;
}

}  // namespace stormcellar::render
