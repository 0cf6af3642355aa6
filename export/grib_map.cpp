// Checks a map, and hands it to the module that writes GRIB2, stormcellar_grib.so. The module is
// loaded when it is first needed: ecCodes would slow down the start of every program.
#include "export/grib_map.h"

#if STORMCELLAR_GRIB
#include "base/load_module.h"
#endif

namespace stormcellar::grib {
namespace {

Status check(const Map& map) {
    if (auto valid = grid::validate(map.spec); !valid) return pass_on(valid);
    const std::size_t columns = map.spec.column_count();
    if (map.values.size() != columns || map.states.size() != columns) {
        return fail(ErrorCode::bad_argument, "the map has {} values and {} states for {} columns",
                    map.values.size(), map.states.size(), columns);
    }
    if (map.spec.projection == grid::Projection::azimuthal_equidistant) {
        return fail(ErrorCode::unsupported,
                    "GRIB2 cannot place a grid in {}; make the grid with --projection {} or {}",
                    grid::projection_name(map.spec.projection),
                    grid::projection_name(grid::Projection::latitude_longitude),
                    grid::projection_name(grid::Projection::lambert_conformal));
    }
    return {};
}

}  // namespace

Result<std::vector<std::byte>> map_bytes(const Map& map) {
    if (Status good = check(map); !good) return pass_on(good);
#if STORMCELLAR_GRIB
    static const Result<void*> entry = load_module(module_file, module_entry, "export");
    if (!entry) {
        return fail(entry.error().code, "the module that writes GRIB2 cannot be loaded: {}",
                    entry.error().message);
    }
    Result<std::vector<std::byte>> bytes;
    reinterpret_cast<MapEntry> (*entry)(map, bytes);
    return bytes;
#else
    return fail(ErrorCode::unsupported,
                "this build has no ecCodes (STORMCELLAR_GRIB), so it writes no GRIB2");
#endif
}

}  // namespace stormcellar::grib
