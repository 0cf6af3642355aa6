// bench/grid_watch.h -- reports each grid of a station that appears in a cache (inotify).
//
// Threads   One thread at a time.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/moment.h"

namespace stormcellar::bench {

class GridWatch {
  public:
    GridWatch() = default;
    GridWatch(const GridWatch&) = delete;
    GridWatch& operator=(const GridWatch&) = delete;
    ~GridWatch();

    // Makes and watches CACHE/STATION/MOMENT/DAY for each station and day, so that no grid is
    // missed.
    [[nodiscard]] Status watch(const std::filesystem::path& cache,
                               std::span<const std::string> stations,
                               std::span<const std::string> days,
                               level2::Moment moment = level2::Moment::ref);
    // Calls `appeared` with the name of each file that was renamed into place since the last call.
    void read(const std::function<void(std::string_view)>& appeared) const;
    // Waits at most `seconds` until a file appears.
    void wait(double seconds) const;

  private:
    int descriptor_ = -1;
};

}  // namespace stormcellar::bench
