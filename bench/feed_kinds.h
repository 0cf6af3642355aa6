// bench/feed_kinds.h -- the real and simulated volumes that the sites of bench/mosaic_feed.h send.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <chrono>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::bench {

struct FeedKind {
    std::vector<std::string> files;  // sent in turn; empty: the simulated storms
    std::chrono::minutes interval{10};

    [[nodiscard]] int volumes_an_hour() const {
        return static_cast<int>(std::chrono::minutes{60} / interval);
    }
    // Returns the name of the volume that is sent as number `slot` of an hour.
    [[nodiscard]] std::string volume_at(int slot) const;
};

// Sites take them in turn.
[[nodiscard]] std::span<const FeedKind> feed_kinds();

// Returns the volume of that name, before it is re-stamped.
[[nodiscard]] Result<level2::Volume> feed_volume(const std::string& name,
                                                 const std::filesystem::path& data);

}  // namespace stormcellar::bench
