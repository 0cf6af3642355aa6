#include "grid/judge/site_pairs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/grid_sampler.h"

namespace stormcellar::grid {
namespace {

constexpr double block_m = 24e3;

// Pairs cells of A with places in B.
class Matcher {
  public:
    Matcher(const SiteGrid& a, const SiteGrid& b, const ComparisonOptions& options)
        : a_(a),
          b_(b),
          options_(options),
          cells_(a.view),
          a_plane_(*a.view.spec),
          b_plane_(*b.view.spec),
          a_frame_(a.site.latitude_deg, a.site.longitude_deg),
          b_frame_(b.site.latitude_deg, b.site.longitude_deg),
          beam_(b.site.latitude_deg, b.site.altitude_m) {}

    [[nodiscard]] std::vector<SitePair> pairs() {
        const GridSpec& spec = *a_.view.spec;
        const std::vector<ColumnPoint> columns = busy_columns();
        const auto most = static_cast<std::size_t>(options_.most_columns);
        // An odd step visits columns in all rows of a brick.
        const std::size_t step = ((columns.size() + most - 1) / most) | 1U;
        std::vector<SitePair> found;
        for (std::size_t i = 0; i < columns.size(); i += step)
            add_column(spec, columns[i], found);
        return found;
    }

  private:
    // Returns the columns of A whose bricks hold values and that are near enough to both sites,
    // brick by brick.
    [[nodiscard]] std::vector<ColumnPoint> busy_columns() const {
        std::vector<ColumnPoint> found;
        for (int bx = 0; bx < a_.view.bricks_x; ++bx) {
            for (int by = 0; by < a_.view.bricks_y; ++by) {
                if (!is_busy(bx, by)) continue;
                const int end_x = std::min((bx + 1) * brick_edge, a_.view.spec->nx);
                const int end_y = std::min((by + 1) * brick_edge, a_.view.spec->ny);
                for (int ix = bx * brick_edge; ix < end_x; ++ix) {
                    for (int iy = by * brick_edge; iy < end_y; ++iy)
                        found.push_back({static_cast<double>(ix), static_cast<double>(iy)});
                }
            }
        }
        return found;
    }
    [[nodiscard]] bool is_busy(int bx, int by) const {
        bool holds_values = false;
        for (int bz = 0; bz < a_.view.bricks_z; ++bz) {
            const BrickEntry& brick = a_.view.bricks[a_.view.brick_index(bx, by, bz)];
            holds_values = holds_values || brick.kind == BrickKind::stored;
        }
        if (!holds_values) return false;
        constexpr double half = brick_edge / 2.0;
        const GeoPoint middle = a_plane_.to_geo({bx * brick_edge + half, by * brick_edge + half});
        const double reach_m =
            options_.greatest_range_m +
            half * std::hypot(a_.view.spec->cell_width_m(), a_.view.spec->cell_height_m());
        return a_frame_.to_polar(middle).arc_m < reach_m &&
               b_frame_.to_polar(middle).arc_m < reach_m;
    }

    void add_column(const GridSpec& spec, ColumnPoint column, std::vector<SitePair>& found) {
        const GeoPoint place = a_plane_.to_geo(column);
        const PolarPoint from_b = b_frame_.to_polar(place);
        const auto is_compared = [&](double arc_m) {
            return arc_m >= options_.least_range_m && arc_m <= options_.greatest_range_m;
        };
        if (!is_compared(from_b.arc_m) || !is_compared(a_frame_.to_polar(place).arc_m)) return;
        SitePair pair;
        pair.column = b_plane_.to_column(place);
        pair.block = block_of(spec, column);
        // Compute the shifts for one degree about B and for one meter away from B. Differences over
        // a tenth of a degree and over 100 m give these shifts.
        const ColumnPoint turned =
            b_plane_.to_column(b_frame_.to_geo({from_b.azimuth_deg + 0.1, from_b.arc_m}));
        const ColumnPoint farther =
            b_plane_.to_column(b_frame_.to_geo({from_b.azimuth_deg, from_b.arc_m + 100}));
        pair.by_azimuth = {(turned.x - pair.column.x) * 10, (turned.y - pair.column.y) * 10, 0};
        const SiteShift away = {(farther.x - pair.column.x) / 100,
                                (farther.y - pair.column.y) / 100, 0};
        if (options_.motion) {
            pair.by_time = {options_.motion->east_mps / b_.view.spec->cell_width_m(),
                            options_.motion->north_mps / b_.view.spec->cell_height_m(), 0};
        }
        for (int iz = 0; iz < spec.nz(); ++iz)
            add_cell(column, iz, from_b.arc_m, away, pair, found);
    }

    void add_cell(ColumnPoint column, int iz, double arc_m, const SiteShift& away, SitePair pair,
                  std::vector<SitePair>& found) const {
        const auto value = cells_.value(column, iz);
        if (!value) return;
        const auto apart_s = ages_apart_s(column, pair.column, iz);
        if (!apart_s) return;
        pair.a_dbz = static_cast<double>(*value);
        pair.apart_s = *apart_s;
        pair.height_m = a_.view.spec->levels_m[static_cast<std::size_t>(iz)];
        const AntennaPoint gate = beam_.inverse({arc_m, pair.height_m});
        const EarthPoint raised = beam_.forward({gate.range_m, gate.elevation_deg + 0.1});
        const double farther_m = (raised.arc_m - arc_m) * 10;
        pair.by_elevation = {away.x * farther_m, away.y * farther_m,
                             (raised.height_m - pair.height_m) * 10};
        // B saw this echo `apart_s` later than A, so it is farther along the motion.
        pair.column = moved(pair.column, pair.by_time, *apart_s);
        found.push_back(pair);
    }

    // Returns how much later B measured its cell than A did. In a grid without details, all ages
    // are 0. Returns none if either age is unknown.
    [[nodiscard]] std::optional<double> ages_apart_s(ColumnPoint in_a, ColumnPoint in_b,
                                                     int iz) const {
        const double height_m = a_.view.spec->levels_m[static_cast<std::size_t>(iz)];
        const auto a_s = age_s(a_, in_a, height_m);
        const auto b_s = age_s(b_, in_b, height_m);
        if (!a_s || !b_s) return std::nullopt;
        return *b_s - *a_s;
    }
    // Returns the age of the nearest cell, or 0 if the grid has no details.
    static std::optional<double> age_s(const SiteGrid& of, ColumnPoint column, double height_m) {
        if (of.details == nullptr) return 0;
        const GridSpec& spec = *of.view.spec;
        const bool within = column.x > -0.5 && column.x < spec.nx - 0.5 && column.y > -0.5 &&
                            column.y < spec.ny - 0.5;
        if (!within) return std::nullopt;
        const auto above =
            std::lower_bound(spec.levels_m.begin(), spec.levels_m.end(), height_m - 1e-6);
        if (above == spec.levels_m.end()) return std::nullopt;
        auto level = above;
        if (above != spec.levels_m.begin() && height_m - *(above - 1) < *above - height_m) --level;
        const auto age = of.details->at(
            Detail::age, spec.index(static_cast<int>(std::lround(column.x)),
                                    static_cast<int>(std::lround(column.y)),
                                    static_cast<int>(level - spec.levels_m.begin())));
        if (!age) return std::nullopt;
        return static_cast<double>(*age);
    }

    std::uint32_t block_of(const GridSpec& spec, ColumnPoint column) {
        const auto part = [](double columns, double cell_m) {
            return static_cast<int>(std::floor(columns * cell_m / block_m));
        };
        const auto place =
            std::pair(part(column.x, spec.cell_width_m()), part(column.y, spec.cell_height_m()));
        return blocks_.try_emplace(place, static_cast<std::uint32_t>(blocks_.size())).first->second;
    }

    const SiteGrid& a_;
    const SiteGrid& b_;
    const ComparisonOptions& options_;
    GridSampler cells_;
    GridProjection a_plane_, b_plane_;
    SiteFrame a_frame_, b_frame_;
    BeamGeometry beam_;
    std::map<std::pair<int, int>, std::uint32_t> blocks_;
};

}  // namespace

std::vector<SitePair> pairs_of(const SiteGrid& a, const SiteGrid& b,
                               const ComparisonOptions& options) {
    return Matcher(a, b, options).pairs();
}

}  // namespace stormcellar::grid
