#include "web/data/pictures/shown_grid.h"

#include <utility>

#include "stormcellar/cache/store.h"
#include "stormcellar/render/product.h"

namespace stormcellar::web {
namespace {

// A frame of so many cells takes 0.6 GB of memory.
constexpr double most_hail_cells = 64e6;

}  // namespace

Result<ShownGrid> shown_grid(const std::filesystem::path& cache, const OpenGrid& grid,
                             const render::Scene& scene, int threads) {
    const cache::GridDescription& description = grid.file.description();
    const bool is_hail = render::facts_of(scene.product).hail != nullptr;
    if (!is_hail || !pipeline::is_of_several(description)) return ShownGrid(grid);
    const auto store = cache::StoreReader::open(cache);
    if (!store) return pass_on(store);
    auto hail = pipeline::hail_of_frame(
        *store, {grid.domain, scene.freezing_levels, most_hail_cells, threads}, description,
        grid.file.view());
    if (hail) return ShownGrid(grid, std::move(*hail));
    const ErrorCode code = hail.error().code;
    if (code != ErrorCode::not_found && code != ErrorCode::over_budget) return pass_on(hail);
    cache::GridDescription noted = description;
    noted.provenance.notes.push_back(pipeline::merged_reflectivity_note + hail.error().message);
    return ShownGrid(grid, std::move(noted));
}

}  // namespace stormcellar::web
