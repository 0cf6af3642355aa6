// web/data/grids/grids.h -- lists the grids of the cache and opens them.
//
// The names in the cache are listed once, and updated when the cache changes
// (web/data/grids/cache_watch.h). So a request reads no directory. Opened grids are kept, at most
// `most_open`; the least recently used is closed first. If a grid is evicted while it is open, its
// holder can still read it.
//
// Threads   Many threads may use it.
// Errors    See each function.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"
#include "web/data/grids/cache_watch.h"

namespace stormcellar::web {

struct GridsOptions {
    std::filesystem::path cache;
    std::size_t most_open = 64;
    // Limit of the memory that open grids hold for tables, states, and codes if these are packed.
    // The grid that was used last is kept even if it is larger.
    std::uint64_t most_open_bytes = std::uint64_t{256} << 20;
};

// An open grid. If the cache's grid of this name is made again, the new grid has another `id`.
struct OpenGrid {
    cache::GridFile file;
    std::string domain;
    level2::Moment moment;
    UtcTime time;
    std::string id;  // hash of its bytes, for ETags and keys; letters and digits

    // Returns true if the grid may be made again, because its volume is growing or incomplete, or
    // because it is a mosaic that may get later volumes.
    [[nodiscard]] bool may_change() const {
        const grid::Provenance& from = file.description().provenance;
        return from.partial || from.provisional;
    }
};

// Returns the newest time. `times` must be ascending and not empty. A time in the future (by
// is_believed()) is from a wrong clock, so it counts only if all times are in the future.
[[nodiscard]] UtcTime newest_believed(std::span<const UtcTime> times);

class Grids {
  public:
    // If the cache does not exist (yet), it has no grids; that is no error.
    static Result<std::shared_ptr<Grids>> open(GridsOptions options);
    ~Grids();

    [[nodiscard]] std::vector<std::string> domains() const;  // sorted
    [[nodiscard]] std::vector<level2::Moment> moments(std::string_view domain) const;
    // Returns the times from `from` to `to`, both included, in ascending order.
    [[nodiscard]] std::vector<UtcTime> times(std::string_view domain, level2::Moment moment,
                                             std::optional<UtcTime> from = {},
                                             std::optional<UtcTime> to = {}) const;
    // Returns the newest time by newest_believed(), or none if there is no grid.
    [[nodiscard]] std::optional<UtcTime> newest(std::string_view domain,
                                                level2::Moment moment) const;
    // Returns the grid. Errors: not_found; those of GridFile::open().
    [[nodiscard]] Result<std::shared_ptr<const OpenGrid>> find(std::string_view domain,
                                                               level2::Moment moment, UtcTime time);
    // Returns the grid if it is open and its file has not been replaced; else null. Takes
    // microseconds.
    [[nodiscard]] std::shared_ptr<const OpenGrid> find_if_open(std::string_view domain,
                                                               level2::Moment moment, UtcTime time);
    // Returns true if a grid of this name was listed since the start and is gone now, so that the
    // answer is 410 instead of 404. Only the newest 65,536 evictions are remembered.
    [[nodiscard]] bool was_evicted(std::string_view domain, level2::Moment moment,
                                   UtcTime time) const;
    // Returns the number of changes: grids that came, changed or went, and times when events were
    // lost.
    [[nodiscard]] std::uint64_t changes() const;
    // Returns the number of changes in a group, which is a domain with its parts
    // (stormcellar/cache/grid_name.h).
    [[nodiscard]] std::uint64_t changes_of(std::string_view group) const;
    // Reads the cache again.
    void refresh();
    // Calls the function for each change from now on, after updating the lists. One thread at a
    // time calls it. It must be quick, and must not ask for grids.
    void listen(std::function<void(const CacheChange&)> listener);
    // Returns a sentence that says why changes are noticed late. Returns none if they are noticed
    // at once.
    [[nodiscard]] std::optional<std::string> problem() const;
    [[nodiscard]] const std::filesystem::path& cache() const;

  private:
    struct Impl;
    explicit Grids(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace stormcellar::web
