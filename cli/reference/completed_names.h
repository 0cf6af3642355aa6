// cli/reference/completed_names.h -- finds the names that a shell offers as completions and that
// depend on the machine: the domains of a cache, and the stations of a catalog or a cache.
//
// The completion scripts call `stormcellar --complete domains|stations WORD...` with the words
// typed so far; --help does not show this option. The directories come from --cache and --catalog
// among these words, else from the configuration of --config or STORMCELLAR_CONFIG, else from the
// service's configuration.
//
// Threads   One thread at a time.
// Errors    None. Unreadable sources give no names, because a completion cannot show a message.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stormcellar::cli {

// Returns the names, sorted, each once. Stations are the stations of the catalog. If there is no
// catalog, they are the domains of the cache that are stations; without a cache, all stations of
// the station table.
[[nodiscard]] std::vector<std::string> completed_names(std::string_view kind,
                                                       const std::vector<std::string>& words);

// Prints the names, one on each line, and returns the exit status.
int print_completions(std::string_view kind, const std::vector<std::string>& words);

}  // namespace stormcellar::cli
