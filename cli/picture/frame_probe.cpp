#include "cli/picture/frame_probe.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/floating_point.h"
#include "cli/shared/commands.h"
#include "grid/frame/named_place.h"
#include "render/products/section.h"
#include "render/view/length_text.h"
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
    if (valued && !probe.class_name.empty()) json["class"] = probe.class_name;
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
    const render::UnitFacts& distance = render::facts_of(scene.units.distance);
    const render::UnitFacts& height = render::facts_of(scene.units.height);
    const auto height_number = [&](double height_m) {
        return render::number_text(height_m / height.si, 4);
    };
    if (probe.distance_m)
        fmt::print(", {:.1f} {} from A", *probe.distance_m / distance.si, distance.symbol);
    fmt::print("\nvalue  {}", render::probe_text(probe, scene.units));
    if (probe.height_m) fmt::print(" at {} {}", height_number(*probe.height_m), height.symbol);
    if (probe.gate) {
        fmt::print(
            "\ngate   {} of radial {}: azimuth {:.2f}, elevation {:.2f} degrees, range {} {}\n"
            "time   {}\n",
            probe.gate->gate, probe.gate->radial, probe.gate->azimuth_deg,
            probe.gate->elevation_deg, render::number_text(probe.gate->range_m / distance.si),
            distance.symbol, format_utc(probe.gate->time));
    } else if (render::facts_of(scene.product).is_of_sweep) {
        fmt::print("\nseen   by no radial\n");
    } else if (probe.lowest_seen_m) {
        fmt::print("\nseen   {} to {} {}\n", height_number(*probe.lowest_seen_m),
                   height_number(*probe.highest_seen_m), height.symbol);
    } else {
        fmt::print("\nseen   at no height\n");
    }
}

Result<MaybeProbe> probe_grid(const FrameOptions& options, const render::Scene& scene,
                              const PictureGrid& file) {
    const auto facts = frame_facts_of(options.domain, file.description(), options.scene.time_zone);
    const int threads = render::thread_count(options.scene);
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
                        "--probe {} is outside the picture of {} x {} pixels: 0,0 to {},{}",
                        options.probe, scene.width, scene.height, scene.width - 1,
                        scene.height - 1);
        }
        return as_maybe(render::probe_pixel(file.view(), facts, scene, static_cast<int>(x),
                                            static_cast<int>(y), threads));
    }
    if (!options.probe_at.empty()) {
        const auto place = grid::parse_place("--probe-at", options.probe_at);
        if (!place) return pass_on(place);
        return as_maybe(render::probe_place(file.view(), facts, scene, *place, threads));
    }
    return MaybeProbe{};
}

}  // namespace stormcellar::cli
