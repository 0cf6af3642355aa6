#include "tests/grid/slow_mosaic.h"

#include <algorithm>
#include <cmath>

#include "stormcellar/base/station_table.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::grid {
namespace {

struct Seen {
    CellStatus status;
    long double value;
    long double arc_m;
    long double weight;
    long double limit_dbz;
};

long double limit_dbz(const SitePosition& site, long double arc_m, double level_m) {
    const auto station = find_station(site.icao);
    const bool tdwr = station && station->kind == RadarKind::tdwr;
    const long double up_m = level_m - site.altitude_m;
    const long double range_km = std::max(100.0L, std::hypot(arc_m, up_m)) / 1000;
    return (tdwr ? -46.0L : -41.5L) + 20 * std::log10(range_km);
}

// Mixes states by the rule of docs/geometry.md. No state in `seen` may be not_seen.
void mix(const std::vector<Seen>& seen, const MosaicOptions& options, SlowCell& cell) {
    long double v = 0, n = 0, f = 0, sum = 0, weight = 0;
    const bool in_z = options.averaging == Averaging::in_z;
    const auto linear = [&](long double dbz) { return in_z ? std::pow(10.0L, dbz / 10) : dbz; };
    for (const Seen& site : seen) {
        if (site.status == CellStatus::range_folded) f += site.weight;
        if (site.status == CellStatus::no_echo) n += site.weight;
        if (site.status == CellStatus::value) v += site.weight;
        if (site.status == CellStatus::value) {
            sum += site.weight * linear(site.value);
            weight += site.weight;
        }
        if (site.status == CellStatus::no_echo && options.moment == level2::Moment::ref) {
            sum += site.weight * linear(site.limit_dbz);
            weight += site.weight;
        }
    }
    const auto close = [](long double a, long double b) {
        return a != b && std::abs(a - b) < 1e-5L * std::max(a, b);
    };
    cell.is_close = close(v, n) || close(f, n) || close(f, v);
    if (f > v && f > n) {
        cell.status = CellStatus::range_folded;
    } else if (v < n) {
        cell.status = CellStatus::no_echo;
    } else {
        cell.status = CellStatus::value;
        cell.value = sum / weight;
        if (in_z) cell.value = 10 * std::log10(cell.value);
    }
}

void take_largest(const std::vector<Seen>& seen, SlowCell& cell) {
    const auto has = [&](CellStatus status) {
        return std::any_of(seen.begin(), seen.end(),
                           [&](const Seen& site) { return site.status == status; });
    };
    if (has(CellStatus::value)) {
        cell.status = CellStatus::value;
        cell.value = -1e9L;
        for (const Seen& site : seen) {
            if (site.status == CellStatus::value) cell.value = std::max(cell.value, site.value);
        }
    } else {
        cell.status = has(CellStatus::no_echo) ? CellStatus::no_echo : CellStatus::range_folded;
    }
}

void take_nearest(const std::vector<Seen>& seen, SlowCell& cell) {
    const Seen* nearest = &seen.front();
    for (const Seen& site : seen) {
        if (site.arc_m < nearest->arc_m) nearest = &site;
    }
    for (const Seen& site : seen) {
        if (&site != nearest && std::abs(site.arc_m - nearest->arc_m) < 0.2L) cell.is_close = true;
    }
    cell.status = nearest->status;
    cell.value = nearest->value;
}

// Returns the partials sorted by name, because the first by name counts if two are equally near.
std::vector<const Partial*> by_name(std::span<const Partial> partials) {
    std::vector<const Partial*> sorted;
    for (const Partial& partial : partials)
        sorted.push_back(&partial);
    std::sort(sorted.begin(), sorted.end(),
              [](const auto* a, const auto* b) { return a->site.icao < b->site.icao; });
    return sorted;
}

}  // namespace

namespace {

// Returns the states that sites see in a cell. Leaves out sites that do not see the cell.
std::vector<Seen> all_seen(const GridSpec& domain, const std::vector<const Partial*>& sorted,
                           const std::vector<long double>& arcs_m, const MosaicOptions& options,
                           int ix, int iy, int iz) {
    std::vector<Seen> seen;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const Partial& partial = *sorted[i];
        const GridWindow window = *window_of(domain, *partial.view.spec);
        const int x = ix - window.first_x;
        const int y = iy - window.first_y;
        if (x < 0 || y < 0 || x >= window.nx || y >= window.ny) continue;
        Seen site{};
        site.status = partial.view.status(x, y, iz);
        if (site.status == CellStatus::not_seen) continue;
        if (site.status == CellStatus::value) site.value = partial.view.value(x, y, iz);
        site.arc_m = arcs_m[i];
        const long double ratio = site.arc_m / options.length_m;
        site.weight = options.overlap == Overlap::distance_weighted
                          ? std::max(1e-30L, std::exp(-ratio * ratio))
                          : 1;
        site.limit_dbz =
            limit_dbz(partial.site, site.arc_m, domain.levels_m[static_cast<std::size_t>(iz)]);
        seen.push_back(site);
    }
    return seen;
}

SlowCell cell_of(const std::vector<Seen>& seen, const MosaicOptions& options) {
    SlowCell cell{.count = static_cast<int>(seen.size())};
    for (const Seen& site : seen)
        cell.weight += site.weight;
    if (seen.empty()) return cell;
    if (options.overlap == Overlap::maximum) {
        take_largest(seen, cell);
    } else if (options.overlap == Overlap::nearest) {
        take_nearest(seen, cell);
    } else {
        mix(seen, options, cell);
    }
    return cell;
}

}  // namespace

std::vector<SlowCell> slow_mosaic(const GridSpec& domain, std::span<const Partial> partials,
                                  const MosaicOptions& options) {
    std::vector<SlowCell> cells(domain.cell_count());
    const GridProjection projection(domain);
    const std::vector<const Partial*> sorted = by_name(partials);
    for (int iy = 0; iy < domain.ny; ++iy) {
        for (int ix = 0; ix < domain.nx; ++ix) {
            const GeoPoint place = projection.to_geo({1.0 * ix, 1.0 * iy});
            std::vector<long double> arcs_m;
            for (const Partial* partial : sorted) {
                const SiteFrame frame(partial->site.latitude_deg, partial->site.longitude_deg);
                arcs_m.push_back(frame.to_polar(place).arc_m);
            }
            for (int iz = 0; iz < domain.nz(); ++iz) {
                cells[domain.index(ix, iy, iz)] =
                    cell_of(all_seen(domain, sorted, arcs_m, options, ix, iy, iz), options);
            }
        }
    }
    return cells;
}

}  // namespace stormcellar::grid
