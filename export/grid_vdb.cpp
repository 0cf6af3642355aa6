// Checks grids, and hands them to the module that writes OpenVDB, stormcellar_vdb.so. The module is
// loaded when it is first needed: OpenVDB would slow down the start of every program.
#include "export/grid_vdb.h"

#include <cmath>
#include <vector>

#include "export/grid_fields.h"
#if STORMCELLAR_VDB
#include "base/load_module.h"
#endif

namespace stormcellar::vdb {
namespace {

Status check_levels(const std::vector<double>& levels_m) {
    constexpr double rounding_m = 0.01;
    for (std::size_t at = 2; at < levels_m.size(); ++at) {
        const double step_m = levels_m[1] - levels_m[0];
        if (std::abs(levels_m[at] - levels_m[0] - static_cast<double>(at) * step_m) <= rounding_m)
            continue;
        return fail(ErrorCode::unsupported,
                    "OpenVDB has levels at equal distances only; choose them by --levels-km "
                    "bottom:top:step");
    }
    return {};
}

}  // namespace

Result<std::string> vdb_bytes(std::span<const grid::Grid> grids) {
    if (Status good = netcdf::check_grids(grids); !good) return pass_on(good);
    if (Status good = check_levels(grids.front().spec.levels_m); !good) return pass_on(good);
#if STORMCELLAR_VDB
    static const Result<void*> entry = load_module(module_file, module_entry, "export");
    if (!entry) {
        return fail(entry.error().code, "the module that writes OpenVDB cannot be loaded: {}",
                    entry.error().message);
    }
    Result<std::string> bytes;
    reinterpret_cast<VdbEntry> (*entry)(grids, bytes);
    return bytes;
#else
    return fail(ErrorCode::unsupported,
                "this build has no OpenVDB (STORMCELLAR_VDB), so it writes no .vdb");
#endif
}

Status write_vdb(FileSystem& file_system, const std::filesystem::path& path,
                 std::span<const grid::Grid> grids,
                 const grid_export::GridFormatOptions& /*options*/) {
    const auto bytes = vdb_bytes(grids);
    if (!bytes) return fail(bytes.error().code, "{}: {}", path.native(), bytes.error().message);
    return write_file_atomically(file_system, path, std::as_bytes(std::span(*bytes)));
}

}  // namespace stormcellar::vdb
