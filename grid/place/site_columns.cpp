#include "grid/place/site_columns.h"

#include <algorithm>
#include <cmath>

namespace stormcellar::grid {
namespace {

constexpr double node_step_m = 25e3;
constexpr double highest_latitude_deg = 75;
constexpr double widest_deg = 350;

}  // namespace

SiteColumns::Way SiteColumns::way_for(const SitePosition& site, const GridSpec& spec) {
    if (spec.in_degrees()) {
        // Columns are not smooth near a pole, where meridians meet, nor across the seam of a grid
        // around the earth.
        const bool smooth = std::abs(site.latitude_deg) <= highest_latitude_deg &&
                            spec.nx * spec.spacing_deg < widest_deg;
        return smooth ? Way::table : Way::exact;
    }
    const bool about_site = facts_of(spec.projection).is_polar &&
                            spec.center_latitude_deg == site.latitude_deg &&
                            spec.center_longitude_deg == site.longitude_deg;
    return about_site ? Way::formula : Way::table;
}

SiteColumns::SiteColumns(const SitePosition& site, const GridSpec& spec, double reach_m)
    : way_(way_for(site, spec)),
      frame_(site.latitude_deg, site.longitude_deg),
      projection_(spec),
      middle_x_(0.5 * (spec.nx - 1)),
      middle_y_(0.5 * (spec.ny - 1)) {
    if (way_ == Way::formula) columns_per_m_ = 1 / spec.spacing_m;
    if (way_ != Way::table) return;
    const int steps = std::max(1, static_cast<int>(std::ceil(reach_m / node_step_m)));
    step_m_ = node_step_m;
    first_m_ = -steps * node_step_m;
    nodes_ = 2 * steps + 1;
    table_.reserve(static_cast<std::size_t>(nodes_) * static_cast<std::size_t>(nodes_));
    for (int iy = 0; iy < nodes_; ++iy) {
        for (int ix = 0; ix < nodes_; ++ix)
            table_.push_back(solve(first_m_ + ix * step_m_, first_m_ + iy * step_m_));
    }
}

ColumnPoint SiteColumns::solve(double x_m, double y_m) const {
    return projection_.to_column(frame_.to_geo(SiteFrame::from_plane(x_m, y_m)));
}

ColumnPoint SiteColumns::at(double sine, double cosine, double arc_m) const {
    const double x_m = arc_m * sine;
    const double y_m = arc_m * cosine;
    if (way_ == Way::formula)
        return {middle_x_ + x_m * columns_per_m_, middle_y_ + y_m * columns_per_m_};
    if (way_ == Way::exact) return solve(x_m, y_m);
    const double across = (x_m - first_m_) / step_m_;
    const double up = (y_m - first_m_) / step_m_;
    const auto ix = static_cast<int>(std::clamp(across, 0.0, nodes_ - 2.0));
    const auto iy = static_cast<int>(std::clamp(up, 0.0, nodes_ - 2.0));
    const double right = across - ix;
    const double top = up - iy;
    const ColumnPoint* low =
        &table_[static_cast<std::size_t>(iy) * static_cast<std::size_t>(nodes_) +
                static_cast<std::size_t>(ix)];
    const ColumnPoint* high = low + nodes_;
    const auto blend = [&](double ColumnPoint::*part) {
        const double lower = low[0].*part + right * (low[1].*part - low[0].*part);
        const double upper = high[0].*part + right * (high[1].*part - high[0].*part);
        return lower + top * (upper - lower);
    };
    return {blend(&ColumnPoint::x), blend(&ColumnPoint::y)};
}

}  // namespace stormcellar::grid
