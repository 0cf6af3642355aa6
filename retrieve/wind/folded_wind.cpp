#include "retrieve/wind/folded_wind.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/degree.h"
#include "stormcellar/grid/beam_geometry.h"

namespace stormcellar::retrieve {
namespace {

constexpr std::size_t sectors = 72;
constexpr int least_gates = 8;    // in a sector, of one sheet and layer
constexpr float most_gates = 30;  // largest weight of a sector, whose gates are alike

// Sums over the gates of one sheet in a sector and a layer, from which score() tests a wind.
struct SectorSum {
    float east = 0, north = 0;   // of the beam
    float cosine = 0, sine = 0;  // sums of the phase pi velocity / Nyquist
    float phase_per_mps = 0;
    float count = 0;
};
using LayerSums = std::array<std::vector<SectorSum>, FoldedWind::layers>;

// Looks up cos(2 pi x). The error of up to 0.025 is far below the scatter of velocities.
class CosineTable {
  public:
    CosineTable() {
        for (std::size_t i = 0; i < values_.size(); ++i)
            values_[i] =
                static_cast<float>(std::cos(2 * std::numbers::pi * static_cast<double>(i) / 256.0));
    }
    [[nodiscard]] float at(float turns) const {
        return values_[static_cast<std::uint8_t>(std::lrintf(turns * 256))];
    }

  private:
    std::array<float, 256> values_{};
};
const CosineTable& cosines() {
    static const CosineTable table;
    return table;
}

std::size_t layer_of(double height_m) {
    return static_cast<std::size_t>(std::clamp(height_m / FoldedWind::layer_m, 0.0,
                                               static_cast<double>(FoldedWind::layers - 1)));
}

void add_sheet(const VelocitySheet& sheet, LayerSums& sums) {
    struct Cell {
        float cosine = 0, sine = 0;
        int count = 0;
    };
    std::vector<Cell> cells(FoldedWind::layers * sectors);
    const std::vector<float> heights = gate_heights_m(sheet);
    std::vector<std::size_t> first_cell;
    first_cell.reserve(heights.size());
    for (const float height : heights)
        first_cell.push_back(layer_of(static_cast<double>(height)) * sectors);
    for (int radial = 0; radial < sheet.radials; ++radial) {
        const float azimuth = sheet.azimuths_deg[static_cast<std::size_t>(radial)];
        const auto sector =
            std::min(sectors - 1, static_cast<std::size_t>(azimuth / 360 * sectors));
        const float* row = sheet.row(radial);
        for (int gate = 0; gate < sheet.gates; gate += 2) {
            if (std::isnan(row[gate])) continue;
            Cell& cell = cells[first_cell[static_cast<std::size_t>(gate)] + sector];
            cell.cosine += cosines().at(row[gate]);
            cell.sine += cosines().at(row[gate] - 0.25F);
            ++cell.count;
        }
    }
    const double level = std::cos(sheet.elevation_deg * degree);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const Cell& cell = cells[i];
        if (cell.count < least_gates) continue;
        const double azimuth = (static_cast<double>(i % sectors) + 0.5) / sectors * 360 * degree;
        const float weight = std::min(1.0F, most_gates / static_cast<float>(cell.count));
        sums[i / sectors].push_back({static_cast<float>(std::sin(azimuth) * level),
                                     static_cast<float>(std::cos(azimuth) * level),
                                     cell.cosine * weight, cell.sine * weight,
                                     static_cast<float>(1 / sheet.turn_mps),
                                     static_cast<float>(cell.count) * weight});
    }
}

float score(const std::vector<SectorSum>& sums, float u, float v) {
    float sum = 0;
    for (const SectorSum& sector : sums) {
        const float turns = (u * sector.east + v * sector.north) * sector.phase_per_mps;
        sum += sector.cosine * cosines().at(turns) + sector.sine * cosines().at(turns - 0.25F);
    }
    return sum;
}

// The candidate winds form a square of points.
constexpr int half = 15, side = 2 * half + 1;
constexpr float step_mps = 4;
constexpr int most_change = 2;       // of either component between layers, in steps
constexpr float change_penalty = 8;  // for a change by one step

struct Path {
    std::array<std::vector<float>, FoldedWind::layers> best;
    std::array<std::vector<int>, FoldedWind::layers> from;
};

// Adds to the score of each candidate the score of the best path to it from the layer below.
void extend(const std::vector<float>& below, std::vector<float>& best, std::vector<int>& from) {
    from.resize(best.size());
    for (int a = 0; a < side; ++a) {
        for (int b = 0; b < side; ++b) {
            float most = -std::numeric_limits<float>::max();
            int source = 0;
            for (int x = std::max(0, a - most_change); x <= std::min(side - 1, a + most_change);
                 ++x) {
                for (int y = std::max(0, b - most_change); y <= std::min(side - 1, b + most_change);
                     ++y) {
                    const auto change = static_cast<float>((a - x) * (a - x) + (b - y) * (b - y));
                    const float way =
                        below[static_cast<std::size_t>(x * side + y)] - change_penalty * change;
                    if (way > most) {
                        most = way;
                        source = x * side + y;
                    }
                }
            }
            best[static_cast<std::size_t>(a * side + b)] += most;
            from[static_cast<std::size_t>(a * side + b)] = source;
        }
    }
}

// Searches around a candidate with steps of 1 m/s.
FoldedWind::Layer refine(const std::vector<SectorSum>& sums, int candidate) {
    const auto u = static_cast<float>(candidate / side - half) * step_mps;
    const auto v = static_cast<float>(candidate % side - half) * step_mps;
    FoldedWind::Layer layer{static_cast<double>(u), static_cast<double>(v), 0};
    if (sums.empty()) return layer;
    float total = 0, best = 0;
    for (const SectorSum& sector : sums)
        total += sector.count;
    for (float du = -3; du <= 3; ++du) {
        for (float dv = -3; dv <= 3; ++dv) {
            const float here = score(sums, u + du, v + dv);
            if (here <= best) continue;
            best = here;
            layer = {static_cast<double>(u + du), static_cast<double>(v + dv),
                     static_cast<double>(here / total)};
        }
    }
    return layer;
}

}  // namespace

const FoldedWind::Layer& FoldedWind::at(double height_m) const {
    return by_height[layer_of(height_m)];
}

std::vector<float> gate_heights_m(const VelocitySheet& sheet) {
    const grid::BeamGeometry beam(40, 0);
    std::vector<float> heights;
    heights.reserve(static_cast<std::size_t>(sheet.gates));
    for (int gate = 0; gate < sheet.gates; ++gate) {
        const double range = sheet.first_gate_m + gate * sheet.gate_spacing_m;
        heights.push_back(static_cast<float>(beam.forward({range, sheet.elevation_deg}).height_m));
    }
    return heights;
}

FoldedWind fit_folded_wind(std::span<const VelocitySheet> sheets) {
    LayerSums sums;
    for (const VelocitySheet& sheet : sheets)
        add_sheet(sheet, sums);
    Path path;
    for (std::size_t layer = 0; layer < FoldedWind::layers; ++layer) {
        auto& best = path.best[layer];
        best.assign(side * side, 0);
        if (!sums[layer].empty()) {
            for (int i = 0; i < side * side; ++i)
                best[static_cast<std::size_t>(i)] =
                    score(sums[layer], static_cast<float>(i / side - half) * step_mps,
                          static_cast<float>(i % side - half) * step_mps);
        }
        if (layer > 0) extend(path.best[layer - 1], best, path.from[layer]);
    }
    FoldedWind wind;
    const auto& top = path.best.back();
    int candidate = static_cast<int>(std::ranges::max_element(top) - top.begin());
    for (std::size_t layer = FoldedWind::layers; layer-- > 0;) {
        wind.by_height[layer] = refine(sums[layer], candidate);
        if (layer > 0) candidate = path.from[layer][static_cast<std::size_t>(candidate)];
    }
    return wind;
}

}  // namespace stormcellar::retrieve
