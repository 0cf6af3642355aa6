#include "pipeline/mosaic/instant_cache.h"

#include <algorithm>
#include <utility>

namespace stormcellar::pipeline {
namespace {

// Returns the memory that a grid takes. Absent bricks take none.
std::size_t bytes_of(const grid::BrickGrid& made) {
    const grid::BrickView view = made.view();
    const auto stored = std::count_if(
        view.bricks.begin(), view.bricks.end(),
        [](const grid::BrickEntry& one) { return one.kind == grid::BrickKind::stored; });
    return static_cast<std::size_t>(stored) * grid::brick_cells *
               static_cast<std::size_t>(view.quantization.code_bytes) +
           view.bricks.size_bytes() + view.states.size();
}

}  // namespace

std::shared_ptr<const grid::BrickGrid> InstantCache::find(const Key& key) {
    const MutexLock lock(mutex_);
    const auto* found = kept_.find(key);
    return found == nullptr ? nullptr : *found;
}

void InstantCache::keep(const Key& key, std::shared_ptr<const grid::BrickGrid> made) {
    const std::size_t bytes = bytes_of(*made);
    const MutexLock lock(mutex_);
    if (bytes > most_bytes_ || kept_.find(key) != nullptr) return;
    kept_.keep(key, std::move(made), bytes);
}

std::size_t InstantCache::bytes() const {
    const MutexLock lock(mutex_);
    return kept_.weight();
}

}  // namespace stormcellar::pipeline
