#include "pipeline/plan/mosaic_ladder.h"

#include <algorithm>
#include <functional>

#include "accuracy/timing.h"
#include "grid/cells/compare_bricks.h"
#include "pipeline/plan/mosaic_plan.h"

namespace stormcellar::pipeline {
namespace {

// A row of the ladder, the frame with which it is compared, and the work whose time it states.
struct Rung {
    accuracy::LadderRow row;
    MosaicChoice with_errors;
    MosaicChoice with_times;
    bool grids = false;  // the time includes gridding
};

std::vector<Rung> rungs_of_steps(const MosaicScene& scene, const accuracy::Chain& chain) {
    const accuracy::Choice exact = grid::reference_choice(chain);
    const Displacements moved = displacements(scene);
    std::vector<Rung> rungs;
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        const accuracy::Step& of = chain.steps[i];
        if (!is_of_merging(of) || of.effects.empty()) continue;
        for (std::size_t k = 0; k < of.rung_count(); ++k) {
            Rung rung;
            rung.row.step = of.name;
            rung.row.rung = k;
            rung.row.name = of.rung_name(k);
            const bool stays = k + 1 < of.rung_count();
            if (stays && of.name == step::time) rung.row.position_max_m = moved.to_instant_m;
            if (stays && of.name == step::sweeps) rung.row.position_max_m = moved.within_volume_m;
            rung.with_errors = mosaic_choice(chain, accuracy::with_rung(exact, i, k));
            const MosaicChoice& by_errors = rung.with_errors;
            rung.with_times = scene.default_choice();
            if (of.name == step::time) rung.with_times.time = by_errors.time;
            if (of.name == step::sweeps) rung.with_times.sweep_times = by_errors.sweep_times;
            if (of.name == step::overlap) rung.with_times.mixes_sites = by_errors.mixes_sites;
            if (of.name == step::codes) rung.with_times.fine_codes = by_errors.fine_codes;
            rungs.push_back(std::move(rung));
        }
    }
    return rungs;
}

std::vector<Rung> rungs_of_chains(const MosaicScene& scene, const accuracy::Chain& chain) {
    MosaicChoice cheapest = scene.default_choice();
    cheapest.gridding.method.interpolation = grid::Interpolation::nearest;
    cheapest.time = grid::TimeMethod::nearest;
    cheapest.sweep_times = false;
    cheapest.mixes_sites = false;
    MosaicChoice area = scene.default_choice();
    area.gridding.method.interpolation = grid::Interpolation::beam_weighted;
    area.gridding.method.cell = grid::CellExtent::area;
    const MosaicChoice exact = mosaic_choice(chain, grid::reference_choice(chain));
    std::vector<Rung> rungs;
    const auto add = [&](const char* name, const MosaicChoice& choice) {
        Rung rung;
        rung.row.step = "chain";
        rung.row.rung = rungs.size();
        rung.row.name = name;
        rung.with_errors = rung.with_times = choice;
        rung.grids = true;
        rungs.push_back(std::move(rung));
    };
    add("nearest in all", cheapest);
    add("default", scene.default_choice());
    add("area, else default", area);
    add("exact", exact);
    return rungs;
}

// Times all rungs in rounds. Each round runs one rung after the other. Calls `one_done` after each
// rung.
Status time_all(MosaicScene& scene, int rounds, const std::function<void()>& one_done,
                std::vector<Rung>& rungs) {
    Status status;
    std::vector<std::function<void()>> works;
    works.reserve(rungs.size());
    for (const Rung& rung : rungs) {
        works.emplace_back([&scene, &rung, &status, &one_done] {
            if (!status) return;
            if (rung.grids) scene.forget(rung.with_times);
            if (auto made = scene.frame(rung.with_times); !made) status = pass_on(made);
            one_done();
        });
    }
    const auto timings =
        accuracy::time_in_rounds(works, rounds, [&scene] { return scene.now_s(); });
    if (!status) return status;
    for (std::size_t at = 0; at < rungs.size(); ++at) {
        // Add the time for estimating the motion, because the scene estimated it before the
        // first frame.
        const bool moves = rungs[at].with_times.time == grid::TimeMethod::advected;
        const double motion_s = moves ? scene.motion_seconds() : 0;
        rungs[at].row.time_s = timings[at].first_s + motion_s;
        rungs[at].row.kept_time_s = timings[at].least_s + motion_s;
    }
    return {};
}

}  // namespace

Result<std::vector<accuracy::LadderRow>> run_ladder(
    MosaicScene& scene, const accuracy::Chain& chain, int rounds,
    const std::function<void(std::size_t done, std::size_t total)>& progress) {
    std::vector<Rung> rungs = rungs_of_steps(scene, chain);
    for (Rung& rung : rungs_of_chains(scene, chain))
        rungs.push_back(std::move(rung));
    const std::size_t total = rungs.size() * (1 + static_cast<std::size_t>(std::max(1, rounds)));
    std::size_t done = 0;
    const auto one_done = [&] {
        if (progress) progress(++done, total);
    };
    const auto exact = scene.frame(mosaic_choice(chain, grid::reference_choice(chain)));
    if (!exact) return pass_on(exact);
    for (Rung& rung : rungs) {
        const auto frame = scene.frame(rung.with_errors);
        if (!frame) return pass_on(frame);
        const auto found = grid::compare_bricks(
            frame->mosaic.cells.view(), exact->mosaic.cells.view(), scene.options().frame.threads);
        if (!found) return pass_on(found);
        rung.row.value = found->summary();
        rung.row.status = found->status;
        one_done();
    }
    // Measure single steps first, so that the partials that they share are kept.
    const auto chains = std::stable_partition(rungs.begin(), rungs.end(),
                                              [](const Rung& rung) { return !rung.grids; });
    std::vector<Rung> whole(std::make_move_iterator(chains), std::make_move_iterator(rungs.end()));
    rungs.erase(chains, rungs.end());
    if (auto timed = time_all(scene, rounds, one_done, rungs); !timed) return pass_on(timed);
    if (auto timed = time_all(scene, rounds, one_done, whole); !timed) return pass_on(timed);
    std::vector<accuracy::LadderRow> rows;
    for (const std::vector<Rung>* part : {&rungs, &whole}) {
        for (const Rung& rung : *part)
            rows.push_back(rung.row);
    }
    accuracy::mark_pareto(rows, accuracy::TimeKind::kept);
    return rows;
}

}  // namespace stormcellar::pipeline
