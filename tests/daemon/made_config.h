// tests/daemon/made_config.h -- a configuration with the directories of a test.
#pragma once

#include <filesystem>

#include "daemon/config/config.h"

namespace stormcellar::daemon {

// Makes root/drop, root/state and root/cache.
[[nodiscard]] inline Config config_in(const std::filesystem::path& root) {
    Config config;
    config.fixed.paths = {root / "drop", root / "state", root / "cache"};
    for (const char* name : {"drop", "state", "cache"})
        std::filesystem::create_directories(root / name);
    return config;
}

}  // namespace stormcellar::daemon
