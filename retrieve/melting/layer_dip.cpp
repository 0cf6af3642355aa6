#include "retrieve/melting/layer_dip.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "retrieve/melting/quantile.h"

namespace stormcellar::retrieve {
namespace {

constexpr std::size_t near_levels = 3, far_levels = 12;  // of the air on each side of a dip
constexpr std::size_t least_levels = 4;                  // with means, on each side
constexpr std::size_t peak_levels = 5;                   // on each side, for the other maxima
// The correlation of a side is that of its best quarter, because the dip may reach into the side.
constexpr double side_share = 0.75;
constexpr double least_depth = 0.006, deepest = 0.8, shallowest = 0.985;
constexpr double least_peak_dbz = 20, least_rise_dbz = 1.5, least_rise_db = 0.2;
constexpr double least_power = 0.1;  // share of the minimum's power where a dip ends
// From the middle of the power to the ends of melting, in standard deviations of the power. For
// products of two parabolas it is 2.65; sharper shapes have more.
constexpr double half_depth = 3.1;
constexpr double usual_spread_m = 95, blurred_m = 125;

// The air on one side of a level.
struct Side {
    std::vector<double> correlations, reflectivities, zdrs;

    [[nodiscard]] bool is_known() const { return correlations.size() >= least_levels; }
};

Side side_of(const HeightProfile& profile, std::size_t level, bool is_above) {
    Side side;
    for (std::size_t apart = near_levels; apart <= far_levels; ++apart) {
        if (!is_above && apart > level) break;
        const std::size_t at = is_above ? level + apart : level - apart;
        if (at >= profile_levels) break;
        if (!profile[at]) continue;
        side.correlations.push_back(profile[at]->correlation);
        side.reflectivities.push_back(profile[at]->reflectivity_dbz);
        side.zdrs.push_back(profile[at]->zdr_db);
    }
    return side;
}

// Returns the mean of a level and its neighbors, with half the weight for each neighbor.
std::optional<double> smooth_correlation(const HeightProfile& profile, std::size_t level) {
    if (!profile[level]) return std::nullopt;
    double sum = profile[level]->correlation, weight = 1;
    for (const std::size_t at : {level - 1, level + 1}) {
        if (at >= profile_levels || !profile[at]) continue;
        sum += 0.5 * profile[at]->correlation;
        weight += 0.5;
    }
    return sum / weight;
}

struct Minimum {
    std::size_t level = 0;
    double depth = 0, above = 0, below = 0;  // correlations of the air on both sides
};

// Returns the power of melting snow at a level: linear reflectivity times the difference to the
// correlation of the air on both sides. The beam smooths this product as it smooths any power, but
// this is true of neither factor alone. So the mean and the standard deviation of this product are
// those of the layer.
std::optional<double> melting_power(const HeightProfile& profile, const Minimum& minimum,
                                    std::size_t level) {
    if (!profile[level]) return std::nullopt;
    const double base = level >= minimum.level ? minimum.above : minimum.below;
    const double missing = std::max(base - profile[level]->correlation, 0.0);
    return missing * std::pow(10, profile[level]->reflectivity_dbz / 10);
}

// Sums of the power of melting snow over levels.
struct PowerSums {
    double power = 0, moment = 0, square = 0;

    void add(double of_level, double level) {
        power += of_level;
        moment += of_level * level;
        square += of_level * level * level;
    }
    [[nodiscard]] double mean() const { return moment / power; }
    [[nodiscard]] double variance() const { return square / power - mean() * mean(); }
};

// Adds the levels on one side of the minimum down to a small share of its power. Returns false if
// the profile ends before that, or lacks two levels in a row.
bool add_side(const HeightProfile& profile, const Minimum& minimum, bool is_above,
              PowerSums& sums) {
    const double peak = melting_power(profile, minimum, minimum.level).value_or(0);
    bool is_missing = false;
    for (std::size_t apart = 1; apart <= far_levels; ++apart) {
        if (!is_above && apart > minimum.level) return false;
        const std::size_t at = is_above ? minimum.level + apart : minimum.level - apart;
        if (at >= profile_levels) return false;
        const auto power = melting_power(profile, minimum, at);
        if (!power && is_missing) return false;
        is_missing = !power;
        if (!power) continue;
        if (*power <= least_power * peak) return true;
        sums.add(*power, static_cast<double>(at));
    }
    return false;
}

// Returns the largest value of a moment near a level.
double peak_near(const HeightProfile& profile, std::size_t level, double ProfileLevel::*moment) {
    double peak = -100;
    for (std::size_t at = level >= peak_levels ? level - peak_levels : 0;
         at <= std::min(level + peak_levels, profile_levels - 1); ++at)
        if (profile[at]) peak = std::max(peak, (*profile[at]).*moment);
    return peak;
}

// Returns true if reflectivity and ZDR are those of melting snow below snow.
bool melts(const HeightProfile& profile, std::size_t level, const Side& above) {
    const double peak_dbz = peak_near(profile, level, &ProfileLevel::reflectivity_dbz);
    const double peak_db = peak_near(profile, level, &ProfileLevel::zdr_db);
    return peak_dbz >= least_peak_dbz &&
           peak_dbz >= quantile(above.reflectivities) + least_rise_dbz &&
           peak_db >= quantile(above.zdrs) + least_rise_db;
}

std::optional<LayerDip> dip_at(const HeightProfile& profile, const Minimum& minimum) {
    PowerSums sums;
    sums.add(melting_power(profile, minimum, minimum.level).value_or(0),
             static_cast<double>(minimum.level));
    if (!add_side(profile, minimum, true, sums) || !add_side(profile, minimum, false, sums))
        return std::nullopt;
    const double beam = profile[minimum.level]->beam_m;
    const double measured = sums.variance() * profile_step_m * profile_step_m;
    // A wide beam hides the depth of the layer, which then is the usual depth.
    const double trust = 1 / (1 + std::pow(beam / blurred_m, 4));
    const double own = std::max(measured - beam * beam, 0.0);
    const double spread = std::sqrt(std::lerp(usual_spread_m * usual_spread_m, own, trust));
    const double center = level_height_m(sums.mean());
    return LayerDip{center - half_depth * spread, center + half_depth * spread, beam};
}

}  // namespace

DipSearch find_dip(const HeightProfile& profile) {
    DipSearch search;
    Minimum deepest_minimum;
    for (std::size_t level = 0; level < profile_levels; ++level) {
        const auto here = smooth_correlation(profile, level);
        if (!here) continue;
        const Side above = side_of(profile, level, true), below = side_of(profile, level, false);
        if (!above.is_known()) continue;
        const double over = quantile(above.correlations, side_share);
        const bool is_low = *here >= deepest && *here <= shallowest &&
                            over - *here >= least_depth && melts(profile, level, above);
        if (!below.is_known()) {
            search.is_open_below = search.is_open_below || is_low;
            continue;
        }
        search.is_tall_enough = true;
        const double under = quantile(below.correlations, side_share);
        const double depth = std::min(over, under) - *here;
        if (is_low && depth >= least_depth && depth > deepest_minimum.depth)
            deepest_minimum = {level, depth, over, under};
    }
    if (deepest_minimum.depth > 0) search.dip = dip_at(profile, deepest_minimum);
    if (search.dip) search.is_open_below = false;
    return search;
}

}  // namespace stormcellar::retrieve
