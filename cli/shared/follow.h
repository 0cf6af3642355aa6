// cli/shared/follow.h -- `--follow`: makes a loop again whenever its grids change.
//
// The program looks at the directories of the domain in the cache five times a second. A look takes
// a few stat() calls, because the time of a directory changes with every grid that is added,
// removed or replaced, also on network file systems. After a change, the program waits until
// nothing has changed for a quarter of a second, but at most three seconds. Then it lists the grids
// again and makes the loop if the grids differ from the last loop's.
//
// Threads   One thread at a time; see cli/shared/interrupt.h for the flag.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include <sys/types.h>

#include "cli/shared/commands.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::cli {

struct FollowOptions {
    bool wanted = false;
    pid_t parent = 0;  // process number; this process ends when that one ends; 0: none
};
void add_follow_options(CLI::App& app, FollowOptions& options);

struct Following {
    std::filesystem::path cache;
    std::string domain;
    level2::Moment moment = level2::Moment::ref;
    // Returns the grids that the loop has now. Relative times such as "1h ago" count from the call.
    std::function<Result<std::vector<cache::StoreEntry>>()> find;
    // Makes the loop, reports errors, and returns the exit status.
    std::function<int(const std::vector<cache::StoreEntry>&)> make;
    bool quiet = false;
};

// Makes loops until the flag is set, and then returns exit_done. Waits while there is no grid or no
// cache. If listing the grids or making the loop fails, reports it once and tries again after the
// next change. Returns exit_bad_usage if the request turns out to be invalid before the first loop
// was made.
int follow(const Following& following, const FollowOptions& options, const std::atomic<bool>& stop);

// Prints the document on one line of stdout and flushes it.
void print_json_line(const nlohmann::json& document);

}  // namespace stormcellar::cli
