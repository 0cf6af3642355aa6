#include "cli/picture/frame_probe.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/floating_point.h"
#include "cli/shared/commands.h"
#include "render/products/section.h"
#include "stormcellar/render/product.h"

namespace stormcellar::cli {
namespace {

using Json = nlohmann::ordered_json;

Json json_or_null(const std::optional<double>& number) {
    return number ? Json(*number) : Json();
}

}  // namespace

nlohmann::ordered_json json_of(const render::Probe& probe) {
    const bool valued = probe.status == grid::CellStatus::value;
    Json json{{"latitude_deg", probe.place.latitude_deg},
              {"longitude_deg", probe.place.longitude_deg},
              {"status", grid::cell_status_name(probe.status)},
              {"value", valued ? Json(probe.value) : Json()},
              {"unit", probe.unit},
              {"at_least", probe.at_least},
              {"height_m", json_or_null(probe.height_m)},
              {"lowest_seen_m", json_or_null(probe.lowest_seen_m)},
              {"highest_seen_m", json_or_null(probe.highest_seen_m)}};
    if (probe.distance_m) json["distance_m"] = *probe.distance_m;
    if (probe.gate) {
        json["gate"] = {
            {"radial", probe.gate->radial},           {"gate", probe.gate->gate},
            {"azimuth_deg", probe.gate->azimuth_deg}, {"elevation_deg", probe.gate->elevation_deg},
            {"range_m", probe.gate->range_m},         {"time", format_utc(probe.gate->time)}};
    }
    return json;
}

void print_probe(const render::Probe& probe, const FrameOptions& options,
                 const render::Scene& scene, const cache::GridDescription& grid) {
    fmt::print("{} {}, {}\n", printable(options.domain), format_utc(grid.time),
               render::product_title(scene));
    fmt::print("place  {}", render::place_text(probe.place));
    if (probe.distance_m) fmt::print(", {:.1f} km from A", *probe.distance_m / 1000);
    fmt::print("\nvalue  {}", render::probe_text(probe));
    if (probe.height_m) fmt::print(" at {:.4g} km", *probe.height_m / 1000);
    if (probe.gate) {
        fmt::print(
            "\ngate   {} of radial {}: azimuth {:.2f}, elevation {:.2f} degrees, range {:g} km\n"
            "time   {}\n",
            probe.gate->gate, probe.gate->radial, probe.gate->azimuth_deg,
            probe.gate->elevation_deg, probe.gate->range_m / 1000, format_utc(probe.gate->time));
    } else if (render::facts_of(scene.product).is_of_sweep) {
        fmt::print("\nseen   by no radial\n");
    } else if (probe.lowest_seen_m) {
        fmt::print("\nseen   {:g} to {:g} km\n", *probe.lowest_seen_m / 1000,
                   *probe.highest_seen_m / 1000);
    } else {
        fmt::print("\nseen   at no height\n");
    }
}

Result<MaybeProbe> probe_grid(const FrameOptions& options, const render::Scene& scene,
                              const PictureGrid& file) {
    const auto facts = facts_of(options.domain, file.description(), options.scene.time_zone);
    const int threads = thread_count(options.scene);
    const auto as_maybe = [](Result<render::Probe> probe) -> Result<MaybeProbe> {
        if (!probe) return pass_on(probe);
        return MaybeProbe{std::move(*probe)};
    };
    if (!options.probe.empty()) {
        const auto pixel = numbers_of("--probe", options.probe, 2);
        if (!pixel) return pass_on(pixel);
        const double x = (*pixel)[0];
        const double y = (*pixel)[1];
        if (std::floor(x) != x || std::floor(y) != y) {
            return fail(ErrorCode::bad_argument, "--probe needs two whole numbers, not '{}'",
                        options.probe);
        }
        if (!is_within(x, 0.0, scene.width - 1.0) || !is_within(y, 0.0, scene.height - 1.0)) {
            return fail(ErrorCode::bad_argument,
                        "--probe {} lies outside the picture of {} x {} pixels: 0,0 to {},{}",
                        options.probe, scene.width, scene.height, scene.width - 1,
                        scene.height - 1);
        }
        return as_maybe(render::probe_pixel(file.view(), facts, scene, static_cast<int>(x),
                                            static_cast<int>(y), threads));
    }
    if (!options.probe_at.empty()) {
        const auto place = numbers_of("--probe-at", options.probe_at, 2);
        if (!place) return pass_on(place);
        return as_maybe(
            render::probe_place(file.view(), facts, scene, {(*place)[0], (*place)[1]}, threads));
    }
    return MaybeProbe{};
}

}  // namespace stormcellar::cli
