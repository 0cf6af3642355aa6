// cli/shared/follow.h -- `--follow`: a loop that is made again whenever its grids come or go.
//
// The directories of the domain in the cache are looked at five times a second (a few stat() calls;
// their times change with every grid that comes, goes or is replaced, on network file systems too).
// After a change it waits until a quarter of a second has brought no other one, three seconds at
// most; then the grids are listed again, and the loop is made when they are others than those that
// it was last made of.
// Thread contract: one thread; see cli/shared/interrupt.h for the flag.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include <sys/types.h>

#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"

namespace CLI {
class App;
}

namespace stormcellar::cli {

struct FollowOptions {
    bool wanted = false;
    pid_t parent = 0;  // whose end ends it; 0: nobody's
};
void add_follow_options(CLI::App& app, FollowOptions& options);

struct Following {
    std::filesystem::path cache;
    std::string domain;
    level2::Moment moment = level2::Moment::ref;
    // The grids that the loop is to be made of now: relative times count from the call.
    std::function<Result<std::vector<cache::StoreEntry>>()> find;
    // Makes it; says what went wrong and gives the exit status.
    std::function<int(const std::vector<cache::StoreEntry>&)> make;
    bool quiet = false;
};

// Until the flag is set, which is exit_done. What cannot be listed or made is said once and tried
// again with the next change. Without a grid, or the cache, it waits. Ends with another status only
// where, before a loop was made, what was asked for turns out to make no sense (exit_bad_usage).
int follow(const Following& following, const FollowOptions& options, const std::atomic<bool>& stop);

// The document on one line of stdout, at once.
void print_json_line(const nlohmann::json& document);

}  // namespace stormcellar::cli
