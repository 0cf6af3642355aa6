// tests/web/setup_below.h -- a data server over the drop, catalog and cache of one directory, on a
// free port of the loopback.
#pragma once

#include <filesystem>

#include "web/config/web_setup.h"

namespace stormcellar::web {

[[nodiscard]] inline WebSetup setup_below(const std::filesystem::path& directory) {
    WebSetup setup;
    setup.drop = directory / "drop";
    setup.state = directory;
    setup.catalog = directory / "catalog";
    setup.cache = directory / "cache";
    setup.web.listen = {{"127.0.0.1", 0}};
    return setup;
}

}  // namespace stormcellar::web
