#include "grid/plan/grid_ladder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "accuracy/timing.h"
#include "base/degree.h"
#include "stormcellar/grid/gridder.h"

namespace stormcellar::grid {
namespace {

struct Position {
    double max_m = 0, rms_m = 0;
};

class PositionErrors {
  public:
    void add(double error_m) {
        max_m_ = std::max(max_m_, error_m);
        sum_m2_ += error_m * error_m;
        ++count_;
    }
    [[nodiscard]] Position summary() const {
        if (count_ == 0) return {};
        return {max_m_, std::sqrt(sum_m2_ / static_cast<double>(count_))};
    }

  private:
    double max_m_ = 0, sum_m2_ = 0;
    std::size_t count_ = 0;
};

Result<Position> frame_position(GridScene& scene, FrameKind kind) {
    if (is_centered_at(scene.site(), scene.spec())) return Position{};
    const auto rung = scene.geometry(kind);
    const auto exact = scene.geometry(FrameKind::geodesic);
    if (!rung || !exact) return pass_on(rung ? exact : rung);
    const auto plane = [](const ColumnPlace& at) {
        const double azimuth = static_cast<double>(at.azimuth_deg) * degree;
        const auto arc_m = static_cast<double>(at.arc_m);
        return std::array{arc_m * std::sin(azimuth), arc_m * std::cos(azimuth)};
    };
    PositionErrors errors;
    const auto reach_m = static_cast<float>(scene.reach_m());
    for (int iy = 0; iy < scene.spec().ny; iy += 3) {
        for (int ix = 0; ix < scene.spec().nx; ix += 3) {
            const ColumnPlace& at = (*exact)->row(iy)[static_cast<std::size_t>(ix)];
            if (at.arc_m > reach_m) continue;
            const auto a = plane((*rung)->row(iy)[static_cast<std::size_t>(ix)]);
            const auto b = plane(at);
            errors.add(std::hypot(a[0] - b[0], a[1] - b[1]));
        }
    }
    return errors.summary();
}

// Returns the position errors that the beam causes at gates every 2 km along the sweeps, up to the
// top level.
Position beam_position(const GridScene& scene, BeamKind kind) {
    constexpr double step_m = 2000;
    const RefractivityProfile& profile = scene.options().profile;
    const BeamModel rung = beam_model_of(scene.site(), kind, profile);
    const BeamModel exact = beam_model_of(scene.site(), BeamKind::traced, profile);
    const double reach_m = scene.reach_m();  // solves the geodesics of the columns at the border
    PositionErrors errors;
    for (const ChosenSweep& sweep : scene.chosen()) {
        const BeamPath a = rung.path(sweep.elevation_deg);
        const BeamPath b = exact.path(sweep.elevation_deg);
        for (int gate = 1; gate * step_m < reach_m; ++gate) {
            const double range_m = gate * step_m;
            const EarthPoint here = a.at(range_m);
            const EarthPoint there = b.at(range_m);
            const bool counts = there.height_m <= scene.spec().levels_m.back() &&
                                there.arc_m <= reach_m && !std::isnan(here.height_m);
            if (!counts) continue;
            errors.add(std::hypot(here.arc_m - there.arc_m, here.height_m - there.height_m));
        }
    }
    return errors.summary();
}

// Returns the position errors that the elevation causes on each radial at the place where the
// radial leaves the grid.
Position elevation_position(const GridScene& scene) {
    constexpr double step_m = 1000;
    PositionErrors errors;
    const BeamModel beam =
        beam_model_of(scene.site(), BeamKind::four_thirds, scene.options().profile);
    const double top_m = scene.spec().levels_m.back();
    const double reach_m = scene.reach_m();
    for (const ChosenSweep& sweep : scene.chosen()) {
        const BeamPath path = beam.path(sweep.elevation_deg);
        double range_m = 0;
        for (int step = 0; step * step_m < reach_m; ++step) {
            if (path.at(step * step_m).height_m > top_m) break;
            range_m = step * step_m;
        }
        const auto& radials = scene.volume().sweeps[sweep.sweep_index].radials;
        for (const std::uint32_t radial : sweep.radials) {
            const auto measured_deg = static_cast<double>(radials[radial].elevation_deg);
            errors.add(std::abs(measured_deg - sweep.elevation_deg) * degree * range_m);
        }
    }
    return errors.summary();
}

Result<Position> position_of(GridScene& scene, const std::string& name, std::size_t rung,
                             std::size_t rungs) {
    if (name == step::frame) return frame_position(scene, static_cast<FrameKind>(rung));
    if (name == step::beam) return beam_position(scene, static_cast<BeamKind>(rung));
    if (name == step::elevation && rung + 1 < rungs) return elevation_position(scene);
    return Position{};
}

// Returns the position error of a whole chain. The largest errors of its steps are added, and so
// are the squares of their RMS errors.
Result<Position> position_of(GridScene& scene, const SceneChoice& choice) {
    auto frame = frame_position(scene, choice.frame);
    if (!frame) return frame;
    const Position beam = beam_position(scene, choice.method.beam);
    const Position jitter =
        choice.method.radial_elevations ? Position{} : elevation_position(scene);
    return Position{frame->max_m + beam.max_m + jitter.max_m,
                    std::hypot(frame->rms_m, beam.rms_m, jitter.rms_m)};
}

// Times the grid twice: once with its geometry and all other preparation, and once without what can
// be kept.
Status time_grid(GridScene& scene, const SceneChoice& choice, int rounds,
                 accuracy::LadderRow& row) {
    const GridderOptions options{scene.options().moment, scene.options().beam_width_deg,
                                 scene.options().threads, choice.method, scene.options().profile};
    double least_s = HUGE_VAL;
    for (int round = 0; round < std::max(1, rounds); ++round) {
        const double start_s = accuracy::monotonic_s();
        const auto geometry = round == 0
                                  ? make_column_geometry(scene.site(), scene.spec(), choice.frame)
                                  : scene.geometry(choice.frame);
        if (!geometry) return pass_on(geometry);
        const auto grid = make_grid(scene.volume(), scene.site(), **geometry, options);
        if (!grid) return pass_on(grid);
        const double took_s = accuracy::monotonic_s() - start_s;
        if (round == 0) row.time_s = took_s;
        if (round > 0 || rounds <= 1) least_s = std::min(least_s, took_s);
    }
    row.kept_time_s = least_s;
    return {};
}

void take_errors(const SampledErrors& errors, accuracy::LadderRow& row) {
    row.value = accuracy::summarize(errors.clusters);
    row.status = errors.status;
}

}  // namespace

std::vector<NamedChain> named_chains(level2::Moment moment, Averaging averaging) {
    std::vector<NamedChain> chains;
    SceneChoice choice;
    choice.method.averaging = averaging;
    const auto add = [&](std::string name, Interpolation interpolation, CellExtent cell) {
        choice.method.interpolation = interpolation;
        choice.method.cell = cell;
        chains.push_back({std::move(name), choice});
    };
    for (const InterpolationFacts& facts : interpolation_facts) {
        const bool is_default = Method{}.interpolation == facts.interpolation;
        add(std::string(facts.name) + (is_default ? " (default)" : ""), facts.interpolation,
            CellExtent::point);
    }
    add("area", Interpolation::beam_weighted, CellExtent::area);
    if (moment == level2::Moment::ref) {
        const bool in_z = averaging == Averaging::in_z;
        choice.method.averaging = in_z ? Averaging::in_db : Averaging::in_z;
        add(in_z ? "area, in dB" : "area, in Z", Interpolation::beam_weighted, CellExtent::area);
        choice.method.averaging = averaging;
    }
    choice.method.beam = BeamKind::traced;
    choice.frame = FrameKind::geodesic;
    add("exact", Interpolation::beam_weighted, CellExtent::area);
    return chains;
}

Result<std::vector<accuracy::LadderRow>> run_ladder(GridScene& scene,
                                                    const LadderOptions& options) {
    const accuracy::Chain chain = effects_of(scene.options().moment, options.averaging);
    accuracy::Choice exact_choice;
    for (const accuracy::Step& step : chain.steps)
        exact_choice.rungs.push_back(step.effects.size());
    const accuracy::Choice usual = usual_choice(chain);
    const ColumnSample sample = scene.draw(options.columns, options.seed);
    const auto exact = scene.evaluate(scene_choice(chain, exact_choice), sample);
    if (!exact) return pass_on(exact);

    const auto chains = named_chains(scene.options().moment, options.averaging);
    std::size_t total = chains.size();
    for (const accuracy::Step& step : chain.steps)
        total += step.effects.empty() ? 0 : step.rung_count();
    std::vector<accuracy::LadderRow> rows;
    const auto add = [&](accuracy::LadderRow row, const SceneChoice& with_errors,
                         const SceneChoice& with_times,
                         const Result<Position>& position) -> Status {
        if (!position) return pass_on(position);
        row.position_max_m = position->max_m;
        row.position_rms_m = position->rms_m;
        const auto cells = scene.evaluate(with_errors, sample);
        if (!cells) return pass_on(cells);
        take_errors(scene.compare(*cells, *exact, sample), row);
        if (auto timed = time_grid(scene, with_times, options.rounds, row); !timed) return timed;
        rows.push_back(std::move(row));
        if (options.progress) options.progress(rows.size(), total);
        return {};
    };
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        const accuracy::Step& step = chain.steps[i];
        if (step.effects.empty()) continue;
        for (std::size_t rung = 0; rung < step.rung_count(); ++rung) {
            const accuracy::Choice errors = accuracy::with_rung(exact_choice, i, rung);
            const accuracy::Choice times = accuracy::with_rung(usual, i, rung);
            accuracy::LadderRow row;
            row.step = step.name;
            row.rung = rung;
            row.name = step.rung_name(rung);
            const auto added =
                add(std::move(row), scene_choice(chain, errors), scene_choice(chain, times),
                    position_of(scene, step.name, rung, step.rung_count()));
            if (!added) return pass_on(added);
        }
    }
    std::size_t rung = 0;
    for (const NamedChain& named : chains) {
        accuracy::LadderRow row;
        row.step = "chain";
        row.rung = rung++;
        row.name = named.name;
        const auto added =
            add(std::move(row), named.choice, named.choice, position_of(scene, named.choice));
        if (!added) return pass_on(added);
    }
    accuracy::mark_pareto(rows, accuracy::TimeKind::kept);
    return rows;
}

}  // namespace stormcellar::grid
