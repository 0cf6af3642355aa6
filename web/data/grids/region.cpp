#include "web/data/grids/region.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "stormcellar/base/station_table.h"
#include "stormcellar/grid/grid_window.h"
#include "stormcellar/grid/projection.h"
#include "web/data/events/station_place.h"
#include "web/data/grids/halved_grid.h"
#include "web/data/grids/nearest_columns.h"

namespace stormcellar::web {
namespace {

constexpr double least_side_deg = 0.05;
constexpr double most_side_deg = 40;
constexpr double farthest_latitude_deg = 80;
constexpr double farthest_site_deg = 12;  // from the box; no site reaches farther
constexpr int threads_of_a_region = 1;

Status check_region_box(const RegionBox& box) {
    for (const double side : {box.west_deg, box.east_deg, box.south_deg, box.north_deg}) {
        if (!std::isfinite(side)) return fail(ErrorCode::bad_argument, "the region has no sides");
    }
    const double wide = box.east_deg - box.west_deg, high = box.north_deg - box.south_deg;
    if (!(wide >= least_side_deg) || !(high >= least_side_deg) || std::abs(box.west_deg) > 180) {
        return fail(ErrorCode::bad_argument,
                    "west must not be east, and south must be less than north, by {} degrees at "
                    "least",
                    least_side_deg);
    }
    if (wide > most_side_deg || high > most_side_deg ||
        std::max(std::abs(box.south_deg), std::abs(box.north_deg)) > farthest_latitude_deg) {
        return fail(
            ErrorCode::bad_argument,
            "a region has at most {} degrees a side, and lies within {} degrees of latitude",
            most_side_deg, farthest_latitude_deg);
    }
    return {};
}

// Returns the plane about the middle of the box, with enough columns to cover its corners.
grid::GridSpec region_spec(const RegionBox& box, double spacing_m, std::vector<double> levels_m) {
    grid::GridSpec spec;
    spec.center_latitude_deg = 0.5 * (box.south_deg + box.north_deg);
    spec.center_longitude_deg = std::remainder(0.5 * (box.west_deg + box.east_deg), 360.0);
    spec.spacing_m = spacing_m;
    spec.levels_m = std::move(levels_m);
    spec.nx = spec.ny = 2;
    const grid::GridProjection plane(spec);
    double half_x = 1, half_y = 1;  // in columns
    for (const double latitude : {box.south_deg, spec.center_latitude_deg, box.north_deg}) {
        for (const double longitude : {box.west_deg, spec.center_longitude_deg, box.east_deg}) {
            const auto at = plane.to_column({latitude, std::remainder(longitude, 360.0)});
            half_x = std::max(half_x, std::abs(at.x - spec.center_x()));
            half_y = std::max(half_y, std::abs(at.y - spec.center_y()));
        }
    }
    const auto side = [](double half) {
        return static_cast<int>(std::min(2 * std::ceil(half), 1.0 * grid::GridSpec::greatest_side));
    };
    spec.nx = side(half_x);
    spec.ny = side(half_y);
    return spec;
}

// Returns the distance from a site to the farthest corner of its grid, in meters.
double reach_of_grid(const grid::GridSpec& spec) {
    return 0.5 * std::hypot(spec.nx * spec.cell_width_m(), spec.ny * spec.cell_height_m());
}

// Returns true if the place is in the box, or within the margin around it.
bool is_about(const StationPlace& place, const RegionBox& box, double margin_deg) {
    const double across =
        std::remainder(place.longitude_deg - 0.5 * (box.west_deg + box.east_deg), 360.0);
    return std::abs(across) < 0.5 * (box.east_deg - box.west_deg) + margin_deg &&
           place.latitude_deg > box.south_deg - margin_deg &&
           place.latitude_deg < box.north_deg + margin_deg;
}

// A site near the box, with its newest grid of the moment. A site in the box that has no such grid
// has a null grid.
struct NearbySite {
    std::string name;
    std::shared_ptr<const OpenGrid> newest;
};

Result<std::vector<NearbySite>> sites_about(Grids& grids, const RegionBox& box,
                                            level2::Moment moment) {
    std::vector<NearbySite> found;
    for (const std::string& domain : grids.domains()) {
        if (!is_icao(domain)) continue;
        const auto place = place_of_station(&grids, domain);
        if (!place || !is_about(*place, box, farthest_site_deg)) continue;
        const auto newest = grids.newest(domain, moment);
        if (!newest && is_about(*place, box, 0)) found.push_back({domain, nullptr});
        if (!newest) continue;
        auto grid = grids.find(domain, moment, *newest);
        // If the grid is gone, it was evicted since it was listed.
        if (!grid && grid.error().code == ErrorCode::not_found) continue;
        if (!grid) return pass_on(grid);
        if ((*grid)->file.description().sites.size() == 1) found.push_back({domain, *grid});
    }
    return found;
}

// Returns true if the grid has the plan's levels and codes. Other grids do not fit, because sites
// are merged level by level and code by code.
bool fits(const OpenGrid& grid, const RegionPlan& plan) {
    const grid::BrickView view = grid.file.view();
    return view.spec->levels_m == plan.spec.levels_m && view.quantization == plan.quantization;
}

// A site's grid on the columns of the region.
struct LaidGrid {
    std::shared_ptr<const OpenGrid> source;
    cache::GridDescription description;
    std::optional<grid::BrickGrid> bricks;
};

// Resamples the volumes of one site onto the region. Volumes with the same spec share the table of
// nearest columns.
class SiteLayer {
  public:
    explicit SiteLayer(const RegionPlan& plan) : plan_(&plan) {}

    // Returns none if the site's grid does not reach the region.
    Result<std::optional<LaidGrid>> lay(std::shared_ptr<const OpenGrid> source) {
        LaidGrid laid{std::move(source), {}, {}};
        laid.description = laid.source->file.description();
        grid::BrickView view = laid.source->file.view();
        std::shared_ptr<const grid::BrickGrid> half;
        if (plan_->halvings > 0) {
            auto made = halved(view, plan_->moment, plan_->halvings, HalvedBy::maximum);
            if (!made) return pass_on(made);
            half = std::move(*made);
            view = half->view();
        }
        const auto window = grid::site_window(plan_->spec, laid.description.sites.front(),
                                              reach_of_grid(laid.description.spec));
        if (!window) return std::optional<LaidGrid>{};
        laid.description.spec = grid::window_spec(plan_->spec, *window);
        if (!columns_ || !(from_ == *view.spec) || !(to_ == laid.description.spec)) {
            from_ = *view.spec;
            to_ = laid.description.spec;
            columns_.emplace(from_, to_);
        }
        laid.bricks = columns_->lay(view);
        // If the file was truncated while we read it, missing codes read as 0 (not seen), so check
        // that the file is still whole.
        if (Status whole = laid.source->file.check_whole(); !whole) return pass_on(whole);
        return std::optional<LaidGrid>{std::move(laid)};
    }

  private:
    const RegionPlan* plan_;
    grid::GridSpec from_, to_;
    std::optional<NearestColumns> columns_;
};

UtcTime middle_of(const OpenGrid& grid) {
    const cache::GridDescription& description = grid.file.description();
    return description.start_time + (description.end_time - description.start_time) / 2;
}

// Returns a site's volumes around an instant, at most `greatest_gap` away: the last volume whose
// middle is not after the instant, and the next volume. Volumes that do not fit are left out. The
// time of a grid is the start of its volume, so the search begins earlier.
Result<RegionSite> volumes_about(Grids& grids, const std::string& site, const RegionPlan& plan,
                                 UtcTime instant) {
    const auto gap = pipeline::FrameOptions{}.greatest_gap;
    RegionSite found{site, nullptr, nullptr, {}};
    bool has_others = false;  // true: there are grids that do not fit
    const auto times = grids.times(site, plan.moment, instant - 2 * gap, instant + gap);
    for (auto time = times.rbegin(); time != times.rend() && !found.before; ++time) {
        auto grid = grids.find(site, plan.moment, *time);
        // If the grid is gone, it was evicted since it was listed.
        if (!grid && grid.error().code == ErrorCode::not_found) continue;
        if (!grid) return pass_on(grid);
        const UtcTime middle = middle_of(**grid);
        if (std::abs(seconds_between(middle, instant)) > std::chrono::duration<double>(gap).count())
            continue;
        // An older grid may have been made with another configuration.
        if (!fits(**grid, plan)) {
            has_others = true;
            continue;
        }
        (middle <= instant ? found.before : found.after) = std::move(*grid);
    }
    if (!found.before && !found.after) {
        found.left_out_because =
            has_others ? "its grids of this time have other levels or codes"
                       : fmt::format("it has no volume within {} minutes",
                                     std::chrono::duration_cast<std::chrono::minutes>(gap).count());
    }
    return found;
}

}  // namespace

RegionBox turned(RegionBox box) {
    if (!std::isfinite(box.west_deg) || !std::isfinite(box.east_deg)) return box;
    const double turns_deg = 360 * std::floor((box.west_deg + 180) / 360);
    box.west_deg -= turns_deg;
    box.east_deg -= turns_deg;
    if (box.east_deg < box.west_deg)
        box.east_deg += 360 * std::ceil((box.west_deg - box.east_deg) / 360);
    return box;
}

Result<RegionBox> region_box_of(std::string_view text) {
    RegionBox box;
    for (double* side : {&box.west_deg, &box.south_deg, &box.east_deg, &box.north_deg}) {
        // Nothing may follow the last number, not even a comma.
        const std::string_view part =
            side == &box.north_deg ? text : text.substr(0, text.find(','));
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), *side);
        if (error != std::errc{} || end != part.data() + part.size()) {
            return fail(ErrorCode::bad_argument, "a region is WEST,SOUTH,EAST,NORTH in degrees");
        }
        text.remove_prefix(std::min(text.size(), part.size() + 1));
    }
    box = turned(box);
    if (Status good = check_region_box(box); !good) return pass_on(good);
    return box;
}

Result<RegionPlan> plan_region(Grids& grids, const RegionBox& box, level2::Moment moment) {
    if (Status good = check_region_box(box); !good) return pass_on(good);
    const auto nearby = sites_about(grids, box, moment);
    if (!nearby) return pass_on(nearby);
    RegionPlan plan;
    plan.moment = moment;
    for (const auto& [name, newest] : *nearby) {
        if (!newest) {
            plan.left_out.push_back(
                {name, fmt::format("it has no grids of {}", level2::moment_name(moment))});
            continue;
        }
        const grid::GridSpec& own = newest->file.description().spec;
        // The first site in reach fixes spacing, levels and codes of the region.
        if (plan.sites.empty()) {
            plan.spec = region_spec(box, own.cell_height_m(), own.levels_m);
            plan.quantization = newest->file.view().quantization;
        }
        const auto& site = newest->file.description().sites.front();
        if (!grid::site_window(plan.spec, site, reach_of_grid(own))) continue;
        if (fits(*newest, plan)) {
            plan.sites.push_back(name);
        } else {
            plan.left_out.push_back(
                {name, fmt::format("its grids have other levels or codes than those of {}",
                                   plan.sites.front())});
        }
    }
    if (plan.sites.empty()) {
        return fail(ErrorCode::not_found, "no site with grids of {} reaches this region",
                    level2::moment_name(moment));
    }
    if (plan.sites.size() > most_region_sites) {
        return fail(ErrorCode::bad_argument,
                    "{} sites reach this region; at most {} are merged on request",
                    plan.sites.size(), most_region_sites);
    }
    const double finest_m = plan.spec.spacing_m;
    while (plan.spec.column_count() > most_region_columns && plan.halvings < most_region_halvings) {
        ++plan.halvings;
        plan.spec = region_spec(box, std::ldexp(finest_m, plan.halvings), plan.spec.levels_m);
    }
    if (plan.spec.column_count() > most_region_columns) {
        return fail(ErrorCode::bad_argument,
                    "the region has {} columns of {:.0f} m, and {} are made on request: draw a "
                    "smaller one",
                    plan.spec.column_count(), plan.spec.spacing_m, most_region_columns);
    }
    return plan;
}

std::vector<UtcTime> region_times(const Grids& grids, const RegionPlan& plan) {
    const auto interval = std::chrono::duration_cast<UtcTime::duration>(region_interval);
    const auto bridge = 2 * pipeline::FrameOptions{}.greatest_gap;
    std::set<UtcTime> instants;
    for (const std::string& site : plan.sites) {
        std::optional<UtcTime> before;
        for (const UtcTime time : grids.times(site, plan.moment)) {
            const auto since = time.time_since_epoch() + interval / 2;
            const UtcTime instant{since - since % interval};
            instants.insert(instant);
            // Between two volumes, the echo of the site can be moved to any instant.
            if (before && instant - *before <= bridge) {
                for (UtcTime between = *before + interval; between < instant; between += interval)
                    instants.insert(between);
            }
            before = instant;
        }
    }
    return {instants.begin(), instants.end()};
}

double RegionSite::seconds_to(const OpenGrid& volume, UtcTime instant) {
    return seconds_between(instant, middle_of(volume));
}

Result<std::vector<RegionSite>> region_sites(Grids& grids, const RegionPlan& plan,
                                             UtcTime instant) {
    std::vector<RegionSite> sites;
    for (const std::string& site : plan.sites) {
        auto found = volumes_about(grids, site, plan, instant);
        if (!found) return pass_on(found);
        sites.push_back(std::move(*found));
    }
    return sites;
}

Result<pipeline::MosaicFrame> make_region(Grids& grids, const RegionPlan& plan, UtcTime instant) {
    const auto sites = region_sites(grids, plan, instant);
    if (!sites) return pass_on(sites);
    std::vector<LaidGrid> laid;
    for (const RegionSite& site : *sites) {
        SiteLayer layer(plan);
        for (const auto& volume : {site.before, site.after}) {
            if (!volume) continue;
            auto one = layer.lay(volume);
            if (!one) return pass_on(one);
            if (*one) laid.push_back(std::move(**one));
        }
    }
    std::vector<pipeline::PartialView> partials;
    partials.reserve(laid.size());
    for (const LaidGrid& one : laid)
        partials.push_back({&one.description, one.bricks->view(), nullptr});
    pipeline::FrameOptions options;
    options.overlap.moment = plan.moment;
    options.overlap.overlap = grid::default_overlap(plan.moment);
    options.threads = threads_of_a_region;
    options.overlap.threads = threads_of_a_region;
    pipeline::GeometryCache geometries(plan.sites.size());
    return pipeline::make_frame(plan.spec, partials, instant, options, geometries);
}

}  // namespace stormcellar::web
