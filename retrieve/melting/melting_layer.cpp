// Finds the melting layer from the dips of profiles on which most sectors and sweeps agree.
#include "stormcellar/retrieve/melting_layer.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include "retrieve/melting/height_profile.h"
#include "retrieve/melting/layer_dip.h"
#include "retrieve/melting/quantile.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;

constexpr double lowest_deg = 3.8, highest_deg = 10.2;
constexpr std::size_t least_profiles = 3;
constexpr double most_apart_m = 700, least_share = 2.0 / 3;
// Shapes of layers differ, which moves their edges by this much and by a share of the beam.
constexpr double shape_error_m = 60, beam_error_share = 0.25;
constexpr double most_assumed_apart_m = 500;
constexpr std::string_view zero_c_words = "snow begins to melt, at about 0 C, at";

struct SectorDip {
    std::size_t sector = 0;
    LayerDip dip;
};

// All dips of the volume, and other facts from its profiles.
struct Found {
    std::vector<SectorDip> dips;
    int sweeps = 0;  // in the window of elevations
    bool has_dual = false, is_tall_enough = false, is_open_below = false;

    void add(const HeightProfile& profile, std::size_t sector) {
        const DipSearch search = find_dip(profile);
        is_tall_enough = is_tall_enough || search.is_tall_enough;
        is_open_below = is_open_below || search.is_open_below;
        if (search.dip) dips.push_back({sector, *search.dip});
    }
};

Found find_dips(const level2::Volume& volume) {
    Found found;
    std::vector<std::vector<SectorSums>> sweeps;
    for (const level2::Sweep& sweep : volume.sweeps) {
        const bool is_dual = sweep.find(Moment::rho) != nullptr &&
                             sweep.find(Moment::zdr) != nullptr &&
                             sweep.find(Moment::ref) != nullptr;
        found.has_dual = found.has_dual || is_dual;
        const double elevation = sweep.mean_elevation_deg();
        const bool is_inside = elevation >= lowest_deg && elevation <= highest_deg;
        if (!is_dual || !is_inside) continue;
        ++found.sweeps;
        sweeps.push_back(sums_by_sector(sweep));
    }
    for (const auto& sectors : sweeps)
        for (std::size_t sector = 0; sector < sectors.size(); ++sector)
            found.add(height_profile(sectors[sector]), sector);
    if (found.dips.size() >= least_profiles) return found;
    // Profiles of whole circles belong to no sector.
    found.dips.clear();
    for (const auto& sectors : sweeps)
        found.add(height_profile(sums_of_circle(sectors)), MeltingLayer::sector_count);
    return found;
}

// Returns the median heights of some dips. Each error combines the error of a dip's shape with the
// scatter of the dips, which counts as at least `scatter_m`.
LayerHeights joined(std::span<const SectorDip> dips, double scatter_m) {
    std::vector<double> bottoms, tops, beams;
    for (const SectorDip& of : dips) {
        bottoms.push_back(of.dip.bottom_m);
        tops.push_back(of.dip.top_m);
        beams.push_back(of.dip.beam_m);
    }
    LayerHeights heights{quantile(bottoms), quantile(tops)};
    const double shape = std::hypot(shape_error_m, beam_error_share * quantile(beams));
    const auto error = [&](std::vector<double> values, double middle) {
        for (double& value : values)
            value = std::abs(value - middle);
        return std::hypot(shape, std::max(1.4826 * quantile(values), scatter_m));
    };
    heights.bottom_error_m = error(bottoms, heights.bottom_m);
    heights.top_error_m = error(tops, heights.top_m);
    return heights;
}

// Keeps the dips near the median height. Returns false if too few are left.
bool keep_agreeing(std::vector<SectorDip>& dips) {
    std::vector<double> centers;
    for (const SectorDip& of : dips)
        centers.push_back(of.dip.center_m());
    const double middle = quantile(centers);
    const auto all = static_cast<double>(dips.size());
    std::erase_if(dips, [&](const SectorDip& of) {
        return std::abs(of.dip.center_m() - middle) > most_apart_m;
    });
    return dips.size() >= least_profiles && static_cast<double>(dips.size()) >= least_share * all;
}

// `dips` is the number of profiles with a minimum, before those that do not agree were left out.
Error reason(const Found& found, std::size_t dips) {
    const auto because = [](const char* text) {
        return Error{ErrorCode::not_found, fmt::format("no melting layer found: {}", text)};
    };
    if (!found.has_dual) return because("the volume has no dual polarization");
    if (found.sweeps == 0) return because("no sweep from 4 to 10 degrees has dual polarization");
    if (found.is_open_below)
        return because("it may begin below the lowest height seen from 4 to 10 degrees");
    if (!found.is_tall_enough) return because("too little stratiform echo from 4 to 10 degrees");
    if (dips < least_profiles)
        return because("the correlation coefficient has no minimum between rain and snow");
    return because("the heights of least correlation do not agree");
}

}  // namespace

std::size_t MeltingLayer::sector_of(double azimuth_deg) {
    if (!std::isfinite(azimuth_deg)) return 0;
    const double turns = azimuth_deg / 360 - std::floor(azimuth_deg / 360);
    const auto sector = static_cast<std::size_t>(turns * static_cast<double>(sector_count));
    return std::min(sector, sector_count - 1);
}

const LayerHeights& MeltingLayer::at(double azimuth_deg) const {
    const auto& sector = sectors[sector_of(azimuth_deg)];
    return sector ? *sector : heights;
}

Result<MeltingLayer> melting_layer(const level2::Volume& volume) {
    Found found = find_dips(volume);
    const std::size_t dips = found.dips.size();
    if (dips < least_profiles || !keep_agreeing(found.dips))
        return tl::unexpected<Error>(reason(found, dips));
    MeltingLayer layer;
    layer.profiles = static_cast<int>(found.dips.size());
    layer.heights = joined(found.dips, 0);
    for (std::size_t sector = 0; sector < MeltingLayer::sector_count; ++sector) {
        std::vector<SectorDip> own;
        std::ranges::copy_if(found.dips, std::back_inserter(own),
                             [&](const SectorDip& of) { return of.sector == sector; });
        const double scatter_m = std::min(layer.heights.bottom_error_m, layer.heights.top_error_m);
        if (!own.empty()) layer.sectors[sector] = joined(own, scatter_m);
    }
    return layer;
}

std::string zero_c_note(const level2::Volume& volume, double assumed_m) {
    const auto antenna = level2::antenna_position(volume);
    const auto layer = melting_layer(volume);
    if (!antenna || !layer) return {};
    const double top = antenna->altitude_m + layer->heights.top_m;
    const bool is_near = std::abs(top - assumed_m) <= most_assumed_apart_m;
    if (is_near) return {};
    return fmt::format("{} {:.0f} m above sea level (+- {:.0f} m), and not at the assumed {:.0f} m",
                       zero_c_words, top, layer->heights.top_error_m, assumed_m);
}

std::string zero_c_in_notes(std::span<const std::string> notes) {
    for (const std::string& note : notes)
        if (const std::size_t at = note.find(zero_c_words); at != note.npos) return note.substr(at);
    return {};
}

}  // namespace stormcellar::retrieve
