// web/data/grids/cache_watch.h -- watches the grids of a cache.
//
// The watch reads the directories of the cache once and then follows them by inotify. It reports
// each grid that exists at the start as having come. The watch's own thread or a caller of
// catch_up(), whichever notices a change first, reports the change. Changes are reported in their
// order. If the cache does not exist (yet) or vanishes, the watch looks for it once a second. The
// kernel may not report all changes, because no inotify watch is left or another machine writes. So
// the watch also compares the times of directories, once a minute, or every 2 seconds if it could
// not watch all directories. By this comparison the watch may report an unchanged grid as changed.
//
// Threads   Many threads may use it. One thread at a time calls the listener, under a lock: it must
//           be quick and must not call the watch.
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
    everything,  // the kernel lost events: any grid may have changed; came and went are still
                 // reported
};

struct CacheChange {
    CacheEvent event = CacheEvent::came;
    cache::GridName grid;  // meaningless for `everything`
};

class CacheWatch {
  public:
    using Listener = std::function<void(const CacheChange&)>;

    // Reads and watches the cache; the listener hears of every grid before this returns.
    static std::unique_ptr<CacheWatch> open(std::filesystem::path cache, Listener listener);
    CacheWatch(const CacheWatch&) = delete;
    CacheWatch& operator=(const CacheWatch&) = delete;
    ~CacheWatch();

    // Reports all changes that inotify has noticed: each rename into a watched directory and each
    // removal before the call. Costs one system call if there is none.
    void catch_up();
    // Reads the directories whose times changed, even without events.
    void rescan();
    // Returns a sentence that says why some changes are reported late; none if all are reported at
    // once.
    [[nodiscard]] std::optional<std::string> problem() const;

  private:
    struct Impl;
    explicit CacheWatch(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace stormcellar::web
