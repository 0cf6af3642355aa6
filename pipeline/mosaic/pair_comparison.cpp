#include "pipeline/mosaic/pair_comparison.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "grid/cells/cut_bricks.h"
#include "grid/mosaic/motion.h"
#include "grid/sweep/sweep_clock.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/site_frame.h"

namespace stormcellar::pipeline {
namespace {

using grid::GridWindow;

constexpr double greatest_range_m = grid::ComparisonOptions{}.greatest_range_m;

// A part of a partial, with the ages of its cells.
struct Cut {
    grid::BrickGrid bricks;
    grid::CellDetails ages;
};

// Returns the window that both sites may see, with `margin` bricks around it. Returns none if no
// column is in it.
std::optional<GridWindow> common_window(const grid::GridSpec& spec, const grid::SitePosition& a,
                                        const grid::SitePosition& b, int margin) {
    const auto about_a = grid::site_window(spec, a, greatest_range_m);
    const auto about_b = grid::site_window(spec, b, greatest_range_m);
    if (!about_a || !about_b) return std::nullopt;
    const int more = margin * grid::brick_edge;
    const auto common = [&](int first_a, int end_a, int first_b, int end_b, int cells) {
        return std::pair{std::max(0, std::max(first_a, first_b) - more),
                         std::min(cells, std::min(end_a, end_b) + more)};
    };
    const auto [x0, x1] =
        common(about_a->first_x, about_a->end_x(), about_b->first_x, about_b->end_x(), spec.nx);
    const auto [y0, y1] =
        common(about_a->first_y, about_a->end_y(), about_b->first_y, about_b->end_y(), spec.ny);
    if (x1 <= x0 || y1 <= y0) return std::nullopt;
    return GridWindow{x0, y0, x1 - x0, y1 - y0};
}

// Returns the ages of cells, in seconds after the instant. If the sweeps are undated, every cell
// has the time of its volume's middle.
Result<grid::CellDetails> ages_of(const PartialView& partial, const grid::GridSpec& spec,
                                  UtcTime instant) {
    const grid::SitePosition& site = partial.site();
    const auto geometry = grid::make_column_geometry(site, spec);
    if (!geometry) return pass_on(geometry);
    const auto clock = grid::SweepClock::of_volume(
        partial.description->provenance.sweeps,
        grid::BeamGeometry(site.latitude_deg, site.altitude_m), instant, partial.middle());
    grid::DetailSet set;
    set.add(grid::Detail::age);
    grid::CellDetails ages(set, spec.cell_count());
    std::vector<float> column(spec.levels_m.size(),
                              static_cast<float>(seconds_between(instant, partial.middle())));
    for (int iy = 0; iy < spec.ny; ++iy) {
        const auto row = (*geometry)->row(iy);
        for (int ix = 0; ix < spec.nx; ++ix) {
            const grid::ColumnPlace& place = row[static_cast<std::size_t>(ix)];
            if (clock) {
                clock->read(static_cast<double>(place.azimuth_deg),
                            static_cast<double>(place.arc_m), spec.levels_m, column);
            }
            const std::size_t first = spec.index(ix, iy, 0);
            for (std::size_t iz = 0; iz < column.size(); ++iz)
                ages.put(grid::Detail::age, first + iz, column[iz]);
        }
    }
    return ages;
}

Result<Cut> cut_out(const PartialView& partial, const GridWindow& window, UtcTime instant) {
    const grid::GridSpec spec = grid::window_spec(*partial.view.spec, window);
    auto ages = ages_of(partial, spec, instant);
    if (!ages) return pass_on(ages);
    return Cut{grid::cut_bricks(partial.view, window), std::move(*ages)};
}

bool is_known(const grid::Estimate& estimate) {
    return estimate.untold.empty();
}

std::string text_of(const char* name, const grid::Estimate& estimate, const char* unit) {
    if (!is_known(estimate)) return fmt::format("{} unknown", name);
    return fmt::format("{} {:+.2f} +- {:.2f} {}", name, estimate.value, estimate.standard_error,
                       unit);
}

}  // namespace

std::vector<SiteLook> looks_about(std::span<const PartialView> partials, UtcTime instant) {
    std::map<std::string, std::vector<const PartialView*>> sites;
    for (const PartialView& partial : partials)
        sites[partial.site().icao].push_back(&partial);
    std::vector<SiteLook> looks;
    for (auto& [icao, of_site] : sites) {
        std::stable_sort(of_site.begin(), of_site.end(),
                         [&](const PartialView* a, const PartialView* b) {
                             return std::chrono::abs(a->middle() - instant) <
                                    std::chrono::abs(b->middle() - instant);
                         });
        SiteLook look{of_site.front(), nullptr};
        for (const PartialView* one : of_site) {
            const bool is_other = one->middle() != look.nearest->middle() &&
                                  *one->view.spec == *look.nearest->view.spec;
            if (is_other && look.other == nullptr) look.other = one;
        }
        looks.push_back(look);
    }
    return looks;
}

bool may_overlap(const grid::SitePosition& a, const grid::SitePosition& b) {
    const grid::SiteFrame frame(a.latitude_deg, a.longitude_deg);
    return frame.to_polar({b.latitude_deg, b.longitude_deg}).arc_m < 2 * greatest_range_m;
}

std::optional<grid::UniformMotion> motion_between(const SiteLook& look) {
    if (look.other == nullptr) return std::nullopt;
    const bool later = look.other->middle() > look.nearest->middle();
    const PartialView& before = later ? *look.nearest : *look.other;
    const PartialView& after = later ? *look.other : *look.nearest;
    const auto field = grid::estimate_motion(before.view, after.view,
                                             seconds_between(before.middle(), after.middle()));
    if (!field || !*field) return std::nullopt;
    const grid::CellMotion whole = (*field)->whole();
    const grid::GridSpec& spec = *before.view.spec;
    return grid::UniformMotion{static_cast<double>(whole.x) * spec.cell_width_m(),
                               static_cast<double>(whole.y) * spec.cell_height_m()};
}

Result<grid::SiteComparison> compare_looks(const SiteLook& a, const SiteLook& b, UtcTime instant) {
    for (const SiteLook* look : {&a, &b}) {
        if (look->nearest->description->moment == level2::Moment::ref) continue;
        return fail(ErrorCode::bad_argument, "sites are compared by REF, not by {}",
                    level2::moment_name(look->nearest->description->moment));
    }
    const auto in_a = common_window(*a.nearest->view.spec, a.site(), b.site(), 0);
    const auto in_b = common_window(*b.nearest->view.spec, a.site(), b.site(), 1);
    if (!in_a || !in_b) {
        return fail(ErrorCode::bad_argument, "{} and {} see no cell in common", a.site().icao,
                    b.site().icao);
    }
    const auto cut_a = cut_out(*a.nearest, *in_a, instant);
    if (!cut_a) return pass_on(cut_a);
    const auto cut_b = cut_out(*b.nearest, *in_b, instant);
    if (!cut_b) return pass_on(cut_b);
    grid::ComparisonOptions options;
    const auto about_a = motion_between(a), about_b = motion_between(b);
    options.motion = about_a ? about_a : about_b;
    if (about_a && about_b) {
        options.motion = grid::UniformMotion{(about_a->east_mps + about_b->east_mps) / 2,
                                             (about_a->north_mps + about_b->north_mps) / 2};
    }
    return grid::compare_sites({cut_a->bricks.view(), a.site(), &cut_a->ages},
                               {cut_b->bricks.view(), b.site(), &cut_b->ages}, options);
}

std::string describe(const grid::SiteComparison& comparison) {
    return fmt::format(
        "{} against {}: {}, {}, {}, {} ({} cells, correlation {:.2f}, seen {:.0f} s apart)",
        comparison.b, comparison.a, text_of("bias", comparison.bias_db, "dB"),
        text_of("azimuth", comparison.azimuth_deg, "degrees"),
        text_of("elevation", comparison.elevation_deg, "degrees"),
        text_of("time", comparison.time_s, "s"), comparison.cells, comparison.correlation,
        comparison.apart_s);
}

bool tells_anything(const grid::SiteComparison& comparison) {
    return is_known(comparison.bias_db) || is_known(comparison.azimuth_deg) ||
           is_known(comparison.elevation_deg) || is_known(comparison.time_s);
}

}  // namespace stormcellar::pipeline
