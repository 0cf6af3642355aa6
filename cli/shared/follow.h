// cli/shared/follow.h -- `--follow`: makes a loop again whenever its grids change.
//
// The directories of the domain in the cache are checked five times a second. A check takes a few
// stat() calls, because the times of directories change with every grid that is added, removed or
// replaced, also on network file systems. After a change, the program waits until nothing has
// changed for a quarter of a second, but at most three seconds. Then it lists the grids again and
// makes the loop if they differ from those of the last loop.
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
    pid_t parent = 0;  // when that process ends, this one ends too; 0: none
};
void add_follow_options(CLI::App& app, FollowOptions& options);

struct Following {
    std::filesystem::path cache;
    std::string domain;
    level2::Moment moment = level2::Moment::ref;
    // Returns the grids for the loop at this moment. Relative times count from the call.
    std::function<Result<std::vector<cache::StoreEntry>>()> find;
    // Makes the loop, reports errors, and returns the exit status.
    std::function<int(const std::vector<cache::StoreEntry>&)> make;
    bool quiet = false;
};

// Runs until the flag is set, and then returns exit_done. Waits while there is no grid or no cache.
// If listing the grids or making the loop fails, reports it once and tries again after the next
// change. Returns exit_bad_usage if the request turns out to be invalid before a first loop was
// made.
int follow(const Following& following, const FollowOptions& options, const std::atomic<bool>& stop);

// Prints the document on one line of stdout and flushes it.
void print_json_line(const nlohmann::json& document);

}  // namespace stormcellar::cli
