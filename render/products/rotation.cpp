#include "render/products/rotation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <unordered_map>
#include <vector>

namespace stormcellar::render {
namespace {

using grid::brick_edge;

constexpr grid::Quantization share_codes{1, -1, 0.01F, false};

struct ColumnCell {
    int x = 0, y = 0, z = 0;
    int sense = 0;  // 1: counterclockwise, -1: clockwise
};

class CellBox {
  public:
    explicit CellBox(const grid::GridSpec& spec) : nx_(spec.nx), ny_(spec.ny), nz_(spec.nz()) {}

    [[nodiscard]] std::size_t index(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(ny_) +
                static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(nx_) +
               static_cast<std::size_t>(x);
    }
    // Calls `act` for the cell and its neighbors up to a distance along each axis.
    template <class Act>
    void around(const ColumnCell& cell, int reach, const Act& act) const {
        for (int z = std::max(0, cell.z - reach); z <= std::min(nz_ - 1, cell.z + reach); ++z)
            for (int y = std::max(0, cell.y - reach); y <= std::min(ny_ - 1, cell.y + reach); ++y)
                for (int x = std::max(0, cell.x - reach); x <= std::min(nx_ - 1, cell.x + reach);
                     ++x)
                    act(x, y, z);
    }

  private:
    int nx_, ny_, nz_;
};

using CellsByIndex = std::unordered_map<std::size_t, ColumnCell>;

void add_strong_cells(const grid::BrickView& shear, const CellBox& box, int bx, int by, int bz,
                      CellsByIndex& strong) {
    const grid::BrickExtent extent = grid::brick_extent(*shear.spec, bx, by, bz);
    for (int k = 0; k < extent.z; ++k) {
        for (int j = 0; j < extent.y; ++j) {
            for (int i = 0; i < extent.x; ++i) {
                const int x = bx * brick_edge + i;
                const int y = by * brick_edge + j;
                const int z = bz * brick_edge + k;
                if (shear.status(x, y, z) != grid::CellStatus::value) continue;
                const float value = shear.value(x, y, z);
                if (std::abs(value) < least_rotation) continue;
                strong.emplace(box.index(x, y, z), ColumnCell{x, y, z, value > 0 ? 1 : -1});
            }
        }
    }
}

CellsByIndex strong_cells(const grid::BrickView& shear, const CellBox& box) {
    CellsByIndex strong;
    for (int bx = 0; bx < shear.bricks_x; ++bx) {
        for (int by = 0; by < shear.bricks_y; ++by) {
            for (int bz = 0; bz < shear.bricks_z; ++bz) {
                const grid::BrickEntry& entry = shear.bricks[shear.brick_index(bx, by, bz)];
                if (entry.kind != grid::BrickKind::stored) continue;
                const float least = shear.quantization.value_of(entry.min_code);
                const float largest = shear.quantization.value_of(entry.max_code);
                if (largest >= least_rotation || least <= -least_rotation)
                    add_strong_cells(shear, box, bx, by, bz, strong);
            }
        }
    }
    return strong;
}

// Takes the cells that are connected with a cell out of `strong`, and returns them.
std::vector<ColumnCell> take_connected(CellsByIndex& strong, const CellBox& box) {
    std::vector<ColumnCell> members = {strong.begin()->second};
    strong.erase(strong.begin());
    for (std::size_t next = 0; next < members.size(); ++next) {
        const ColumnCell member = members[next];
        box.around(member, 1, [&](int x, int y, int z) {
            const auto found = strong.find(box.index(x, y, z));
            if (found == strong.end() || found->second.sense != member.sense) return;
            members.push_back(found->second);
            strong.erase(found);
        });
    }
    return members;
}

// Returns the weight, along one axis, of a cell at this distance from the middle of a neighborhood.
float weight_at(int distance) {
    constexpr std::array<float, 3> weights = {0.5F, 0.25F, 0};
    return weights[static_cast<std::size_t>(std::abs(distance))];
}

using BrickCodes = std::array<std::uint8_t, grid::brick_cells>;

// Collects the shares of cells, in bricks.
class Shares {
  public:
    explicit Shares(const grid::BrickView& like) : like_(like), box_(*like.spec) {}

    void add(const ColumnCell& cell) {
        box_.around(cell, 2, [&](int x, int y, int z) {
            const float weight =
                weight_at(x - cell.x) * weight_at(y - cell.y) * weight_at(z - cell.z);
            const auto brick = like_.brick_index(x / brick_edge, y / brick_edge, z / brick_edge);
            const int place =
                (x % brick_edge * brick_edge + y % brick_edge) * brick_edge + z % brick_edge;
            bricks_[brick][place] += static_cast<float>(cell.sense) * weight;
        });
    }

    [[nodiscard]] grid::BrickGrid written() const {
        grid::BrickGrid made(*like_.spec, share_codes);
        std::array writers = {grid::BricksWriter(made)};
        for (const auto& [brick, shares] : bricks_) {
            BrickCodes codes{};
            for (const auto& [place, share] : shares) {
                const float bounded = std::clamp(share, -1.0F, 1.0F);
                codes[static_cast<std::size_t>(place)] = static_cast<std::uint8_t>(
                    grid::first_value_code +
                    std::lround((bounded - share_codes.first_value) / share_codes.step));
            }
            const auto across = static_cast<std::size_t>(like_.bricks_z);
            const auto down = static_cast<std::size_t>(like_.bricks_y);
            writers[0].put_codes(
                brick, codes.data(),
                grid::brick_extent(*like_.spec, static_cast<int>(brick / across / down),
                                   static_cast<int>(brick / across % down),
                                   static_cast<int>(brick % across)));
        }
        made.finish(writers);
        return made;
    }

  private:
    const grid::BrickView& like_;
    CellBox box_;
    std::map<std::size_t, std::unordered_map<int, float>> bricks_;  // in rising order
};

}  // namespace

grid::BrickGrid rotation_columns(const grid::BrickView& shear) {
    const CellBox box(*shear.spec);
    CellsByIndex strong = strong_cells(shear, box);
    Shares shares(shear);
    while (!strong.empty()) {
        const auto members = take_connected(strong, box);
        const auto [low, high] = std::ranges::minmax(members, {}, &ColumnCell::z);
        const double depth_m = shear.spec->levels_m[static_cast<std::size_t>(high.z)] -
                               shear.spec->levels_m[static_cast<std::size_t>(low.z)];
        if (depth_m < least_column_m) continue;
        for (const ColumnCell& member : members)
            shares.add(member);
    }
    return shares.written();
}

ColorTable rotation_colors() {
    constexpr double dense = 0.2;  // for each kilometer
    constexpr float edge = 0.03F;
    ColorTable table;
    table.name = "columns-of-rotation";
    table.moment = level2::Moment::azsh;
    table.stops = {{-1, anticyclonic_color, anticyclonic_color},
                   {0, cyclonic_color, cyclonic_color}};
    table.end = 1;
    table.extinction = {{-1, dense},       {-column_share - edge, dense}, {-column_share, 0},
                        {column_share, 0}, {column_share + edge, dense},  {1, dense}};
    return table;
}

}  // namespace stormcellar::render
