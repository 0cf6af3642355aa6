#include "stormcellar/accuracy/ladder.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "capi/grid_handle.h"
#include "capi/guarded.h"
#include "grid/plan/grid_ladder.h"

struct stormcellar_ladder {
    stormcellar::accuracy::ValueUnit unit = stormcellar::accuracy::ValueUnit::db;
    std::vector<stormcellar::accuracy::LadderRow> rows;
};

namespace stormcellar::capi {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

Result<grid::LadderOptions> ladder_options(const stormcellar_ladder_options* options,
                                           const stormcellar_grid_options& gridding) {
    const auto all = take(options);
    if (!all) return pass_on(all);
    if (all->columns < 0 || all->rounds < 0)
        return fail(ErrorCode::bad_argument, "columns and rounds must be at least 0");
    grid::LadderOptions ladder;
    if (all->columns > 0) ladder.columns = static_cast<std::size_t>(all->columns);
    if (all->rounds > 0) ladder.rounds = all->rounds;
    if (gridding.average_in_z != 0) ladder.averaging = grid::Averaging::in_z;
    return ladder;
}

Status measure(const stormcellar_volume* volume, const stormcellar_grid_options* options,
               const stormcellar_ladder_options* ladder_settings, stormcellar_ladder** ladder,
               std::size_t* count) {
    if (volume == nullptr || ladder == nullptr || count == nullptr)
        return is_null(volume == nullptr ? "volume" : ladder == nullptr ? "ladder" : "count");
    *ladder = nullptr;
    const auto all = take(options);
    if (!all) return pass_on(all);
    const auto gridding = gridding_of(*all, *volume);
    if (!gridding) return pass_on(gridding);
    const auto settings = ladder_options(ladder_settings, *all);
    if (!settings) return pass_on(settings);
    grid::SceneOptions scene_options;
    scene_options.moment = gridding->gridder.moment;
    scene_options.threads = gridding->gridder.threads;
    auto scene =
        grid::GridScene::make(volume->source.volume, gridding->site, gridding->spec, scene_options);
    if (!scene) return pass_on(scene);
    auto rows = grid::run_ladder(*scene, *settings);
    if (!rows) return pass_on(rows);
    *count = rows->size();
    *ladder =
        new stormcellar_ladder{grid::value_unit_of(gridding->gridder.moment), std::move(*rows)};
    return {};
}

Status describe_rung(const stormcellar_ladder* ladder, std::size_t index, stormcellar_rung* to) {
    if (ladder == nullptr) return is_null("ladder");
    if (index >= ladder->rows.size())
        return fail(ErrorCode::bad_argument, "there is no rung {}; there are {}", index,
                    ladder->rows.size());
    const accuracy::LadderRow& row = ladder->rows[index];
    const auto value = [&](double accuracy::ErrorSummary::*figure) {
        return row.value ? (*row.value).*figure : unknown;
    };
    stormcellar_rung rung{};
    rung.step = row.step.c_str();
    rung.name = row.name.c_str();
    copy_text(accuracy::name_of(ladder->unit), rung.value_unit, sizeof rung.value_unit);
    rung.rung = static_cast<std::int32_t>(row.rung);
    rung.pareto = row.pareto ? 1 : 0;
    rung.time_s = row.time_s;
    rung.kept_time_s = row.kept_time_s.value_or(unknown);
    rung.position_max_m = row.position_max_m.value_or(unknown);
    rung.position_rms_m = row.position_rms_m.value_or(unknown);
    rung.value_rms = value(&accuracy::ErrorSummary::rms);
    rung.value_p95 = value(&accuracy::ErrorSummary::p95);
    rung.value_p99 = value(&accuracy::ErrorSummary::p99);
    rung.value_max = value(&accuracy::ErrorSummary::max);
    rung.status_disagreement = row.status ? row.status->share() : unknown;
    return give(rung, to);
}

}  // namespace
}  // namespace stormcellar::capi

using namespace stormcellar;

stormcellar_code stormcellar_ladder_measure(const stormcellar_volume* volume,
                                            const stormcellar_grid_options* options,
                                            const stormcellar_ladder_options* ladder_options,
                                            stormcellar_ladder** ladder, size_t* count,
                                            stormcellar_error* error) {
    return capi::guarded(
        error, [&] { return capi::measure(volume, options, ladder_options, ladder, count); });
}

void stormcellar_ladder_free(stormcellar_ladder* ladder) {
    delete ladder;
}

stormcellar_code stormcellar_ladder_describe(const stormcellar_ladder* ladder, size_t index,
                                             stormcellar_rung* rung, stormcellar_error* error) {
    return capi::guarded(error, [&] { return capi::describe_rung(ladder, index, rung); });
}
