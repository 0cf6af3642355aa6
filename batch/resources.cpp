#include "batch/resources.h"

#include <algorithm>

#include "batch/source.h"
#include "grid/cells/grid_tally.h"
#include "pipeline/care/archive_fill.h"
#include "pipeline/options/ingest_options.h"
#include "stormcellar/grid/grid_window.h"

namespace stormcellar::batch {
namespace {

constexpr std::uint64_t mib = std::uint64_t{1} << 20;
constexpr std::uint64_t program_bytes = 200 * mib;  // code, tables and geometries
// A grid takes this much per cell while it is dense (before it is stored as bricks): a float and a
// state.
constexpr std::uint64_t bytes_a_cell = 10;
constexpr std::uint64_t frame_worker_bytes = 400 * mib;
constexpr std::uint64_t catalog_bytes = 64 * mib;
// Factor for slow disks, slow processors, and machines that others use, too.
constexpr double margin = 4;
constexpr double start_s = 300;

std::uint64_t cells_of(const Recipe& recipe) {
    if (!recipe.domain) {
        const std::size_t levels = recipe.levels_m.empty()
                                       ? grid::default_spec(0, 0).levels_m.size()
                                       : recipe.levels_m.size();
        return static_cast<std::uint64_t>(recipe.nx) * static_cast<std::uint64_t>(recipe.ny) *
               levels;
    }
    // Assume the largest window that a site can have.
    const grid::GridSpec& spec = recipe.domain->spec;
    const auto along = [](int cells, double cell_m) {
        return std::min<double>(cells, 2 * grid::site_reach_m / cell_m + 1);
    };
    return static_cast<std::uint64_t>(along(spec.nx, spec.cell_width_m()) *
                                      along(spec.ny, spec.cell_height_m())) *
           spec.levels_m.size();
}

}  // namespace

double Resources::seconds_of(std::size_t tasks) const {
    return start_s + seconds_a_task * static_cast<double>(tasks);
}

Resources resources_of_grids(const Plan& plan, int threads) {
    const Recipe& recipe = plan.recipe();
    Resources needed;
    const auto decoded = pipeline::decoded_for(recipe.moments, recipe.derived.quality);
    needed.memory_bytes = program_bytes + pipeline::most_array_bytes(decoded) +
                          pipeline::most_unpacked_bytes + cells_of(recipe) * bytes_a_cell;
    const bool is_bucket = is_address(recipe.source);
    needed.scratch_bytes =
        catalog_bytes + (is_bucket ? 2 * bytes_of_unlisted_day : plan.facts().largest);
    needed.seconds_a_task = margin * plan.facts().largest_cost_s / std::max(1, threads);
    return needed;
}

Resources resources_of_frames(const Plan& plan, int threads) {
    const Recipe& recipe = plan.recipe();
    Resources needed;
    if (!recipe.domain) return needed;
    const auto workers = static_cast<std::uint64_t>(std::clamp(threads, 1, pipeline::most_workers));
    needed.memory_bytes =
        program_bytes +
        workers * (frame_worker_bytes + recipe.domain->spec.cell_count() * bytes_a_cell);
    needed.scratch_bytes = catalog_bytes;
    needed.seconds_a_task = margin * plan.facts().largest_cost_s / std::max(1, threads);
    return needed;
}

std::uint64_t bytes_of_counts(const Plan& plan) {
    const Recipe& recipe = plan.recipe();
    if (!recipe.statistics) return 0;
    return grid::GridTally::bytes_of(recipe.domain->spec, *recipe.statistics) *
           plan.facts().statistics_tasks;
}

Resources resources_of_statistics(const Plan& plan) {
    Resources needed;
    if (!plan.recipe().statistics) return needed;
    // Memory holds the counts, the same counts as bytes to write, and the compressed bytes.
    const std::uint64_t counts =
        grid::GridTally::bytes_of(plan.recipe().domain->spec, *plan.recipe().statistics);
    needed.memory_bytes = program_bytes + 3 * counts;
    needed.seconds_a_task = margin * plan.facts().largest_cost_s;
    return needed;
}

}  // namespace stormcellar::batch
