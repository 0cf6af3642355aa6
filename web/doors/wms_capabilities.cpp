#include "web/doors/wms_capabilities.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "stormcellar/cache/grid_name.h"
#include "stormcellar/render/product.h"
#include "web/doors/wms_request.h"
#include "web/doors/xml_writer.h"

namespace stormcellar::web {
namespace {

constexpr double most_mercator_latitude_deg = 85.0511;

void write_link(XmlWriter& xml, std::string_view address) {
    xml.empty("OnlineResource", {{"xlink:type", "simple"}, {"xlink:href", address}});
}

void write_service(XmlWriter& xml, const std::string& address) {
    xml.open("Service")
        .leaf("Name", "WMS")
        .leaf("Title", "stormcellar")
        .leaf(
            "Abstract",
            "Weather radars: maps of what they saw. What no beam saw is a thin gray veil; no echo "
            "is clear.");
    write_link(xml, address);
    xml.leaf("LayerLimit", std::to_string(most_wms_layers))
        .leaf("MaxWidth", std::to_string(most_wms_side))
        .leaf("MaxHeight", std::to_string(most_wms_side))
        .close();
}

void write_operation(XmlWriter& xml, std::string_view name,
                     std::initializer_list<std::string_view> formats, const std::string& address) {
    xml.open(name);
    for (const std::string_view format : formats)
        xml.leaf("Format", format);
    xml.open("DCPType").open("HTTP").open("Get");
    write_link(xml, address + "?");
    xml.close().close().close().close();
}

void write_box(XmlWriter& xml, const render::EarthBox& box) {
    // About the antimeridian, a box of this standard is all longitudes.
    const bool crosses = box.west_deg < -180 || box.east_deg > 180;
    const double west = crosses ? -180 : box.west_deg;
    const double east = crosses ? 180 : box.east_deg;
    const auto number = [](double value) { return fmt::format("{:.6f}", value); };
    xml.open("EX_GeographicBoundingBox")
        .leaf("westBoundLongitude", number(west))
        .leaf("eastBoundLongitude", number(east))
        .leaf("southBoundLatitude", number(box.south_deg))
        .leaf("northBoundLatitude", number(box.north_deg))
        .close();
    const auto write = [&](std::string_view system, std::array<double, 4> ends) {
        xml.empty("BoundingBox", {{"CRS", system},
                                  {"minx", number(ends[0])},
                                  {"miny", number(ends[1])},
                                  {"maxx", number(ends[2])},
                                  {"maxy", number(ends[3])}});
    };
    const auto y_of = [](double latitude) {
        return render::mercator_y_m(
            std::clamp(latitude, -most_mercator_latitude_deg, most_mercator_latitude_deg));
    };
    const double m_of_degree = render::mercator_edge_m / 180;
    write(wms_systems[0],
          {west * m_of_degree, y_of(box.south_deg), east * m_of_degree, y_of(box.north_deg)});
    write(wms_systems[1], {box.south_deg, west, box.north_deg, east});
    write(wms_systems[2], {west, box.south_deg, east, box.north_deg});
}

// One fact a moment: where its newest grid is, and when there are grids.
struct MomentOfDomain {
    level2::Moment moment;
    render::EarthBox box;
    std::vector<UtcTime> times;
};

std::vector<MomentOfDomain> moments_of(MapPictures& pictures, const std::string& domain) {
    std::vector<MomentOfDomain> moments;
    Grids& grids = pictures.grids();
    for (const level2::Moment moment : grids.moments(domain)) {
        auto times = grids.times(domain, moment);
        if (times.empty()) continue;
        const auto grid = grids.find(domain, moment, times.back());
        if (!grid) continue;
        const render::EarthBox box = pictures.box_of(domain, (*grid)->file.description().spec);
        moments.push_back({moment, box, std::move(times)});
    }
    return moments;
}

void write_styles(XmlWriter& xml, const std::string& layer, const std::vector<std::string>& styles,
                  const std::string& address) {
    for (const std::string& style : styles) {
        xml.open("Style").leaf("Name", style).leaf("Title", style).open("LegendURL");
        xml.leaf("Format", "image/png");
        write_link(xml, fmt::format("{}?SERVICE=WMS&VERSION=1.3.0&REQUEST=GetLegendGraphic&FORMAT="
                                    "image%2Fpng&LAYER={}&STYLE={}",
                                    address, encoded(layer), encoded(style)));
        xml.close().close();
    }
}

// The styles of each layer, worked out once for all domains.
class LayerStyles {
  public:
    const std::vector<std::string>& of(const MapLayer& layer) {
        for (const auto& [known, styles] : styles_)
            if (known == layer) return styles;
        return styles_.emplace_back(layer, wms_styles_of(layer)).second;
    }

  private:
    std::vector<std::pair<MapLayer, std::vector<std::string>>> styles_;
};

class LayerWriter {
  public:
    LayerWriter(XmlWriter& xml, std::string address) : xml_(xml), address_(std::move(address)) {}

    void write(const std::string& domain, const std::vector<MomentOfDomain>& moments) {
        xml_.open("Layer").leaf("Title", domain);
        for (const MomentOfDomain& moment : moments)
            write(domain, moment);
        xml_.close();
    }

  private:
    void write(const std::string& domain, const MomentOfDomain& moment) {
        xml_.open("Layer").leaf("Title",
                                fmt::format("{} {}", domain, level2::moment_name(moment.moment)));
        write_box(xml_, moment.box);
        write_times(moment.times);
        for (const MapLayer& layer : map_layers_of({moment.moment}))
            write(domain, layer);
        xml_.close();
    }

    void write_times(const std::vector<UtcTime>& times) {
        std::vector<std::string> texts(times.size());
        std::ranges::transform(times, texts.begin(), format_utc);
        xml_.leaf("Dimension", fmt::format("{}", fmt::join(texts, ",")),
                  {{"name", "time"},
                   {"units", "ISO8601"},
                   {"default", texts.back()},
                   {"nearestValue", "1"},
                   {"current", "1"}});
    }

    void write(const std::string& domain, const MapLayer& layer) {
        render::Scene scene;
        scene.product = layer.product;
        scene.moment = layer.moment;
        const std::string name = wms_layer_name(domain, layer);
        xml_.open("Layer", {{"queryable", "1"}})
            .leaf("Name", name)
            .leaf("Title", fmt::format("{}: {}", domain, render::product_title(scene)));
        write_styles(xml_, name, styles_.of(layer), address_);
        xml_.close();
    }

    XmlWriter& xml_;
    std::string address_;
    LayerStyles styles_;
};

}  // namespace

std::string wms_capabilities(const Request& request, MapPictures& pictures) {
    const std::string address = request.base + "/wms";
    XmlWriter xml;
    xml.open("WMS_Capabilities", {{"version", "1.3.0"},
                                  {"xmlns", "http://www.opengis.net/wms"},
                                  {"xmlns:xlink", "http://www.w3.org/1999/xlink"},
                                  {"xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance"},
                                  {"xsi:schemaLocation",
                                   "http://www.opengis.net/wms "
                                   "http://schemas.opengis.net/wms/1.3.0/capabilities_1_3_0.xsd"}});
    write_service(xml, address);
    xml.open("Capability").open("Request");
    write_operation(xml, "GetCapabilities", {"text/xml"}, address);
    write_operation(xml, "GetMap", {"image/png", "image/jpeg"}, address);
    write_operation(xml, "GetFeatureInfo", {"text/plain", "application/json"}, address);
    xml.close().open("Exception").leaf("Format", "XML").close();
    xml.open("Layer").leaf("Title", "stormcellar");
    for (const std::string_view system : wms_systems)
        xml.leaf("CRS", system);
    LayerWriter writer(xml, address);
    for (const std::string& domain : pictures.grids().domains()) {
        if (cache::is_part(domain)) continue;
        const auto moments = moments_of(pictures, domain);
        if (!moments.empty()) writer.write(domain, moments);
    }
    return xml.take();
}

}  // namespace stormcellar::web
