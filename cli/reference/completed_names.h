// cli/reference/completed_names.h -- names that only the machine knows, for the completions of
// shells: the domains of a cache and the stations of a catalog or a cache.
//
// The scripts call `stormcellar --complete domains|stations WORD...` with the words that were typed
// so far; --help does not show it. The directories are those that --cache and --catalog name among
// these words, else those of the configuration that --config or STORMCELLAR_CONFIG names, else of
// the service's.
//
// Threads   One thread at a time.
// Errors    None: what cannot be read gives no names, since a shell has no place for a message.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stormcellar::cli {

// Sorted, each once. Stations are those of the catalog, else those domains of the cache that are
// stations, else all of the station table.
[[nodiscard]] std::vector<std::string> completed_names(std::string_view kind,
                                                       const std::vector<std::string>& words);

// Prints them, one a line, and returns the exit status.
int print_completions(std::string_view kind, const std::vector<std::string>& words);

}  // namespace stormcellar::cli
