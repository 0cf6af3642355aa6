// cli/query/cache_change.h -- `stormcellar cache evict|pin|unpin`: the commands that change the
// cache.
#pragma once

#include "cli/shared/commands.h"

namespace stormcellar::cli {

// Adds the subcommands to `cache`.
[[nodiscard]] Commands add_cache_changes(CLI::App& cache);

}  // namespace stormcellar::cli
