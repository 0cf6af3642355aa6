// The operation that tells how to look at a grid as a volume.
#include "render/view/fitted_camera.h"
#include "stormcellar/render/product.h"
#include "web/doors/api/operations.h"

namespace stormcellar::web {
namespace {

ApiJson place_json(const render::Eye& place) {
    return {place.x_m, place.y_m, place.height_m};
}

}  // namespace

Answer api_view(const ApiCall& call) {
    const auto side = [&](std::string_view name, std::int64_t usual) {
        const auto& range = render::limits::side_px;
        return whole_parameter(call, name, static_cast<std::int64_t>(range.least),
                               static_cast<std::int64_t>(range.most), usual);
    };
    render::Scene scene;
    const auto width = side("width", scene.width);
    if (!width) return json_error(width.error());
    const auto height = side("height", scene.height);
    if (!height) return json_error(height.error());
    const auto grid = find_grid(call);
    if (!grid) return grid.error();
    scene.moment = (*grid)->file.description().moment;
    const render::EchoOutline outline((*grid)->file.view(), scene.moment);
    const render::FittedView fitted =
        render::fit_view(outline, scene, static_cast<int>(*width), static_cast<int>(*height));
    if (Status whole = (*grid)->file.check_whole(); !whole) return json_error(whole.error());
    const render::Camera& camera = fitted.camera;
    ApiJson json{{"domain", (*grid)->domain},
                 {"moment", level2::moment_name(scene.moment)},
                 {"time", format_utc((*grid)->time)}};
    json["camera"] = {{"azimuth_deg", camera.azimuth_deg},
                      {"tilt_deg", camera.tilt_deg},
                      {"field_of_view_deg", camera.field_of_view_deg},
                      {"place_m", camera.eye ? place_json(*camera.eye) : ApiJson()}};
    json["focus_m"] = place_json(fitted.focus);
    json["distance_m"] = fitted.distance_m;
    json["exaggeration"] = fitted.vertical_exaggeration;
    json["opacity"] = fitted.opacity;
    json["has_echo"] = fitted.has_echo;
    json["is_clear_air"] = scene.moment == level2::Moment::ref && render::is_clear_air(outline);
    return json_answer(call.request, json);
}

}  // namespace stormcellar::web
