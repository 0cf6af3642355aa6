// bench_plan: measures how well the planner predicts the time and the error of a grid.
//
// usage: bench_plan [--data DIR] [--threads N] [--runs N] [--times | --errors] [--json] [FILE ...]
//   (bench/request.h; every real volume, unless files are named)
// --times: prints a row for each file, moment, number of threads and choice of rungs:
//   file         name of the file
//   moment       REF or VEL
//   threads      number of threads that grid
//   choice       the rungs that differ from the default chain
//   predicted_s  time that grid::predict() predicts
//   grid_s       time of gridding with the geometry kept, the least of the runs. With exact
//                geodesics, which only one chain needs, the time includes making the geometry. For
//                one thread it is CPU time, so that other programs do not count; for several
//                threads it is wall time
//   ratio        predicted_s / grid_s
//   predict_s    time of the prediction for all choices together
// The grid has 460 x 460 x 32 cells at 1 km. It is 0.4 degrees east of the site, so that site frame
// and sphere frame differ. There are three kinds of choices:
//   - each rung of each step except the frame, with all other steps at their default;
//   - every interpolation, with and without the size of cells;
//   - the chain's exact form.
// --errors: prints a row for each volume, domain and budget whose plan turns an effect off:
//   cells        number of cells with a value in both the chosen and the exact grid
//   stated_db    99th percentile of the error that the plan states
//   true_db      99th percentile of the error over all these cells
//   held         1 if true_db is at most stated_db, else 0
// Without either option, both are done. Files without the moment are left out.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "accuracy/timing.h"
#include "base/memory.h"
#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "grid/plan/grid_effects.h"
#include "grid/plan/grid_scene.h"
#include "stormcellar/accuracy/error_statistics.h"
#include "stormcellar/accuracy/planner.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using accuracy::Choice;

Result<level2::Volume> decode_moment(const fs::path& file, level2::Moment moment) {
    level2::DecodeOptions options;
    const std::string name = file.filename().string().substr(0, 4);
    if (find_station(name)) options.fallback_station = name;
    options.selection.moments = {moment};
    auto decoded = level2::decode_file(file, options);
    if (!decoded) return pass_on(decoded);
    return std::move(decoded->volume);
}

std::vector<Choice> choices_of(const accuracy::Chain& chain, const Choice& usual) {
    std::vector<Choice> choices;
    const auto add = [&](const Choice& choice) {
        if (std::find(choices.begin(), choices.end(), choice) == choices.end())
            choices.push_back(choice);
    };
    std::size_t interpolation = 0;
    std::size_t cell = 0;
    Choice exact;
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        const accuracy::Step& step = chain.steps[i];
        if (step.name == "interpolation") interpolation = i;
        if (step.name == "cell") cell = i;
        exact.rungs.push_back(step.effects.size());
        for (std::size_t rung = 0; rung < step.rung_count(); ++rung) {
            Choice choice = usual;
            choice.rungs[i] = rung;
            // Leave out other frames here: their geometry takes far longer than gridding.
            if (step.name != "frame" || rung == usual.rungs[i]) add(choice);
        }
    }
    for (std::size_t rung = 0; rung < chain.steps[interpolation].rung_count(); ++rung) {
        for (const std::size_t extent : {0, 1}) {
            Choice choice = usual;
            choice.rungs[interpolation] = rung;
            choice.rungs[cell] = extent;
            add(choice);
        }
    }
    add(exact);
    return choices;
}

std::string name_of(const accuracy::Chain& chain, const Choice& choice, const Choice& usual) {
    std::string text;
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        if (choice.rungs[i] == usual.rungs[i]) continue;
        if (!text.empty()) text += ", ";
        text += chain.steps[i].rung_name(choice.rungs[i]);
    }
    return text.empty() ? "default" : text;
}

double now_s(int threads) {
    return threads > 1 ? accuracy::monotonic_s() : accuracy::thread_s();
}

// Returns the least of the runs; negative if there is no grid.
double seconds_of_gridding(grid::GridScene& scene, const grid::SceneChoice& choice, int runs) {
    grid::GridderOptions options;
    options.moment = scene.options().moment;
    options.threads = scene.options().threads;
    options.method = choice.method;
    double least_s = HUGE_VAL;
    for (int run = 0; run < std::max(1, runs); ++run) {
        const double start_s = now_s(options.threads);
        const auto geometry =
            choice.frame == grid::FrameKind::geodesic
                ? grid::make_column_geometry(scene.site(), scene.spec(), choice.frame)
                : scene.geometry(choice.frame);
        if (!geometry) return -1;
        if (!grid::make_grid(scene.volume(), scene.site(), **geometry, options)) return -1;
        least_s = std::min(least_s, now_s(options.threads) - start_s);
        if (least_s > 1 && run > 0) break;  // long times vary little, so two runs are enough
    }
    return least_s;
}

void measure_times(const fs::path& file, level2::Moment moment, int threads, int runs,
                   Table& table) {
    const auto volume = decode_moment(file, moment);
    if (!volume) return;
    const auto site = site_of(*volume);
    if (!site) return;
    grid::GridSpec spec = grid::default_spec(site->latitude_deg, site->longitude_deg + 0.4);
    spec.nx = spec.ny = 460;
    spec.spacing_m = 1000;
    grid::SceneOptions options;
    options.moment = moment;
    options.threads = threads;
    auto scene = grid::GridScene::make(*volume, *site, spec, options);
    if (!scene || scene->columns_with_echo() == 0) return;
    accuracy::Chain chain = grid::effects_of(moment);
    const double start_s = accuracy::monotonic_s();
    if (!grid::predict(*scene, {}, chain)) return;
    const double predict_s = accuracy::monotonic_s() - start_s;
    const Choice usual = grid::usual_choice(chain);
    for (const Choice& choice : choices_of(chain, usual)) {
        const double predicted_s = accuracy::cost_s(chain, choice);
        const double grid_s = seconds_of_gridding(*scene, grid::scene_choice(chain, choice), runs);
        table.add({{"file", file.filename().string()},
                   {"moment", std::string(level2::moment_name(moment))},
                   {"threads", threads},
                   {"choice", name_of(chain, choice, usual)},
                   {"predicted_s", {predicted_s, 4}},
                   {"grid_s", {grid_s, 4}},
                   {"ratio", {predicted_s / grid_s, 2}},
                   {"predict_s", {predict_s, 3}}});
    }
}

struct Domain {
    const char* name;
    double side_m;
    double spacing_m;
    double off_km;  // distance of its center east of the site
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
                           {level2::Moment::ref, 0, 1, choice.method, {}});
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

void measure_errors(const std::string& name, const level2::Volume& volume,
                    const grid::SitePosition& site, const Domain& domain, Table& table) {
    grid::SceneOptions options;
    options.threads = 1;
    auto scene = grid::GridScene::make(volume, site, spec_of(site, domain), options);
    if (!scene) return;
    const accuracy::Chain chain = grid::effects_of(level2::Moment::ref);
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
        table.add({{"file", name},
                   {"domain", domain.name},
                   {"budget", text},
                   {"cells", static_cast<int>(errors.size())},
                   {"stated_db", {stated, 3}},
                   {"true_db", {summary->p99, 3}},
                   {"held", summary->p99 <= stated + 1e-6 ? 1 : 0}});
    }
}

void measure(const fs::path& file, const Request& request, Table& table) {
    if (!request.has("--errors")) {
        for (const level2::Moment moment : {level2::Moment::ref, level2::Moment::vel}) {
            for (const int threads : request.threads)
                measure_times(file, moment, threads, request.runs, table);
        }
    }
    if (request.has("--times")) return;
    const auto decoded = level2::decode_file(file);
    const auto site = decoded ? site_of(decoded->volume) : fail(ErrorCode::not_found, "");
    if (!site) return;
    for (const Domain& domain : domains)
        measure_errors(file.filename().string(), decoded->volume, *site, domain, table);
}

int run(int argc, char** argv) {
    keep_freed_memory();
    return run_over_files({"bench_plan",
                           "[FILE ...]",
                           "what the planner says of a grid's time and error, and what is true",
                           {"--times", "--errors"}},
                          std::span(argv, static_cast<std::size_t>(argc)), measure);
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
