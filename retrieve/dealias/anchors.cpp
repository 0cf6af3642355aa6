#include "retrieve/dealias/anchors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/degree.h"

namespace stormcellar::retrieve {
namespace {

// Finds the radial nearest to an azimuth.
class RadialsByAzimuth {
  public:
    explicit RadialsByAzimuth(const VelocitySheet& sheet) {
        nearest_.fill(-1);
        // A radial covers 0.8 degrees to each side, so radials one degree apart leave no gap.
        constexpr int reach = 8;
        for (int radial = 0; radial < sheet.radials; ++radial) {
            const int middle = slot(sheet.azimuths_deg[static_cast<std::size_t>(radial)]);
            for (int away = -reach; away <= reach; ++away) {
                auto& known = nearest_[static_cast<std::size_t>((middle + away + slots) % slots)];
                const bool is_nearer =
                    known < 0 || std::abs(away) <= distance_[known_at(middle, away)];
                if (!is_nearer) continue;
                known = radial;
                distance_[known_at(middle, away)] = std::abs(away);
            }
        }
    }
    // Returns -1 if no radial covers the azimuth.
    [[nodiscard]] int at(float azimuth_deg) const {
        return nearest_[static_cast<std::size_t>(slot(azimuth_deg))];
    }

  private:
    static constexpr int slots = 3600;
    static int slot(float azimuth_deg) {
        return std::clamp(static_cast<int>(azimuth_deg * 10), 0, slots - 1);
    }
    static std::size_t known_at(int middle, int away) {
        return static_cast<std::size_t>((middle + away + slots) % slots);
    }
    std::array<int, slots> nearest_{};
    std::array<int, slots> distance_{};
};

// The gate of another sheet above or below a gate, or -1, and the weight of its vote.
struct GateBeside {
    int gate = -1;
    float weight = 0;
};
std::vector<GateBeside> gates_beside(const SheetState& other, const SheetState& state,
                                     float weight) {
    const double ratio =
        std::cos(state.sheet.elevation_deg * degree) / std::cos(other.sheet.elevation_deg * degree);
    std::vector<GateBeside> gates(static_cast<std::size_t>(state.sheet.gates));
    for (std::size_t gate = 0; gate < gates.size(); ++gate) {
        const double range_m =
            state.sheet.first_gate_m + static_cast<double>(gate) * state.sheet.gate_spacing_m;
        const double there =
            (range_m * ratio - other.sheet.first_gate_m) / other.sheet.gate_spacing_m;
        if (!(there > -0.5 && there < other.sheet.gates - 0.5)) continue;
        const auto number = static_cast<std::size_t>(std::lrint(there));
        const float apart_m = std::abs(other.heights_m[number] - state.heights_m[gate]);
        gates[gate] = {static_cast<int>(number),
                       weight * std::exp(-apart_m / static_cast<float>(height_of_decay_m))};
    }
    return gates;
}

// Calls use(gate, turns, votes) for each gate of a radial that has a value: its velocity in turns
// as if the fold number of its node were 0, and the votes for that fold number.
template <class Use>
void for_each_gate(const SheetState& state, int radial, std::vector<Votes>& anchors, Use use) {
    const auto r = static_cast<std::size_t>(radial);
    const float* turns = state.sheet.row(radial);
    for (std::size_t q = state.regions.first_run[r]; q < state.regions.first_run[r + 1]; ++q) {
        const Run& run = state.regions.runs[q];
        const auto region = static_cast<std::size_t>(run.region);
        const auto shift = static_cast<float>(state.graph.fold_in_node[region]);
        Votes& votes = anchors[static_cast<std::size_t>(state.graph.node_of_region[region])];
        for (std::int32_t gate = run.begin; gate < run.end; ++gate)
            use(gate, turns[gate] + shift, votes);
    }
}

}  // namespace

void SheetState::fill_gate_folds() {
    gate_folds.assign(sheet.turns.size(), 0);
    for (const Run& run : regions.runs) {
        const auto begin =
            gate_folds.begin() + static_cast<std::ptrdiff_t>(sheet.at(run.radial, run.begin));
        std::fill_n(begin, run.end - run.begin,
                    static_cast<std::int8_t>(std::clamp(fold_of(run.region), -100, 100)));
    }
}

void anchor_to_wind(const FoldedWind& wind, const SheetState& state, std::vector<Votes>& anchors) {
    struct Component {
        float east, north, weight;
    };
    const VelocitySheet& sheet = state.sheet;
    const double per_turn = std::cos(sheet.elevation_deg * degree) / sheet.turn_mps;
    std::vector<Component> by_gate;
    for (const float height : state.heights_m) {
        const FoldedWind::Layer& layer = wind.at(static_cast<double>(height));
        by_gate.push_back({static_cast<float>(layer.u_mps * per_turn),
                           static_cast<float>(layer.v_mps * per_turn),
                           wind_weight * static_cast<float>(layer.agreement * layer.agreement)});
    }
    for (int radial = 0; radial < sheet.radials; ++radial) {
        const auto r = static_cast<std::size_t>(radial);
        const double azimuth = static_cast<double>(sheet.azimuths_deg[r]) * degree;
        const auto east = static_cast<float>(std::sin(azimuth));
        const auto north = static_cast<float>(std::cos(azimuth));
        for_each_gate(state, radial, anchors, [&](std::int32_t gate, float turns, Votes& votes) {
            const Component& of = by_gate[static_cast<std::size_t>(gate)];
            votes.add_real(of.east * east + of.north * north - turns, of.weight);
        });
    }
}

void anchor_to_sheet(const SheetState& other, const SheetState& state, std::vector<Votes>& anchors,
                     float weight) {
    const VelocitySheet& sheet = state.sheet;
    const RadialsByAzimuth radials(other.sheet);
    const std::vector<GateBeside> beside = gates_beside(other, state, weight);
    const auto ratio = static_cast<float>(other.sheet.turn_mps / sheet.turn_mps);
    for (int radial = 0; radial < sheet.radials; ++radial) {
        const auto r = static_cast<std::size_t>(radial);
        const int of = radials.at(sheet.azimuths_deg[r]);
        if (of < 0) continue;
        const float* turns_of = other.sheet.row(of);
        const std::int8_t* folds_of = other.gate_folds.data() + other.sheet.at(of, 0);
        for_each_gate(state, radial, anchors, [&](std::int32_t gate, float turns, Votes& votes) {
            const GateBeside& to = beside[static_cast<std::size_t>(gate)];
            if (to.gate < 0 || std::isnan(turns_of[to.gate])) return;
            const float turns_there = turns_of[to.gate] + static_cast<float>(folds_of[to.gate]);
            votes.add_real(turns_there * ratio - turns, to.weight);
        });
    }
}

}  // namespace stormcellar::retrieve
