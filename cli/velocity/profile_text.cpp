#include "cli/velocity/profile_text.h"

#include "cli/shared/commands.h"
#include "cli/shared/query_options.h"

namespace stormcellar::cli {
namespace {

using nlohmann::ordered_json;
using retrieve::Birds;
using retrieve::LayerWind;
using retrieve::Motion;
using retrieve::NoWind;
using retrieve::WindLayer;

std::string_view birds_text(Birds birds) {
    switch (birds) {
        case Birds::none:
            return "none";
        case Birds::possible:
            return "possible";
        case Birds::likely:
            return "likely";
    }
    return "unknown";
}

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

ordered_json motion_json(const Motion& motion) {
    return {{"direction_deg", motion.direction_deg()},
            {"speed_mps", motion.speed_mps()},
            {"u_mps", motion.u_mps},
            {"v_mps", motion.v_mps}};
}

ordered_json layer_json(const WindLayer& layer, double antenna_altitude_m) {
    ordered_json json = {{"bottom_m", antenna_altitude_m + layer.bottom_m},
                         {"top_m", antenna_altitude_m + layer.top_m}};
    if (!layer.wind) {
        json["reason"] = retrieve::text_of(layer.wind.error());
        return json;
    }
    const LayerWind& wind = *layer.wind;
    json.update(motion_json(wind.motion));
    json["w_mps"] = wind.w_mps ? ordered_json(*wind.w_mps) : ordered_json(nullptr);
    json["u_error_mps"] = wind.u_error_mps;
    json["v_error_mps"] = wind.v_error_mps;
    json["rms_mps"] = wind.rms_mps;
    json["gates"] = wind.gates;
    json["rejected_gates"] = wind.rejected_gates;
    json["gap_deg"] = wind.gap_deg;
    json["birds"] = birds_text(wind.birds);
    return json;
}

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

ordered_json profile_json(const StationProfile& profile) {
    ordered_json json = {{"file", profile.file},
                         {"station", profile.station},
                         {"time", json_time(profile.time)},
                         {"antenna_altitude_m", profile.antenna_altitude_m},
                         {"layers", ordered_json::array()}};
    for (const WindLayer& layer : profile.layers)
        json["layers"].push_back(layer_json(layer, profile.antenna_altitude_m));
    if (profile.motions) {
        json["storm_motion"] = {{"right", motion_json(profile.motions->right)},
                                {"left", motion_json(profile.motions->left)},
                                {"mean", motion_json(profile.motions->mean)}};
    } else {
        json["storm_motion"] = nullptr;
        json["storm_motion_reason"] = profile.motions.error().message;
    }
    return json;
}

}  // namespace stormcellar::cli
