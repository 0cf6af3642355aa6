#include "catalog/path_homes.h"

#include "base/station_table.h"

namespace stormcellar::catalog {

std::string guessed_home(const std::filesystem::path& path) {
    const std::string_view whole = path.native();
    std::string_view rest = whole;
    for (int level = 0; level < 3; ++level) {
        const std::size_t slash = rest.rfind('/');
        std::string_view name = slash == std::string_view::npos ? rest : rest.substr(slash + 1);
        if (level == 0) name = name.substr(0, 4);
        if (is_icao(name)) return std::string{name};
        if (slash == std::string_view::npos) break;
        rest = rest.substr(0, slash);
    }
    return std::string{unknown_station};
}

}  // namespace stormcellar::catalog
