#include "stormcellar/retrieve/storm_cells.h"

#include <array>
#include <cmath>
#include <utility>

#include "grid/mosaic/motion.h"
#include "retrieve/cells/cell_columns.h"
#include "retrieve/cells/cell_shapes.h"

namespace stormcellar::retrieve {
namespace {

Status validate_cells(const CellFields& fields, const CellOptions& options) {
    if (fields.reflectivity.spec == nullptr)
        return fail(ErrorCode::bad_argument, "storm cells need a grid of reflectivity");
    if (Status valid = grid::validate(*fields.reflectivity.spec); !valid) return valid;
    if (fields.reflectivity.sweep != nullptr)
        return fail(ErrorCode::bad_argument, "storm cells need a grid, not a sweep");
    if (fields.azimuthal_shear && (fields.azimuthal_shear->spec == nullptr ||
                                   *fields.azimuthal_shear->spec != *fields.reflectivity.spec))
        return fail(ErrorCode::bad_argument,
                    "the grids of reflectivity and azimuthal shear differ in their geometry");
    for (const double number :
         {static_cast<double>(options.least_dbz), static_cast<double>(options.prominence_db),
          static_cast<double>(options.least_peak_dbz), static_cast<double>(options.top_dbz),
          options.separation_m, options.least_area_km2, options.least_depth_m}) {
        if (!(number >= 0 && number <= 1e6))
            return fail(ErrorCode::bad_argument, "the options of storm cells must be 0 or more");
    }
    return {};
}

FloodRules flood_rules(const grid::GridSpec& spec, const CellOptions& options) {
    const double column_km2 = spec.cell_width_m() * spec.cell_height_m() * 1e-6;
    return {.prominence_db = options.prominence_db,
            .separation_m = options.separation_m,
            .least_cells =
                static_cast<int>(std::min(std::ceil(options.least_area_km2 / column_km2), 1e6)),
            .cell_width_m = spec.cell_width_m(),
            .cell_height_m = spec.cell_height_m()};
}

}  // namespace

Result<CellScan> find_cells(const CellFields& fields, UtcTime time, std::string area,
                            const CellOptions& options) {
    if (Status valid = validate_cells(fields, options); !valid)
        return tl::unexpected(std::move(valid).error());
    const grid::BrickView& view = fields.reflectivity;
    std::optional<HailLayers> hail;
    if (fields.freezing && view.spec->nz() > 1) {
        auto layers = hail_layers(view.spec->levels_m, *fields.freezing, 0);
        if (!layers) return pass_on(layers);
        hail = std::move(*layers);
    }
    CellScan scan{time, std::move(area), *view.spec, {}, {}};
    if (hail) scan.freezing = fields.freezing;
    const StrongEcho echo(view, options.least_dbz);
    if (echo.cells().empty()) return scan;
    const FloodedEcho flooded = flood_peaks(echo, flood_rules(*view.spec, options));
    scan.cells = shape_cells(view, echo, flooded, options);
    ColumnMeter meter(fields, std::move(hail), options.top_dbz);
    for (StormCell& cell : scan.cells)
        meter.measure(cell);
    return scan;
}

Status guess_motions(CellScan& scan, const grid::BrickView& before, const grid::BrickView& after,
                     double seconds) {
    if (before.spec == nullptr || after.spec == nullptr || scan.spec != *after.spec)
        return fail(ErrorCode::bad_argument, "the cells are not of the later grid");
    const bool is_one_grid = *before.spec == *after.spec;
    if (scan.cells.empty() && is_one_grid && seconds > 0) return {};  // no motion is needed
    const auto field = grid::estimate_motion(before, after, seconds);
    if (!field) return tl::unexpected(field.error());
    if (!*field) return {};
    const grid::GridProjection projection(scan.spec);
    for (StormCell& cell : scan.cells) {
        const grid::ColumnPoint at = projection.to_column(cell.position);
        const grid::CellMotion moved = (*field)->at(at.x, at.y);
        const grid::GeoPoint from =
            projection.to_geo({at.x - moved.x * seconds, at.y - moved.y * seconds});
        const auto way = grid::SiteFrame::to_plane(
            grid::SiteFrame(from.latitude_deg, from.longitude_deg).to_polar(cell.position));
        cell.echo_motion = Motion{way.x_m / seconds, way.y_m / seconds};
    }
    return {};
}

std::string_view cell_origin_name(CellOrigin origin) {
    constexpr std::array<std::string_view, 4> names = {"new", "continued", "split", "merged"};
    return names[static_cast<std::size_t>(origin)];
}

}  // namespace stormcellar::retrieve
