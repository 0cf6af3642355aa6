// web/data/grids/cache_watch.h -- which grids a cache has, and what happens to them.
//
// The directories of the cache are read once and then watched (inotify). Each grid that is there
// when the watch begins is told as having come. What happened is told in its order, by the thread
// that notices it: one of the watch's own, or whoever calls catch_up(). A cache that is not there
// (yet), or that vanishes, is looked for once a second. Where the kernel reports nothing (no watch
// is left, or another machine writes), the directories' times are compared once a minute, and every
// 2 seconds if not all of them could be watched; a grid may then be told as changed though it was
// not.
//
// Threads   Many threads may use it. The listener is called by one thread at a time, under a lock:
//           it must be quick and must not call the watch.
// Errors    None are returned: see problem().
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/grid_name.h"

namespace stormcellar::web {

enum class CacheEvent {
    came,
    changed,  // the grid was made again
    went,
    everything,  // the kernel lost events: any grid may have changed; what came and went is told
};

struct CacheChange {
    CacheEvent event = CacheEvent::came;
    cache::GridName grid;  // without meaning for `everything`
};

class CacheWatch {
  public:
    using Listener = std::function<void(const CacheChange&)>;

    // Reads and watches the cache; the listener hears of every grid before this returns.
    static std::unique_ptr<CacheWatch> open(std::filesystem::path cache, Listener listener);
    CacheWatch(const CacheWatch&) = delete;
    CacheWatch& operator=(const CacheWatch&) = delete;
    ~CacheWatch();

    // Tells what happened until now. It costs one system call if nothing did. Whatever was renamed
    // into the cache, or removed, before the call is told before it returns.
    void catch_up();
    // Reads the directories whose times changed, events or not.
    void rescan();
    void rescan(const std::string& domain);
    // Why not all changes are told at once, in a sentence; none if they are.
    [[nodiscard]] std::optional<std::string> problem() const;

  private:
    struct Impl;
    explicit CacheWatch(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace stormcellar::web
