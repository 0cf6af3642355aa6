#include "retrieve/quality/spokes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace stormcellar::retrieve {
namespace {

constexpr double bin_m = 5000;
constexpr std::size_t least_interference_bins = 12, least_sun_bins = 8;
constexpr std::size_t most_radials = 3, fewest_radials = 12;
constexpr float full_share = 0.75F, empty_share = 0.25F, sunny_share = 0.5F;
constexpr double farthest_from_sun_deg = 1.5;
constexpr float widest_step_deg = 1.5F;
constexpr float sun_spread_db = 3, sun_gate_spread_db = 6;

float level_of(float reflectivity_dbz, double range_m) {
    return reflectivity_dbz - static_cast<float>(20 * std::log10(range_m / 1000));
}

class SpokeFinder {
  public:
    SpokeFinder(const GateField& field, const level2::Sweep& sweep)
        : field_(field),
          sweep_(sweep),
          gates_per_bin_(
              static_cast<std::size_t>(std::max(1.0, std::round(bin_m / field.gate_spacing_m)))),
          bins_(field.gates / gates_per_bin_),
          shares_(field.radials * bins_) {
        for (std::size_t radial = 0; radial < field.radials; ++radial) {
            const std::uint16_t* codes = field.row(radial);
            for (std::size_t bin = 0; bin < bins_; ++bin) {
                const std::uint16_t* first = codes + bin * gates_per_bin_;
                const auto empty = std::count(first, first + gates_per_bin_, std::uint16_t{0});
                shares_[radial * bins_ + bin] =
                    1 - static_cast<float>(empty) / static_cast<float>(gates_per_bin_);
            }
        }
    }

    std::vector<Spoke> find(const std::optional<SunPosition>& sun) {
        if (field_.radials < fewest_radials || bins_ == 0) return {};
        for (std::size_t width = 1; width <= most_radials; ++width)
            for (std::size_t radial = 0; radial < field_.radials; ++radial)
                find_interference(radial, width);
        if (sun && std::isfinite(sun->azimuth_deg) && std::isfinite(sun->elevation_deg))
            for (std::size_t radial = 0; radial < field_.radials; ++radial)
                if (is_near(sweep_.radials[radial], *sun)) find_sun(radial);
        return std::move(spokes_);
    }

  private:
    [[nodiscard]] float share(std::size_t radial, std::size_t bin) const {
        return shares_[radial % field_.radials * bins_ + bin];
    }
    void mark(std::size_t radial, std::size_t gate, Spoke spoke) {
        if (spokes_.empty()) spokes_.assign(field_.codes.size(), Spoke::none);
        spokes_[radial % field_.radials * field_.gates + gate] = spoke;
    }

    // Returns true if no gap in azimuth lies between two radials.
    [[nodiscard]] bool follow_each_other(std::size_t from, std::size_t to) const {
        for (std::size_t radial = from; radial < to; ++radial) {
            const float here = sweep_.radials[radial % field_.radials].azimuth_deg;
            const float next = sweep_.radials[(radial + 1) % field_.radials].azimuth_deg;
            if (!std::isfinite(here) || !std::isfinite(next)) return false;
            if (std::abs(std::remainder(next - here, 360.0F)) > widest_step_deg) return false;
        }
        return true;
    }
    void find_interference(std::size_t first, std::size_t width) {
        const std::size_t before = first + field_.radials - 2, behind = first + width + 1;
        if (!follow_each_other(before, behind + field_.radials)) return;
        const auto is_in_spoke = [&](std::size_t bin) {
            if (share(before, bin) > empty_share || share(behind, bin) > empty_share) return false;
            for (std::size_t i = 0; i < width; ++i)
                if (share(first + i, bin) < full_share) return false;
            return true;
        };
        // A run survives single bins that noise spoils.
        const auto goes_on = [&](std::size_t bin) {
            return bin < bins_ && (is_in_spoke(bin) || (bin + 1 < bins_ && is_in_spoke(bin + 1)));
        };
        for (std::size_t bin = 0; bin < bins_; ++bin) {
            if (!is_in_spoke(bin)) continue;
            const std::size_t begin = bin;
            while (goes_on(bin))
                ++bin;
            if (bin - begin < least_interference_bins) continue;
            for (std::size_t i = 0; i < width; ++i)
                for (std::size_t g = begin * gates_per_bin_; g < bin * gates_per_bin_; ++g)
                    mark(first + i, g, Spoke::interference);
        }
    }

    static bool is_near(const level2::Radial& radial, const SunPosition& sun) {
        if (!std::isfinite(radial.azimuth_deg) || !std::isfinite(radial.elevation_deg))
            return false;
        const double elevation = static_cast<double>(radial.elevation_deg);
        const double across =
            std::remainder(static_cast<double>(radial.azimuth_deg) - sun.azimuth_deg, 360) *
            std::cos(elevation * std::numbers::pi / 180);
        return std::abs(across) <= farthest_from_sun_deg &&
               std::abs(elevation - sun.elevation_deg) <= farthest_from_sun_deg;
    }
    // Returns the mean level of the gates with echo in a bin.
    [[nodiscard]] float level_of_bin(std::size_t radial, std::size_t bin) const {
        float sum = 0;
        int count = 0;
        for (std::size_t i = 0; i < gates_per_bin_; ++i) {
            const std::size_t gate = bin * gates_per_bin_ + i;
            if (field_.row(radial)[gate] == 0 || field_.range_m(gate) <= 0) continue;
            sum += level_of(field_.value(radial, gate), field_.range_m(gate));
            ++count;
        }
        return count > 0 ? sum / static_cast<float>(count) : 0;
    }
    void find_sun(std::size_t radial) {
        std::vector<float> levels;
        for (std::size_t bin = 0; bin < bins_; ++bin)
            if (share(radial, bin) >= sunny_share) levels.push_back(level_of_bin(radial, bin));
        // Storms share the radial, so take the level that most bins have.
        std::ranges::sort(levels);
        std::size_t first = 0, most = 0;
        for (std::size_t begin = 0, end = 0; begin < levels.size(); ++begin) {
            while (end < levels.size() && levels[end] <= levels[begin] + 2 * sun_spread_db)
                ++end;
            if (end - begin <= most) continue;
            first = begin;
            most = end - begin;
        }
        if (most < least_sun_bins) return;
        const float common = levels[first + most / 2];
        for (std::size_t gate = 0; gate < field_.gates; ++gate)
            if (field_.row(radial)[gate] != 0 && field_.range_m(gate) > 0 &&
                std::abs(level_of(field_.value(radial, gate), field_.range_m(gate)) - common) <=
                    sun_gate_spread_db)
                mark(radial, gate, Spoke::sun);
    }

    const GateField& field_;
    const level2::Sweep& sweep_;
    std::size_t gates_per_bin_, bins_;
    std::vector<float> shares_;  // of gates with echo, radials x bins
    std::vector<Spoke> spokes_;
};

}  // namespace

std::vector<Spoke> find_spokes(const GateField& field, const level2::Sweep& sweep,
                               const std::optional<SunPosition>& sun) {
    if (field.is_empty()) return {};
    return SpokeFinder(field, sweep).find(sun);
}

}  // namespace stormcellar::retrieve
