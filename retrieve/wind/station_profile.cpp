#include "retrieve/wind/station_profile.h"

#include <algorithm>
#include <utility>

namespace stormcellar::retrieve {
namespace {

using nlohmann::ordered_json;

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
        json["reason"] = text_of(layer.wind.error());
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

bool StationProfile::has_wind() const {
    return std::ranges::any_of(layers,
                               [](const WindLayer& layer) { return layer.wind.has_value(); });
}

Result<StationProfile> station_profile(const level2::Volume& volume, std::string file,
                                       const WindProfileOptions& options) {
    const auto antenna = level2::antenna_position(volume);
    if (!antenna) {
        return fail(ErrorCode::not_found,
                    "neither the file nor the station table gives the position of the radar");
    }
    auto layers = wind_profile(volume, dealias(volume, Dealiasing::anchored), options);
    if (!layers) return pass_on(layers);
    auto motions = bunkers_motions(*layers);
    return StationProfile{std::move(file),     volume.station,     volume.start_time(),
                          antenna->altitude_m, std::move(*layers), std::move(motions)};
}

ordered_json profile_json(const StationProfile& profile) {
    ordered_json json = {
        {"file", profile.file},
        {"station", profile.station},
        {"time", profile.time ? ordered_json(format_utc(*profile.time)) : ordered_json(nullptr)},
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

}  // namespace stormcellar::retrieve
