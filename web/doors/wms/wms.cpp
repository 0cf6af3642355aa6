#include "web/doors/wms/wms.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/printable.h"
#include "web/data/grids/text_answer.h"
#include "web/doors/pictures/picture_answers.h"
#include "web/doors/wms/capabilities.h"
#include "web/doors/xml_writer.h"

namespace stormcellar::web {
namespace {

constexpr std::chrono::hours farthest_nearest{1};

// Answers with a fault. For clients of 1.1.1, the answer has a media type of its own, by which they
// recognize a fault.
Answer fault_answer(const Request& request, const WmsFault& fault) {
    const bool is_older = wms_nearest_version(WmsParameters(request.query)) == WmsVersion::v1_1_1;
    XmlWriter xml;
    if (is_older) {
        xml.open("ServiceExceptionReport", {{"version", "1.1.1"}});
    } else {
        xml.open("ServiceExceptionReport",
                 {{"version", "1.3.0"}, {"xmlns", "http://www.opengis.net/ogc"}});
    }
    if (fault.code.empty()) {
        xml.leaf("ServiceException", fault.text);
    } else {
        xml.leaf("ServiceException", fault.text, {{"code", fault.code}});
    }
    Answer answer = text_answer(fault.status,
                                is_older ? "application/vnd.ogc.se_xml" : "text/xml; charset=utf-8",
                                xml.take());
    if (fault.status == 503) answer.with("Retry-After", "2");
    return answer;
}

WmsFault fault_of(const Error& error) {
    return {"", without_paths(error.message) + ".", status_of(error)};
}

// The instant of a layer's grid, and the text for the header Warning. The text is empty if the
// request named exactly this instant.
struct ShownTime {
    UtcTime time;
    std::string warning;
};
WmsRead<ShownTime> shown_time(MapPictures& pictures, const WmsLayer& layer,
                              std::optional<UtcTime> asked) {
    const Grids& grids = pictures.grids();
    const level2::Moment moment = pictures.listed_moment(layer.domain, layer.style.layer);
    const auto newest = grids.newest(layer.domain, moment);
    if (!newest)
        return wms_fault("LayerNotDefined",
                         fmt::format("There is no grid of {} in '{}'.", level2::moment_name(moment),
                                     printable(layer.domain.substr(0, 80))),
                         404);
    if (!asked)
        return ShownTime{*newest, fmt::format("99 stormcellar \"Default value used: time={}\"",
                                              format_utc(*newest))};
    const auto times =
        grids.times(layer.domain, moment, *asked - farthest_nearest, *asked + farthest_nearest);
    const auto nearest = std::ranges::min_element(
        times, {}, [&](UtcTime time) { return std::chrono::abs(time - *asked); });
    if (nearest == times.end())
        return wms_fault("InvalidDimensionValue",
                         fmt::format("There is no grid within an hour of {}.", format_utc(*asked)),
                         404);
    if (*nearest == *asked) return ShownTime{*nearest, {}};
    return ShownTime{*nearest, fmt::format("99 stormcellar \"Nearest value used: time={}\"",
                                           format_utc(*nearest))};
}

void add_fields(Answer& answer, const Fields& fields) {
    for (const auto& [name, value] : fields)
        answer.with(name, value);
}

// Returns the name of the status with blanks, such as "range folded".
std::string word_of(grid::CellStatus status) {
    std::string word(grid::cell_status_name(status));
    std::ranges::replace(word, '_', ' ');
    return word;
}

// The value that one layer has at the requested place.
struct LayerValue {
    std::string layer, title, unit;
    UtcTime time;
    std::optional<MapValue> found;  // none: outside the grid
};

std::string plain_text(const std::vector<LayerValue>& values) {
    std::string text;
    for (const LayerValue& value : values) {
        std::string said = "outside of the grid";
        if (value.found && value.found->status == grid::CellStatus::value) {
            said = fmt::format("{:.2f}{}{}", value.found->value, value.unit.empty() ? "" : " ",
                               value.unit);
        } else if (value.found) {
            said = word_of(value.found->status);
        }
        text += fmt::format("{} ({}): {}\n", value.layer, format_utc(value.time), said);
    }
    return text;
}

std::string geo_json(const std::vector<LayerValue>& values, const grid::GeoPoint& place) {
    nlohmann::ordered_json features = nlohmann::ordered_json::array();
    for (const LayerValue& value : values) {
        nlohmann::ordered_json properties = {
            {"layer", value.layer}, {"title", value.title}, {"time", format_utc(value.time)},
            {"status", "outside"},  {"value", nullptr},     {"unit", value.unit}};
        if (value.found) properties["status"] = word_of(value.found->status);
        if (value.found && value.found->status == grid::CellStatus::value)
            properties["value"] = value.found->value;
        features.push_back(
            {{"type", "Feature"},
             {"geometry",
              {{"type", "Point"}, {"coordinates", {place.longitude_deg, place.latitude_deg}}}},
             {"properties", std::move(properties)}});
    }
    const nlohmann::ordered_json document = {{"type", "FeatureCollection"},
                                             {"features", std::move(features)}};
    return document.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

WmsRead<std::shared_ptr<const OpenGrid>> WmsDoor::opened(const std::string& domain,
                                                         const MapProduct& layer, UtcTime time) {
    auto grid = pictures_->find_grid(domain, layer, time);
    if (grid) return std::move(*grid);
    return tl::unexpected(fault_of(grid.error()));
}

WmsDoor::FindGrid WmsDoor::opener() {
    return [this](const std::string& domain, const MapProduct& layer, UtcTime time) {
        return opened(domain, layer, time);
    };
}

WmsRead<WmsDoor::TimedPicture> WmsDoor::timed_picture(const WmsMap& map,
                                                      const FindGrid& find) const {
    TimedPicture timed{{{}, map.window, map.ground, map.is_jpeg ? ".jpg" : ".png"}, {}, {}};
    if (map.time) timed.max_age = answer_holds_for;
    for (const WmsLayer& layer : map.layers) {
        auto shown = shown_time(*pictures_, layer, map.time);
        if (!shown) return tl::unexpected(shown.error());
        auto grid = find(layer.domain, layer.style.layer, shown->time);
        if (!grid) return tl::unexpected(grid.error());
        if ((*grid)->may_change() || layer.style.layer.hours > 0) timed.max_age.reset();
        timed.picture.layers.push_back({std::move(*grid), layer.style});
        if (!shown->warning.empty()) {
            // A grid that is nearer may still come.
            timed.max_age.reset();
            timed.warnings.emplace_back("Warning", shown->warning);
        }
    }
    return timed;
}

std::optional<Answer> WmsDoor::answer_at_once(const Request& request) {
    const WmsParameters parameters(request.query);
    if (parameters.find("REQUEST") != "GetMap") return std::nullopt;
    const auto map = wms_map(parameters, now_utc());
    if (!map) return fault_answer(request, map.error());
    const auto timed =
        timed_picture(*map,
                      [this](const std::string& domain, const MapProduct& layer,
                             UtcTime time) -> WmsRead<std::shared_ptr<const OpenGrid>> {
                          auto grid = pictures_->find_grid_if_open(domain, layer, time);
                          if (!grid) return wms_fault("", "The grid is not open.");
                          return grid;
                      });
    if (!timed) return std::nullopt;
    const auto kept = pictures_->find(timed->picture);
    if (!kept) return std::nullopt;
    Answer answer = picture_answer(request, *kept, timed->max_age);
    add_fields(answer, timed->warnings);
    return answer;
}

Answer WmsDoor::answer(const Request& request) {
    const WmsParameters parameters(request.query);
    if (segments_of(request.path).size() > 2)
        return sentence(404, "The map service is at /wms, and that of one domain at /wms/DOMAIN.");
    const std::string_view asked = parameters.find("REQUEST").value_or("");
    if (asked == "GetCapabilities" || asked == "capabilities") return capabilities(request);
    if (asked == "GetMap" || asked == "map") return map(request);
    if (asked == "GetFeatureInfo") return feature_info(request);
    if (asked == "GetLegendGraphic") return legend(request);
    return fault_answer(request,
                        {"OperationNotSupported",
                         "REQUEST is GetCapabilities, GetMap, GetFeatureInfo or GetLegendGraphic. "
                         "Begin with /wms?SERVICE=WMS&REQUEST=GetCapabilities."});
}

Answer WmsDoor::capabilities(const Request& request) {
    const WmsParameters parameters(request.query);
    const std::string_view service = parameters.find("SERVICE").value_or("WMS");
    if (service != "WMS")
        return fault_answer(request, {"", fmt::format("SERVICE is WMS here, not '{}'.",
                                                      printable(service.substr(0, 80)))});
    const auto path = segments_of(request.path);
    if (path.size() > 1 && pictures_->grids().moments(path[1]).empty())
        return fault_answer(request, {"", "There is no such domain.", 404});
    const bool is_older = wms_nearest_version(parameters) == WmsVersion::v1_1_1;
    return text_answer_to(request,
                          is_older ? "application/vnd.ogc.wms_xml" : "text/xml; charset=utf-8",
                          wms_capabilities(request, *pictures_));
}

Answer WmsDoor::map(const Request& request) {
    const auto map = wms_map(WmsParameters(request.query), now_utc());
    if (!map) return fault_answer(request, map.error());
    const auto timed = timed_picture(*map, opener());
    if (!timed) return fault_answer(request, timed.error());
    if (auto unchanged = unchanged_answer(request, timed->picture.etag(), timed->max_age))
        return *unchanged;
    const auto drawn = pictures_->find_or_draw(timed->picture);
    if (!drawn) return fault_answer(request, fault_of(drawn.error()));
    Answer answer = picture_answer(request, *drawn, timed->max_age);
    add_fields(answer, timed->warnings);
    return answer;
}

Answer WmsDoor::feature_info(const Request& request) {
    const WmsParameters parameters(request.query);
    auto map = wms_map(parameters, now_utc());
    if (!map) return fault_answer(request, map.error());
    const auto names = parameters.find("QUERY_LAYERS");
    if (!names) return fault_answer(request, {"LayerNotDefined", "QUERY_LAYERS is missing."});
    auto layers = wms_layers(parameters, *names, "");
    if (!layers) return fault_answer(request, layers.error());
    const auto pixel = wms_pixel(parameters, map->window);
    if (!pixel) return fault_answer(request, pixel.error());
    const std::string_view format = parameters.find("INFO_FORMAT").value_or("text/plain");
    if (format != "text/plain" && format != "application/json")
        return fault_answer(request,
                            {"InvalidFormat", "INFO_FORMAT is text/plain or application/json."});
    map->layers = std::move(*layers);
    const auto timed = timed_picture(*map, opener());
    if (!timed) return fault_answer(request, timed.error());
    const grid::GeoPoint place = place_of(*pixel, map->window);
    std::vector<LayerValue> values;
    for (const PictureLayer& layer : timed->picture.layers) {
        const auto found = pictures_->value_at(layer, place);
        if (!found) return fault_answer(request, fault_of(found.error()));
        const render::Scene& scene = layer.style.scene;
        values.push_back({wms_layer_name(layer.grid->domain, layer.style.layer),
                          title_of(layer.style.layer, scene), render::unit_shown(scene),
                          layer.grid->time, *found});
    }
    if (format == "text/plain")
        return text_answer_to(request, "text/plain; charset=utf-8", plain_text(values));
    return text_answer_to(request, "application/json", geo_json(values, place));
}

Answer WmsDoor::legend(const Request& request) {
    const WmsParameters parameters(request.query);
    const auto name = parameters.find("LAYER");
    if (!name) return fault_answer(request, {"LayerNotDefined", "LAYER is missing."});
    const auto layers = wms_layers(parameters, *name, parameters.find("STYLE").value_or(""));
    if (!layers) return fault_answer(request, layers.error());
    if (layers->size() != 1)
        return fault_answer(request, {"LayerNotDefined", "LAYER is one layer, not a list."});
    const WmsLayer& layer = layers->front();
    const auto shown = shown_time(*pictures_, layer, {});
    if (!shown) return fault_answer(request, shown.error());
    // The colors of a rain total do not depend on the total.
    const level2::Moment moment = pictures_->listed_moment(layer.domain, layer.style.layer);
    auto grid = opened(layer.domain, {layer.style.layer.product, moment}, shown->time);
    if (!grid) return fault_answer(request, grid.error());
    const auto drawn = MapPictures::legend({std::move(*grid), layer.style});
    if (!drawn) return fault_answer(request, fault_of(drawn.error()));
    return picture_answer(request, *drawn, {});
}

}  // namespace stormcellar::web
