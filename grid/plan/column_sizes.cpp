#include "grid/plan/column_sizes.h"

#include <algorithm>
#include <cmath>

#include "base/degree.h"
#include "stormcellar/grid/tile.h"

namespace stormcellar::grid {
namespace {

// Other beam models bend the beam more or less, which moves a gate along the ground by at most this
// much.
constexpr float bent_by_m = 500;

std::vector<std::uint16_t> valued_cells(const Grid& base) {
    const std::size_t nz = base.spec.levels_m.size();
    std::vector<std::uint16_t> valued(base.spec.column_count());
    for (std::size_t column = 0; column < valued.size(); ++column) {
        const auto first = base.status.begin() + static_cast<std::ptrdiff_t>(column * nz);
        valued[column] = static_cast<std::uint16_t>(
            std::count(first, first + static_cast<std::ptrdiff_t>(nz), CellStatus::value));
    }
    return valued;
}

// Returns the greatest number of cells with a value in this column or one of the eight columns
// around it.
std::uint16_t most_beside(const std::vector<std::uint16_t>& valued, const GridSpec& spec, int ix,
                          int iy) {
    std::uint16_t most = 0;
    for (int y = std::max(0, iy - 1); y <= std::min(spec.ny - 1, iy + 1); ++y) {
        for (int x = std::max(0, ix - 1); x <= std::min(spec.nx - 1, ix + 1); ++x)
            most = std::max(most,
                            valued[static_cast<std::size_t>(y) * static_cast<std::size_t>(spec.nx) +
                                   static_cast<std::size_t>(x)]);
    }
    return most;
}

// Looks for gates with a value near columns where the default method found none.
class NearGates {
  public:
    NearGates(const GridSpec& spec, const SweepStack& stack)
        : spec_(spec),
          stack_(stack),
          half_cell_m_(static_cast<float>(std::hypot(spec.cell_width_m(), spec.cell_height_m())) /
                       2) {}

    // Selects the sweeps that may have a value around a tile. Leaves out a sweep whose samples
    // there are all no echo, or all not seen.
    void move_to(const Tile& tile) {
        busy_.clear();
        const auto table_end =
            static_cast<float>(static_cast<double>(stack_.table_size - 2) * ArcTable::step_m);
        if (!(tile.bounds.least_arc_m < table_end)) return;  // the tile is beyond every gate
        for (std::size_t i = 0; i < stack_.sweeps.size(); ++i) {
            const float azimuth_deg = reach_deg(i, tile.bounds.least_arc_m);
            const PolarBounds around = tile.bounds.widened(azimuth_deg, reach_m());
            if (!stack_.sweeps[i].uniform_status(around)) busy_.push_back(i);
        }
    }

    // Returns how many levels the gates near this column may fill; 0 if there are no such gates.
    [[nodiscard]] std::uint16_t levels_near(const ColumnPlace& at) const {
        float lowest_m = highest_beam_m;
        float highest_m = -highest_beam_m;
        for (const std::size_t i : busy_) {
            if (!has_value_near(i, at)) continue;
            const ArcPlace place = ArcTable::place_of(at.arc_m);
            const auto beam_of = [&](std::size_t sweep) {
                return stack_.sweeps[sweep].beam().heights(place);
            };
            const BeamHeights own = beam_of(i);
            const float beam_m = own.upper_m - own.lower_m;
            for (const std::size_t near :
                 {i == 0 ? i : i - 1, i, std::min(i + 1, stack_.sweeps.size() - 1)}) {
                const BeamHeights heights = beam_of(near);
                lowest_m = std::min(lowest_m, heights.lower_m - beam_m);
                highest_m = std::max(highest_m, heights.upper_m + beam_m);
            }
        }
        const auto& levels_m = spec_.levels_m;
        const auto within = std::count_if(levels_m.begin(), levels_m.end(), [&](double level_m) {
            return level_m >= static_cast<double>(lowest_m) &&
                   level_m <= static_cast<double>(highest_m);
        });
        return static_cast<std::uint16_t>(within);
    }

  private:
    [[nodiscard]] float reach_m() const { return half_cell_m_ + stack_.gate_spacing_m + bent_by_m; }
    // Returns the angle of half a cell plus one radial spacing, or plus one beam width if that is
    // wider.
    [[nodiscard]] float reach_deg(std::size_t sweep, float arc_m) const {
        const float cell_deg =
            arc_m > half_cell_m_
                ? static_cast<float>(std::asin(half_cell_m_ / arc_m) / static_cast<float>(degree))
                : 180;
        return std::min(179.0F, cell_deg + std::max(stack_.sweeps[sweep].azimuths().spacing_deg(),
                                                    stack_.beam_width_deg));
    }
    [[nodiscard]] bool has_value_near(std::size_t sweep, const ColumnPlace& at) const {
        const PolarSweep& polar = stack_.sweeps[sweep];
        const SweepGates& gates = polar.gates();
        const ArcPlace from = ArcTable::place_of(std::max(0.0F, at.arc_m - reach_m()));
        const ArcPlace to = ArcTable::place_of(std::min(
            at.arc_m + reach_m(),
            static_cast<float>(static_cast<double>(stack_.table_size - 2) * ArcTable::step_m)));
        bool found = false;
        polar.azimuths().visit_all(
            at.azimuth_deg, reach_deg(sweep, at.arc_m), [&](int position, float /*offset_deg*/) {
                if (found || gates.moment_of(position) == nullptr) return;
                const auto first = gates.gate_place(position, from);
                const auto last = gates.gate_place(position, to);
                const auto end = std::min(
                    first.end, static_cast<std::int32_t>(std::floor(last.number_and_half)) + 1);
                auto gate = std::max(first.first,
                                     static_cast<std::int32_t>(std::floor(first.number_and_half)));
                for (; gate < end && !found; ++gate)
                    found = gates.gate(position, gate).status == CellStatus::value;
            });
        return found;
    }

    const GridSpec& spec_;
    const SweepStack& stack_;
    float half_cell_m_;
    std::vector<std::size_t> busy_;
};

}  // namespace

std::vector<std::uint16_t> column_sizes(const Grid& base, const SweepStack& stack,
                                        const ColumnGeometry& geometry) {
    const GridSpec& spec = base.spec;
    const std::size_t nz = spec.levels_m.size();
    const std::vector<std::uint16_t> valued = valued_cells(base);
    std::vector<std::uint16_t> sizes(valued.size());
    const auto table_end =
        static_cast<float>(static_cast<double>(stack.table_size - 2) * ArcTable::step_m);
    NearGates gates(spec, stack);
    for (const Tile& tile : geometry.tiles()) {
        gates.move_to(tile);
        for (int iy = tile.first_y; iy < tile.end_y; ++iy) {
            for (int ix = tile.first_x; ix < tile.end_x; ++ix) {
                const std::size_t column =
                    static_cast<std::size_t>(iy) * static_cast<std::size_t>(spec.nx) +
                    static_cast<std::size_t>(ix);
                const ColumnPlace& at = geometry.row(iy)[static_cast<std::size_t>(ix)];
                const std::uint16_t most = most_beside(valued, spec, ix, iy);
                if (most > 0) {
                    sizes[column] =
                        static_cast<std::uint16_t>(std::min(nz, std::size_t{2} * most + 4));
                } else if (at.arc_m < table_end) {
                    sizes[column] = gates.levels_near(at);
                }
            }
        }
    }
    return sizes;
}

}  // namespace stormcellar::grid
