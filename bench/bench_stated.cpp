// bench_stated: whether the value error that a plan of a grid states holds over all its cells.
//
// usage: bench_stated [--data DIR] [--json] [FILE ...]      (bench/request.h)
// For each volume, domain and budget one row:
//   volume, domain, budget
//   cells      that have a value in the chosen grid and in the exact one
//   stated_db  99th percentile that the plan states
//   true_db    99th percentile over all these cells
//   held       1 if the true one is at most the stated one, else 0; "-" where a budget cannot be
//   met
// Budgets that leave nothing off are not shown, since both grids are the same.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/request.h"
#include "bench/table.h"
#include "bench/volume_site.h"
#include "grid/plan/grid_effects.h"
#include "grid/plan/grid_scene.h"
#include "stormcellar/accuracy/error_statistics.h"
#include "stormcellar/accuracy/planner.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::bench {
namespace {

constexpr auto moment = level2::Moment::ref;
constexpr int threads = 1;

struct Domain {
    const char* name;
    double side_m;
    double spacing_m;
    double off_km;  // of its center, to the east of the site
};
constexpr std::array domains = {Domain{"460 km", 460e3, 1000, 0}, Domain{"300 km", 300e3, 1000, 0},
                                Domain{"300 km coarse", 300e3, 2000, 0},
                                Domain{"80 km fine", 80e3, 500, 60}};
constexpr std::array budgets = {"250 m, 1 dB", "1 km, 3 dB", "1 km, 5 dB", "2 km, 6 dB",
                                "3 km, 10 dB"};

grid::GridSpec spec_of(const grid::SitePosition& site, const Domain& domain) {
    const double degrees_a_km = 1 / (111.2 * std::cos(site.latitude_deg * 0.017453292519943295));
    grid::GridSpec spec =
        grid::default_spec(site.latitude_deg, site.longitude_deg + domain.off_km * degrees_a_km);
    spec.spacing_m = domain.spacing_m;
    spec.nx = spec.ny = static_cast<int>(domain.side_m / domain.spacing_m);
    spec.levels_m.clear();
    for (int level = 1; level <= 24; ++level)
        spec.levels_m.push_back(500.0 * level);
    return spec;
}

grid::SceneChoice exact_of(const accuracy::Chain& chain) {
    accuracy::Choice all;
    for (const accuracy::Step& step : chain.steps)
        all.rungs.push_back(step.effects.size());
    return grid::scene_choice(chain, all);
}

Result<grid::Grid> whole(grid::GridScene& scene, const grid::SceneChoice& choice) {
    const auto geometry = scene.geometry(choice.frame);
    if (!geometry) return pass_on(geometry);
    return grid::make_grid(scene.volume(), scene.site(), **geometry,
                           {moment, 0, threads, choice.method, {}});
}

std::vector<double> errors_of(const grid::Grid& chosen, const grid::Grid& exact) {
    std::vector<double> errors;
    for (std::size_t cell = 0; cell < chosen.status.size(); ++cell) {
        const bool both = chosen.status[cell] == grid::CellStatus::value &&
                          exact.status[cell] == grid::CellStatus::value;
        if (both) errors.push_back(static_cast<double>(chosen.values[cell] - exact.values[cell]));
    }
    return errors;
}

void measure_domain(const std::string& name, const level2::Volume& volume,
                    const grid::SitePosition& site, const Domain& domain, Table& table) {
    grid::SceneOptions options;
    options.threads = threads;
    auto scene = grid::GridScene::make(volume, site, spec_of(site, domain), options);
    if (!scene) return;
    const accuracy::Chain chain = grid::effects_of(moment);
    const auto exact = whole(*scene, exact_of(chain));
    if (!exact) return;
    for (const char* text : budgets) {
        const auto budget = accuracy::parse_budget(text);
        const auto plan = grid::plan_grid(*scene, chain, *budget);
        if (!plan || plan->choice == exact_of(chain)) continue;
        const double stated = plan->plan.measured && plan->plan.measured->value
                                  ? *plan->plan.measured->value
                                  : plan->plan.left_off.value;
        const auto chosen = whole(*scene, plan->choice);
        if (!chosen) continue;
        const auto errors = errors_of(*chosen, *exact);
        const auto summary = accuracy::summarize(errors);
        if (!summary) continue;
        table.add({{"volume", name},
                   {"domain", domain.name},
                   {"budget", text},
                   {"cells", static_cast<int>(errors.size())},
                   {"stated_db", {stated, 3}},
                   {"true_db", {summary->p99, 3}},
                   {"held", summary->p99 <= stated + 1e-6 ? 1 : 0}});
    }
}

void measure(const std::filesystem::path& path, const Request&, Table& table) {
    const auto decoded = level2::decode_file(path);
    if (!decoded) return;
    const auto site = site_of(decoded->volume);
    if (!site) return;
    for (const Domain& domain : domains)
        measure_domain(path.filename().string(), decoded->volume, *site, domain, table);
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    using namespace stormcellar::bench;
    return run_over_files({"bench_stated", "[FILE ...]",
                           "whether the error that a plan of a grid states holds over all cells"},
                          {argv, static_cast<std::size_t>(argc)}, measure);
}
