// web/data/grids/cache_watch.h -- watches the grids of a cache.
//
// The watch reads the directories of the cache once, and then follows them by inotify. It reports
// each grid that exists at the start as having come. A change is reported by the watch's own thread
// or by a caller of catch_up(), whichever sees it first. Changes are reported in their order. If
// the cache does not exist (yet) or vanishes, the watch looks for it once a second. The kernel does
// not report all changes if no inotify watch is left, or if another machine writes. So the watch
// also compares the times of directories: once a minute, or every 2 seconds if it could not watch
// all directories. In this comparison it may report an unchanged grid as changed.
//
// Threads   Many threads may use it. One thread at a time calls the listener, under a lock, so the
//           listener must be quick and must not call the watch.
// Errors    None are returned; see problem().
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
    // The kernel lost events, so any grid may have changed. `came` and `went` are still reported.
    everything,
};

struct CacheChange {
    CacheEvent event = CacheEvent::came;
    cache::GridName grid;  // meaningless for `everything`
};

class CacheWatch {
  public:
    using Listener = std::function<void(const CacheChange&)>;

    // Reads and watches the cache. The listener hears of every existing grid before this returns.
    static std::unique_ptr<CacheWatch> open(std::filesystem::path cache, Listener listener);
    CacheWatch(const CacheWatch&) = delete;
    CacheWatch& operator=(const CacheWatch&) = delete;
    ~CacheWatch();

    // Reports all changes that inotify noticed before the call: removals, and renames into a
    // watched directory. Without changes, this takes only one system call.
    void catch_up();
    // Reads the directories whose times have changed, even if no event reported a change.
    void rescan();
    // Returns a sentence that says why some changes are reported late. Returns none if all are
    // reported at once.
    [[nodiscard]] std::optional<std::string> problem() const;

  private:
    struct Impl;
    explicit CacheWatch(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace stormcellar::web
