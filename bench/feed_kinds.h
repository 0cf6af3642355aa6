// bench/feed_kinds.h -- what the sites of bench/mosaic_feed.h send: real and simulated volumes.
//
// Threads: pure functions.
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
    std::vector<std::string> files;  // one behind the other; empty: the simulated storms
    std::chrono::minutes interval{10};

    [[nodiscard]] int volumes_an_hour() const {
        return static_cast<int>(std::chrono::minutes{60} / interval);
    }
    // Which volume is sent as number `slot` of an hour: a name of its own for each.
    [[nodiscard]] std::string volume_at(int slot) const;
};

// Sites take them in turn.
[[nodiscard]] std::span<const FeedKind> feed_kinds();

// The volume of that name, before it is re-stamped.
[[nodiscard]] Result<level2::Volume> feed_volume(const std::string& name,
                                                 const std::filesystem::path& data);

}  // namespace stormcellar::bench
