#include "cli/velocity/profile_text.h"

#include "cli/shared/commands.h"
#include "cli/shared/query_options.h"

namespace stormcellar::cli {
namespace {

using retrieve::Birds;
using retrieve::LayerWind;
using retrieve::Motion;
using retrieve::NoWind;
using retrieve::StationProfile;
using retrieve::WindLayer;

class ProfileTable {
  public:
    ProfileTable(const StationProfile& profile, const render::Units& units)
        : profile_(profile),
          height_(render::facts_of(units.height)),
          speed_(render::facts_of(units.speed)) {}

    [[nodiscard]] std::string rows() const {
        std::string text = fmt::format("{:>8} {:>5} {:>6} {:>6} {:>6} {:>7} {:>4}\n", "height",
                                       "from", "speed", "error", "rms", "gates", "gap");
        text += fmt::format("{:>8} {:>5} {:>6} {:>6} {:>6} {:>7} {:>4}\n", height_.symbol, "deg",
                            speed_.symbol, speed_.symbol, speed_.symbol, "", "deg");
        const std::vector<WindLayer>& layers = profile_.layers;
        for (std::size_t i = 0; i < end_of_echo();) {
            if (layers[i].wind) {
                text += row(layers[i]);
                ++i;
                continue;
            }
            std::size_t last = i;
            while (last + 1 < end_of_echo() && !layers[last + 1].wind &&
                   layers[last + 1].wind.error() == layers[i].wind.error())
                ++last;
            const std::string end = last == i ? "" : fmt::format(" to {}", height(layers[last]));
            text += fmt::format("{:>8}{}  {}\n", height(layers[i]), end,
                                retrieve::text_of(layers[i].wind.error()));
            i = last + 1;
        }
        return text;
    }

    [[nodiscard]] std::string motion(std::string_view name, const Motion& motion) const {
        return fmt::format("  {:<12} {:.0f}/{:.1f}\n", name, direction(motion),
                           motion.speed_mps() / speed_.si);
    }

  private:
    // Returns the number of layers up to the highest with any echo.
    [[nodiscard]] std::size_t end_of_echo() const {
        std::size_t end = 0;
        for (std::size_t i = 0; i < profile_.layers.size(); ++i) {
            const auto& wind = profile_.layers[i].wind;
            if (wind || wind.error() != NoWind::no_echo) end = i + 1;
        }
        return end;
    }

    [[nodiscard]] static double direction(const Motion& motion) {
        return std::fmod(std::round(motion.direction_deg()), 360.0);
    }

    [[nodiscard]] std::string height(const WindLayer& layer) const {
        const double shown = (profile_.antenna_altitude_m + layer.middle_m()) / height_.si;
        return fmt::format("{:.{}f}", shown, height_.si < 1 ? 0 : 2);
    }

    [[nodiscard]] std::string row(const WindLayer& layer) const {
        const LayerWind& wind = *layer.wind;
        const double error = std::max(wind.u_error_mps, wind.v_error_mps);
        const std::string_view birds = wind.birds == Birds::none     ? ""
                                       : wind.birds == Birds::likely ? "  birds"
                                                                     : "  birds?";
        return fmt::format("{:>8} {:>5.0f} {:>6.1f} {:>6.1f} {:>6.1f} {:>7} {:>4.0f}{}\n",
                           height(layer), direction(wind.motion),
                           wind.motion.speed_mps() / speed_.si, error / speed_.si,
                           wind.rms_mps / speed_.si, wind.gates, wind.gap_deg, birds);
    }

    const StationProfile& profile_;
    const render::UnitFacts& height_;
    const render::UnitFacts& speed_;
};

}  // namespace

std::string method_text(const retrieve::WindProfileOptions& options) {
    return fmt::format("VVP in layers of {:g} m, from gates {:g} to {:g} km away", options.layer_m,
                       options.least_range_m / 1000, options.most_range_m / 1000);
}

std::string profile_table(const StationProfile& profile,
                          const retrieve::WindProfileOptions& options, const render::Units& units) {
    const ProfileTable table(profile, units);
    std::string text =
        fmt::format("{} {} ({})\n{}; heights above sea level, antenna at {:.0f} m\n\n",
                    profile.station.empty() ? "unknown station" : printable(profile.station),
                    profile.time ? format_utc(*profile.time) : "at an unknown time",
                    printable(profile.file), method_text(options), profile.antenna_altitude_m);
    text += table.rows();
    if (!profile.motions)
        return text + fmt::format("\nno storm motion: {}\n", profile.motions.error().message);
    text += fmt::format("\nstorm motion (Bunkers et al. 2000), from degrees/{}\n",
                        render::facts_of(units.speed).symbol);
    text += table.motion("right mover", profile.motions->right);
    text += table.motion("left mover", profile.motions->left);
    return text + table.motion("mean wind", profile.motions->mean);
}

}  // namespace stormcellar::cli
