#include "catalog/path_homes.h"

#include "stormcellar/base/station_table.h"

namespace stormcellar::catalog {

std::string_view guessed_home(std::string_view path, const StationRule* rule) {
    for (int level = 0; level < 3; ++level) {
        const std::size_t slash = path.rfind('/');
        std::string_view name = slash == std::string_view::npos ? path : path.substr(slash + 1);
        if (level == 0) name = name.substr(0, 4);
        if (is_icao(name) && (rule == nullptr || rule->knows(name))) return name;
        if (slash == std::string_view::npos) break;
        path = path.substr(0, slash);
    }
    return unknown_station;
}

}  // namespace stormcellar::catalog
