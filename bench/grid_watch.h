// bench/grid_watch.h -- hears of each grid of a station that appears in a cache (inotify).
//
// Threads: one.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::bench {

class GridWatch {
  public:
    GridWatch() = default;
    GridWatch(const GridWatch&) = delete;
    GridWatch& operator=(const GridWatch&) = delete;
    ~GridWatch();

    // Makes and watches CACHE/STATION/REF/DAY for each of the two, so that no grid is missed.
    [[nodiscard]] Status watch(const std::filesystem::path& cache,
                               std::span<const std::string> stations,
                               std::span<const std::string> days);
    // Gives the names of the files that appeared under their final names since the last call.
    void read(const std::function<void(std::string_view)>& appeared) const;
    // Until something appears, at most so long.
    void wait(double seconds) const;

  private:
    int descriptor_ = -1;
};

}  // namespace stormcellar::bench
