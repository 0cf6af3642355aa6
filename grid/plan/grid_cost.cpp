#include "grid/plan/grid_cost.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "accuracy/timing.h"
#include "grid/plan/grid_effects.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/grid/site_frame.h"

namespace stormcellar::grid {
namespace {

// A thread takes this many tiles at a time.
constexpr std::size_t tiles_a_piece = 16;
constexpr std::size_t fewest_pieces = 2;
constexpr std::size_t most_pieces = 8;
constexpr double short_time_s = 0.02;

bool may_hold_values(const GridScene& scene, const Tile& tile) {
    for (int iy = tile.first_y; iy < tile.end_y; ++iy) {
        for (int ix = tile.first_x; ix < tile.end_x; ++ix) {
            if (scene.may_hold_value(ix, iy)) return true;
        }
    }
    return false;
}

// Selects tiles that are spread evenly along the arc, so that each piece of the sample has near and
// far tiles.
TileSample::Stratum spread(std::vector<Tile> tiles, std::size_t of_each) {
    std::stable_sort(tiles.begin(), tiles.end(), [](const Tile& a, const Tile& b) {
        return a.bounds.least_arc_m < b.bounds.least_arc_m;
    });
    TileSample::Stratum stratum;
    stratum.count = tiles.size();
    const std::size_t taken = std::min(of_each, tiles.size());
    const std::size_t pieces = std::max<std::size_t>(1, taken / tiles_a_piece);
    for (std::size_t piece = 0; piece < pieces; ++piece) {
        for (std::size_t i = piece; i < taken; i += pieces)
            stratum.tiles.push_back(tiles[(2 * i + 1) * tiles.size() / (2 * taken)]);
    }
    return stratum;
}

// Times a stratum. If the run was short, repeats it and takes the smaller time, which has less
// noise.
Result<double> stratum_s(GridScene& scene, const Method& method,
                         const TileSample::Stratum& stratum) {
    if (stratum.tiles.empty()) return 0.0;
    auto took_s = scene.fill(method, stratum.tiles);
    if (!took_s) return took_s;
    if (*took_s < short_time_s) {
        auto again_s = scene.fill(method, stratum.tiles);
        if (!again_s) return again_s;
        took_s = std::min(*took_s, *again_s);
    }
    return *took_s * static_cast<double>(stratum.count) / static_cast<double>(stratum.tiles.size());
}

// Estimates how long the geodesics of all columns take. Times only some of the geodesics.
double geodesics_s(const GridScene& scene) {
    constexpr int a_side = 16;
    const GridSpec& spec = scene.spec();
    if (is_centered_at(scene.site(), spec)) return 0;
    const SiteFrame frame(scene.site().latitude_deg, scene.site().longitude_deg);
    const GridProjection projection(spec);
    double least_s = HUGE_VAL;
    double sum_m = 0;
    for (int round = 0; round < 2; ++round) {
        const double start_s = accuracy::thread_s();
        for (int y = 0; y < a_side; ++y) {
            for (int x = 0; x < a_side; ++x) {
                sum_m += frame
                             .to_polar(projection.to_geo(
                                 {(x + 0.5) * spec.nx / a_side, (y + 0.5) * spec.ny / a_side}))
                             .arc_m;
            }
        }
        least_s = std::min(least_s, accuracy::thread_s() - start_s);
    }
    if (!(sum_m >= 0)) return 0;  // using the sum keeps the compiler from removing the work
    return least_s * static_cast<double>(spec.column_count()) / (a_side * a_side);
}

// The times of filling the whole grid by each interpolation, for cells that are points and for
// cells that are areas.
using Fills = std::array<std::array<double, 2>, interpolation_facts.size()>;

Result<Fills> predicted_fills(GridScene& scene, Method method, const TileSample& sample) {
    Fills fills{};
    for (std::size_t i = 0; i < fills.size(); ++i) {
        for (const CellExtent cell : {CellExtent::point, CellExtent::area}) {
            method.interpolation = static_cast<Interpolation>(i);
            method.cell = cell;
            const auto fill_s = predicted_fill_s(scene, method, sample);
            if (!fill_s) return pass_on(fill_s);
            fills[i][static_cast<std::size_t>(cell)] = *fill_s;
        }
    }
    return fills;
}

double more(double with_s, double without_s) {
    return std::max(0.0, with_s - without_s);
}

// Sets the cost of each effect without joint costs. The cost of an interpolation is its cost for
// point cells. The cost of areas is their cost for the nearest gate.
void set_effect_costs(const Fills& fills, std::size_t interpolation, std::size_t cell,
                      accuracy::Chain& chain) {
    std::vector<accuracy::Effect>& rungs = chain.steps[interpolation].effects;
    for (std::size_t i = 0; i < rungs.size(); ++i)
        rungs[i].cost_s = more(fills[i + 1][0], fills[i][0]);
    chain.steps[cell].effects[0].cost_s = more(fills[0][1], fills[0][0]);
}

void set_joint_costs(const Fills& fills, std::size_t interpolation, std::size_t cell,
                     accuracy::Chain& chain) {
    chain.joint_costs.clear();
    double sum_s = fills[0][0] + chain.steps[cell].effects[0].cost_s;
    for (std::size_t i = 1; i < fills.size(); ++i) {
        sum_s += chain.steps[interpolation].effects[i - 1].cost_s;
        chain.joint_costs.push_back(
            {interpolation, i, cell, 1, fills[i][1] - sum_s,
             joint_effort(static_cast<Interpolation>(i), CellExtent::area)});
    }
}

// Returns the step with this name. The chain must have it; only step::circle may be missing in the
// chain of a grid.
accuracy::Step& step_named(accuracy::Chain& chain, std::string_view name) {
    return chain.steps[accuracy::find_step(chain, name).value()];
}

}  // namespace

TileSample draw_tiles(GridScene& scene, std::size_t of_each) {
    std::vector<Tile> with_echo;
    std::vector<Tile> without;
    const auto reach_m = static_cast<float>(scene.reach_m());
    for (const Tile& tile : scene.tiles()) {
        // Nothing beyond the reach is seen, so a tile there takes no time.
        if (!(tile.bounds.least_arc_m < reach_m)) continue;
        (may_hold_values(scene, tile) ? with_echo : without).push_back(tile);
    }
    return {spread(std::move(with_echo), of_each), spread(std::move(without), of_each)};
}

Result<double> predicted_fill_s(GridScene& scene, const Method& method, const TileSample& sample) {
    auto with_echo_s = stratum_s(scene, method, sample.with_echo);
    if (!with_echo_s) return with_echo_s;
    auto without_s = stratum_s(scene, method, sample.without);
    if (!without_s) return without_s;
    return *with_echo_s + *without_s;
}

Status predict_costs(GridScene& scene, accuracy::Chain& chain) {
    const auto threads = static_cast<std::size_t>(std::max(1, scene.options().threads));
    const TileSample sample =
        draw_tiles(scene, tiles_a_piece * std::clamp(threads, fewest_pieces, most_pieces));
    const std::size_t interpolation = accuracy::find_step(chain, step::interpolation).value();
    const std::size_t cell = accuracy::find_step(chain, step::cell).value();
    accuracy::Choice cheapest;
    cheapest.rungs.resize(chain.steps.size());
    Method usual;  // has the usual rungs; the chain does not choose the averaging
    usual.averaging = scene_choice(chain, cheapest).method.averaging;
    const auto fills = predicted_fills(scene, usual, sample);
    if (!fills) return pass_on(fills);
    set_effect_costs(*fills, interpolation, cell, chain);
    set_joint_costs(*fills, interpolation, cell, chain);

    const double usual_s = (*fills)[static_cast<std::size_t>(Interpolation::linear)][0];
    double cheapest_s = (*fills)[0][0];
    const auto set_cost_without = [&](std::string_view name, const Method& method) -> Status {
        const auto without_s = predicted_fill_s(scene, method, sample);
        if (!without_s) return pass_on(without_s);
        const double cost_s = more(usual_s, *without_s);
        step_named(chain, name).effects[0].cost_s = cost_s;
        cheapest_s -= cost_s;
        return {};
    };
    Method method = usual;
    method.radial_elevations = false;
    if (auto done = set_cost_without(step::elevation, method); !done) return done;
    if (accuracy::find_step(chain, step::circle)) {
        method = usual;
        method.on_circle = false;
        if (auto done = set_cost_without(step::circle, method); !done) return done;
    }
    // All closed formulas take equally long, and so does sampling along any path.
    method = usual;
    method.beam = BeamKind::traced;
    const double traced_s = scene.stack_seconds(method);
    const double tables_s = scene.stack_seconds(usual);
    step_named(chain, step::beam).effects[1].cost_s = more(traced_s, tables_s);
    step_named(chain, step::frame).effects[1].cost_s = geodesics_s(scene);

    // The base was made by the default chain, in the unit of the moment.
    const auto base_fill_s = predicted_fill_s(scene, Method{}, sample);
    if (!base_fill_s) return pass_on(base_fill_s);
    const double rest_s = more(scene.base_seconds(), *base_fill_s + scene.stack_seconds(Method{}));
    chain.cheapest_cost_s = rest_s + tables_s + std::max(0.0, cheapest_s);
    return {};
}

}  // namespace stormcellar::grid
