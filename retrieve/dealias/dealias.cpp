#include "stormcellar/retrieve/dealias.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "base/degree.h"
#include "base/floating_point.h"
#include "retrieve/dealias/ambiguity.h"
#include "retrieve/dealias/anchors.h"
#include "retrieve/dealias/known_sheet.h"
#include "retrieve/dealias/linked_regions.h"
#include "retrieve/dealias/roughness.h"
#include "retrieve/dealias/shear_repair.h"

namespace stormcellar::retrieve {
namespace {

std::size_t at(std::int32_t index) {
    return static_cast<std::size_t>(index);
}

void make_graph(SheetState& state, float anchor_weight) {
    std::vector<float> bound;
    bound.reserve(state.regions.gate_count.size());
    for (const std::int32_t gates : state.regions.gate_count)
        bound.push_back(anchor_weight * static_cast<float>(gates));
    const auto regions = static_cast<std::int32_t>(state.regions.gate_count.size());
    state.graph = fold_graph(std::exchange(state.regions.edges, {}), regions, bound);
    state.folds = likely_folds(state.graph);
}

void find_graph(SheetState& state, float anchor_weight) {
    state.regions = find_regions(state.sheet);
    make_graph(state, anchor_weight);
}

// Splits the regions that may hold gates of two fold numbers, and makes a graph of the pieces.
// Returns false if there is no such region.
bool split_linked_regions(SheetState& state, float anchor_weight) {
    state.fill_gate_folds();
    const std::vector<std::uint8_t> is_split =
        linked_regions(state.sheet, state.regions, state.gate_folds);
    if (std::ranges::find(is_split, 1) == is_split.end()) return false;
    state.regions = split_regions(state.sheet, state.regions, is_split);
    make_graph(state, anchor_weight);
    return true;
}

// Shifts each component so that its mean fold number is nearest to 0. Without anchors, nothing else
// decides how often a component is folded.
void center_components(SheetState& state) {
    std::vector<double> sums(at(state.graph.components)), gates(sums.size());
    for (std::size_t region = 0; region < state.regions.gate_count.size(); ++region) {
        const auto component = at(state.graph.component[at(state.graph.node_of_region[region])]);
        const double count = state.regions.gate_count[region];
        sums[component] += count * state.fold_of(static_cast<std::int32_t>(region));
        gates[component] += count;
    }
    for (std::int32_t node = 0; node < state.graph.nodes; ++node) {
        const auto component = at(state.graph.component[at(node)]);
        state.folds[at(node)] -=
            static_cast<std::int32_t>(std::lrint(sums[component] / gates[component]));
    }
}

// Trusts the main echo of a sheet if it is one node, about which no edge votes. Like a component of
// several nodes, this node has the fold number that center_components() gave. Smaller echo on its
// own stays a guess, because it may be folded against the main echo.
void trust_main_echo(SheetState& state) {
    std::vector<std::int64_t> gates(at(state.graph.nodes));
    std::vector<int> nodes(at(state.graph.components));
    std::int64_t all = 0;
    for (std::size_t region = 0; region < state.regions.gate_count.size(); ++region) {
        gates[at(state.graph.node_of_region[region])] += state.regions.gate_count[region];
        all += state.regions.gate_count[region];
    }
    for (const std::int32_t component : state.graph.component)
        ++nodes[at(component)];
    for (std::size_t node = 0; node < gates.size(); ++node)
        if (2 * gates[node] > all && nodes[at(state.graph.component[node])] == 1)
            state.guessed[node] = 0;
}

void solve_alone(SheetState& state) {
    minimize_cost(state.graph, {}, state.folds);
    if (split_linked_regions(state, 0)) minimize_cost(state.graph, {}, state.folds);
    center_components(state);
    state.guessed = guessed_nodes(state.graph, {}, state.folds);
    trust_main_echo(state);
    state.fill_gate_folds();
    repair_shear(state.sheet, state.gate_folds);
}

// Returns the indices of the sheets by elevation. Sheets of equal elevation stay in the order of
// the volume.
std::vector<std::size_t> by_elevation(const std::vector<SheetState>& states) {
    std::vector<std::size_t> order(states.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {},
                             [&](std::size_t i) { return states[i].sheet.elevation_deg; });
    return order;
}

void solve_anchored(std::vector<SheetState>& states, std::span<const SheetState> known,
                    const FoldedWind& wind) {
    for (SheetState& state : states) {
        for (int i = 0; i < 2; ++i) {
            if (i > 0 && !split_linked_regions(state, most_anchor_weight)) break;
            state.outer_anchors.assign(at(state.graph.nodes), {});
            anchor_to_wind(wind, state, state.outer_anchors);
            anchor_to_known(known, state, state.outer_anchors);
            minimize_cost(state.graph, state.outer_anchors, state.folds);
        }
        state.fill_gate_folds();
    }
    // Go downward first, because the sweeps above have fewer folds, and then upward.
    std::vector<std::size_t> order = by_elevation(states);
    for (const bool is_downward : {true, false}) {
        for (std::size_t i = 0; i < order.size(); ++i) {
            const std::size_t place = is_downward ? order.size() - 1 - i : i;
            SheetState& state = states[order[place]];
            std::vector<Votes> anchors = state.outer_anchors;
            if (place > 0) anchor_to_sheet(states[order[place - 1]], state, anchors);
            if (place + 1 < order.size()) anchor_to_sheet(states[order[place + 1]], state, anchors);
            minimize_cost(state.graph, anchors, state.folds);
            state.fill_gate_folds();
            if (!is_downward) repair_shear(state.sheet, state.gate_folds);
            state.guessed = guessed_nodes(state.graph, anchors, state.folds);
        }
    }
}

// A layer whose wind agrees less than this with its velocities unfolds no gates.
constexpr double least_agreement = 0.3;
// An unfolded velocity that is more turns than this from the wind is ambiguous.
constexpr double most_from_wind = 0.35;

// Chooses the fold number that brings each gate nearest to the wind at its height. A gate is
// ambiguous if there is no wind, or if the wind is nearly as far from the next fold number.
void unfold_to_wind(const FoldedWind& wind, SheetState& state) {
    const VelocitySheet& sheet = state.sheet;
    state.gate_folds.assign(sheet.turns.size(), 0);
    state.ambiguous.assign(sheet.turns.size(), 0);
    const double per_turn = std::cos(sheet.elevation_deg * degree) / sheet.turn_mps;
    for (int radial = 0; radial < sheet.radials; ++radial) {
        const double azimuth = static_cast<double>(sheet.azimuths_deg[at(radial)]) * degree;
        const double east = std::sin(azimuth) * per_turn, north = std::cos(azimuth) * per_turn;
        for (int gate = 0; gate < sheet.gates; ++gate) {
            const std::size_t here = sheet.at(radial, gate);
            const FoldedWind::Layer& layer =
                wind.at(static_cast<double>(state.heights_m[at(gate)]));
            if (std::isnan(sheet.turns[here])) continue;
            if (layer.agreement < least_agreement) {
                state.ambiguous[here] = 1;
                continue;
            }
            const double turns =
                layer.u_mps * east + layer.v_mps * north - static_cast<double>(sheet.turns[here]);
            const double whole = std::nearbyint(turns);
            state.gate_folds[here] = static_cast<std::int8_t>(whole);
            state.ambiguous[here] = std::abs(turns - whole) > most_from_wind ? 1 : 0;
        }
    }
}

void count_jumps(const SheetState& state, Dealiased& dealiased) {
    dealiased.pairs += state.regions.pairs;
    dealiased.jumps += state.regions.jumps;
}

// Marks small nodes that contradict the wind: their neighbors may be speckle.
void mark_islands(const FoldedWind& wind, SheetState& state) {
    constexpr int largest_island = 8;  // gates
    const VelocitySheet& sheet = state.sheet;
    const double per_turn = std::cos(sheet.elevation_deg * degree) / sheet.turn_mps;
    std::vector<int> gates(at(state.graph.nodes));
    std::vector<double> from_wind(gates.size());
    for (const Run& run : state.regions.runs) {
        const auto node = at(state.graph.node_of_region[at(run.region)]);
        gates[node] += run.end - run.begin;
        if (gates[node] > largest_island) continue;
        const double azimuth = static_cast<double>(sheet.azimuths_deg[at(run.radial)]) * degree;
        for (int gate = run.begin; gate < run.end; ++gate) {
            const FoldedWind::Layer& layer =
                wind.at(static_cast<double>(state.heights_m[at(gate)]));
            if (layer.agreement < least_agreement) continue;
            const double there =
                per_turn * (layer.u_mps * std::sin(azimuth) + layer.v_mps * std::cos(azimuth));
            from_wind[node] += std::abs(static_cast<double>(sheet.row(run.radial)[gate]) +
                                        state.fold_of(run.region) - there);
        }
    }
    for (std::size_t node = 0; node < gates.size(); ++node)
        if (gates[node] <= largest_island && from_wind[node] > 0.5 * gates[node])
            state.guessed[node] = 1;
}

// Marks the gates whose fold number is uncertain.
void mark_ambiguous(SheetState& state) {
    state.ambiguous = rough_gates(state.sheet, state.gate_folds);
    for (const Run& run : state.regions.runs) {
        if (state.guessed[at(state.graph.node_of_region[at(run.region)])] == 0) continue;
        const auto begin = static_cast<std::ptrdiff_t>(state.sheet.at(run.radial, run.begin));
        std::fill_n(state.ambiguous.begin() + begin, run.end - run.begin, std::uint8_t{1});
    }
}

// Writes the results of a sheet to the rows of its moment, which have `stride` gates.
void write_folds(const SheetState& state, std::size_t stride, SweepFolds& folds,
                 Dealiased& dealiased) {
    const VelocitySheet& sheet = state.sheet;
    for (int radial = 0; radial < sheet.radials; ++radial) {
        const auto from = static_cast<std::ptrdiff_t>(sheet.at(radial, 0));
        const auto to = static_cast<std::ptrdiff_t>(
            (sheet.first_radial + static_cast<std::size_t>(radial)) * stride);
        std::copy_n(state.gate_folds.begin() + from, sheet.gates, folds.folds.begin() + to);
        std::copy_n(state.ambiguous.begin() + from, sheet.gates, folds.ambiguous.begin() + to);
        std::fill_n(folds.ambiguous.begin() + to + sheet.gates,
                    static_cast<std::ptrdiff_t>(stride) - sheet.gates, std::uint8_t{0});
    }
    // Gates without a value have fold number 0 and no mark.
    for (const float turns : sheet.turns)
        dealiased.gates += std::isnan(turns) ? 0 : 1;
    for (const std::int8_t fold : state.gate_folds)
        dealiased.folded_gates += fold != 0 ? 1 : 0;
    for (const std::uint8_t mark : state.ambiguous)
        dealiased.ambiguous_gates += mark;
}

void mark_certain(const VelocitySheet& sheet, SweepFolds& folds) {
    const auto first = static_cast<std::ptrdiff_t>(sheet.first_radial) * sheet.gates;
    std::fill_n(folds.ambiguous.begin() + first,
                static_cast<std::ptrdiff_t>(sheet.radials) * sheet.gates, std::uint8_t{0});
}

// Returns fold numbers of 0 for all velocity moments. `ambiguous` holds for gates in no sheet.
Dealiased empty_folds(const level2::Volume& volume, bool ambiguous) {
    Dealiased dealiased;
    for (std::size_t s = 0; s < volume.sweeps.size(); ++s) {
        const level2::Sweep& sweep = volume.sweeps[s];
        for (std::size_t m = 0; m < sweep.moments.size(); ++m) {
            if (sweep.moments[m].moment != level2::Moment::vel) continue;
            const std::size_t gates =
                sweep.radials.size() * static_cast<std::size_t>(sweep.moments[m].gate_stride);
            dealiased.sweeps.push_back({s, m, std::vector<std::int8_t>(gates, 0),
                                        std::vector<std::uint8_t>(gates, ambiguous ? 1 : 0)});
        }
    }
    return dealiased;
}

}  // namespace

Dealiased dealias(const level2::Volume& volume, Dealiasing rung,
                  std::span<const level2::Sweep> known_sweeps) {
    // Loops that handle several gates at once also compare gates without a value, which are NaN.
    const MaskedTraps traps;
    const bool is_wanted = rung != Dealiasing::off;
    if (rung == Dealiasing::automatic)
        rung = needs_dealiasing(volume) ? Dealiasing::anchored : Dealiasing::off;
    Dealiased dealiased = empty_folds(volume, is_wanted);
    dealiased.rung = rung;
    if (!is_wanted) return dealiased;
    std::map<std::pair<std::size_t, std::size_t>, SweepFolds*> by_moment;
    for (SweepFolds& folds : dealiased.sweeps)
        by_moment[{folds.sweep, folds.moment}] = &folds;
    std::vector<VelocitySheet> sheets = velocity_sheets(volume);
    if (rung == Dealiasing::off) {
        for (const VelocitySheet& sheet : sheets)
            mark_certain(sheet, *by_moment.at({sheet.sweep, sheet.moment}));
        return dealiased;
    }
    for (VelocitySheet& sheet : sheets)
        drop_empty_gates(sheet);
    std::vector<SheetState> known;
    if (rung == Dealiasing::anchored) known = known_sheets(known_sweeps);
    FoldedWind wind;
    if (rung != Dealiasing::region) wind = fit_folded_wind(sheets);
    const float most_weight = most_anchor_weight + (known.empty() ? 0 : most_known_weight);
    std::vector<SheetState> states;
    states.reserve(sheets.size());
    for (VelocitySheet& sheet : sheets) {
        SheetState& state = states.emplace_back();
        state.sheet = std::move(sheet);
        state.heights_m = gate_heights_m(state.sheet);
        if (rung == Dealiasing::profile)
            unfold_to_wind(wind, state);
        else
            find_graph(state, rung == Dealiasing::anchored ? most_weight : 0);
        if (rung == Dealiasing::region) solve_alone(state);
    }
    if (rung == Dealiasing::anchored) solve_anchored(states, known, wind);
    for (SheetState& state : states) {
        if (rung == Dealiasing::anchored) mark_islands(wind, state);
        if (rung != Dealiasing::profile) mark_ambiguous(state);
    }
    for (const SheetState& state : states) {
        count_jumps(state, dealiased);
        const VelocitySheet& of = state.sheet;
        const level2::SweepMoment& moment = volume.sweeps[of.sweep].moments[of.moment];
        write_folds(state, static_cast<std::size_t>(moment.gate_stride),
                    *by_moment.at({of.sweep, of.moment}), dealiased);
    }
    return dealiased;
}

}  // namespace stormcellar::retrieve
