#include "cli/files/echo_report.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "stormcellar/retrieve/echo_kinds.h"
#include "stormcellar/retrieve/melting_layer.h"

namespace stormcellar::cli {
namespace {

using retrieve::EchoKind;
using retrieve::EchoShares;

struct VolumeEcho {
    EchoShares shares;
    Result<retrieve::MeltingLayer> melting;
    std::optional<double> antenna_m;  // above mean sea level
};

std::vector<VolumeEcho> echo_of_volumes(const level2::Decoded& decoded) {
    std::vector<VolumeEcho> all;
    for (const level2::Volume& volume : level2::split_volumes(decoded)) {
        const auto antenna = level2::antenna_position(volume);
        all.push_back({retrieve::echo_shares(
                           retrieve::echo_kinds(volume, retrieve::weather_probabilities(volume))),
                       retrieve::melting_layer(volume),
                       antenna ? std::optional(antenna->altitude_m) : std::nullopt});
    }
    return all;
}

std::string melting_text(const VolumeEcho& echo) {
    if (!echo.melting) return echo.melting.error().message;
    const retrieve::LayerHeights& heights = echo.melting->heights;
    const double antenna_km = echo.antenna_m.value_or(0) / 1000;
    return fmt::format("melting layer from {:.2f} to {:.2f} km above {}, +- {:.2f} and {:.2f} km",
                       heights.bottom_m / 1000 + antenna_km, heights.top_m / 1000 + antenna_km,
                       echo.antenna_m ? "sea level" : "the antenna", heights.bottom_error_m / 1000,
                       heights.top_error_m / 1000);
}

nlohmann::ordered_json melting_json(const VolumeEcho& echo) {
    nlohmann::ordered_json json;
    if (!echo.melting) {
        json["none"] = echo.melting.error().message;
        return json;
    }
    const retrieve::LayerHeights& heights = echo.melting->heights;
    json["bottom_m_above_antenna"] = heights.bottom_m;
    json["top_m_above_antenna"] = heights.top_m;
    json["bottom_error_m"] = heights.bottom_error_m;
    json["top_error_m"] = heights.top_error_m;
    if (echo.antenna_m) json["antenna_m"] = *echo.antenna_m;
    return json;
}

// Calls `visit` with each kind of echo.
template <class Visit>
void for_each_kind(Visit visit) {
    for (std::size_t i = static_cast<std::size_t>(EchoKind::weather); i < retrieve::echo_kind_count;
         ++i)
        visit(static_cast<EchoKind>(i));
}

}  // namespace

void print_echo(const level2::Decoded& decoded) {
    const std::vector<VolumeEcho> volumes = echo_of_volumes(decoded);
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        const std::string number = volumes.size() > 1 ? fmt::format(" of volume {}", i + 1) : "";
        fmt::print("\n{:<30}{:>9}\n", "echo" + number, "share");
        for_each_kind([&](EchoKind kind) {
            fmt::print("  {:<28}{:>7.2f} %\n", retrieve::echo_kind_name(kind),
                       100 * volumes[i].shares.share(kind));
        });
        fmt::print("  gates with echo{:>22}\n", volumes[i].shares.gates);
        fmt::print("  {}\n", melting_text(volumes[i]));
    }
}

nlohmann::ordered_json echo_json(const level2::Decoded& decoded) {
    auto list = nlohmann::ordered_json::array();
    for (const VolumeEcho& echo : echo_of_volumes(decoded)) {
        nlohmann::ordered_json percent;
        for_each_kind([&](EchoKind kind) {
            std::string key(retrieve::echo_kind_name(kind));
            std::ranges::replace(key, ' ', '_');
            percent[key] = 100 * echo.shares.share(kind);
        });
        list.push_back({{"gates", echo.shares.gates},
                        {"percent", std::move(percent)},
                        {"melting_layer", melting_json(echo)}});
    }
    return list;
}

}  // namespace stormcellar::cli
