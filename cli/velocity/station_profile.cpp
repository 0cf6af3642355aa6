#include "cli/velocity/station_profile.h"

#include <algorithm>
#include <utility>

namespace stormcellar::cli {
namespace {

Result<StationProfile> profile_of(const level2::Volume& volume, const InputFile& file,
                                  const ProfileRequest& request) {
    const auto antenna = level2::antenna_position(volume);
    if (!antenna) {
        return fail(ErrorCode::not_found,
                    "{}: neither the file nor the station table gives the position of the radar{}",
                    file.label, how_to_place);
    }
    StationProfile profile;
    profile.file = file.file_name();
    profile.station = volume.station;
    profile.time = volume.start_time();
    profile.antenna_altitude_m = antenna->altitude_m;
    auto layers = retrieve::wind_profile(
        volume, retrieve::dealias(volume, retrieve::Dealiasing::anchored), request.wind);
    if (!layers) return fail(layers.error().code, "{}: {}", file.label, layers.error().message);
    profile.layers = std::move(*layers);
    profile.motions = retrieve::bunkers_motions(profile.layers);
    return profile;
}

}  // namespace

bool StationProfile::has_wind() const {
    return std::ranges::any_of(
        layers, [](const retrieve::WindLayer& layer) { return layer.wind.has_value(); });
}

Result<std::vector<StationProfile>> profiles_of(InputFiles& inputs, const InputFile& file,
                                                const ProfileRequest& request) {
    level2::DecodeOptions options;
    options.threads = request.threads;
    auto decoded = inputs.decode(file, options);
    if (!decoded) return pass_on(decoded);
    if (Status applied = apply_site(request.site, decoded->volume); !applied)
        return pass_on(applied);
    std::vector<StationProfile> profiles;
    for (const level2::Volume& volume : level2::split_volumes(std::move(*decoded))) {
        auto profile = profile_of(volume, file, request);
        if (!profile) return pass_on(profile);
        profiles.push_back(std::move(*profile));
    }
    return profiles;
}

}  // namespace stormcellar::cli
