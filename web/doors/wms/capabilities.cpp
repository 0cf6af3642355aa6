#include "web/doors/wms/capabilities.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "stormcellar/cache/grid_name.h"
#include "stormcellar/render/product.h"
#include "web/data/storms/rain_totals.h"
#include "web/doors/wms/request.h"
#include "web/doors/xml_writer.h"

namespace stormcellar::web {
namespace {

constexpr double most_mercator_latitude_deg = 85.0511;

// A moment of a domain, with the place of its newest grid and the times of all its grids.
struct MomentOfDomain {
    level2::Moment moment;
    render::EarthBox box;
    UtcTime newest;
    std::vector<UtcTime> times;
    bool names_totals;  // its times are those of rain totals
};

std::vector<MomentOfDomain> moments_of(MapPictures& pictures, const std::string& domain) {
    std::vector<MomentOfDomain> moments;
    Grids& grids = pictures.grids();
    for (const level2::Moment moment : grids.moments(domain)) {
        auto times = grids.times(domain, moment);
        const auto newest = grids.newest(domain, moment);
        if (times.empty() || !newest) continue;
        const auto grid = grids.find(domain, moment, *newest);
        if (!grid) continue;
        const render::EarthBox box = pictures.box_of(domain, (*grid)->file.description().spec);
        const bool names_totals =
            times.size() > 1 && moment == RainTotals::listed_moment(grids, domain);
        moments.push_back({moment, box, *newest, std::move(times), names_totals});
    }
    return moments;
}

// The styles of each layer, which are computed once for all domains.
class LayerStyles {
  public:
    const std::vector<std::string>& of(const MapProduct& layer) {
        for (const auto& [known, styles] : styles_)
            if (known == layer) return styles;
        return styles_.emplace_back(layer, wms_styles_of(layer)).second;
    }

  private:
    std::vector<std::pair<MapProduct, std::vector<std::string>>> styles_;
};

// Writes the document of version 1.3.0 or 1.1.1. The two versions name elements differently, and a
// DTD fixes the order of the elements in 1.1.1.
class CapabilitiesWriter {
  public:
    CapabilitiesWriter(WmsVersion version, std::string address)
        : is_older_(version == WmsVersion::v1_1_1), address_(std::move(address)) {}

    void begin();
    void write(const std::string& domain, const std::vector<MomentOfDomain>& moments);
    std::string take() { return xml_.take(); }

  private:
    void write_link(std::string_view address);
    void write_service();
    void write_operation(std::string_view name, std::initializer_list<std::string_view> formats);
    void write_box(const render::EarthBox& box);
    void write_times(const MomentOfDomain& moment);
    void write_styles(const std::string& layer, const std::vector<std::string>& styles);
    void write(const std::string& domain, const MomentOfDomain& moment);
    void write(const std::string& domain, const MapProduct& layer, const MomentOfDomain& moment);

    const bool is_older_;  // true: version 1.1.1
    const std::string address_;
    XmlWriter xml_;
    LayerStyles styles_;
};

void CapabilitiesWriter::begin() {
    if (is_older_) {
        xml_.open("WMT_MS_Capabilities", {{"version", "1.1.1"}});
    } else {
        xml_.open("WMS_Capabilities",
                  {{"version", "1.3.0"},
                   {"xmlns", "http://www.opengis.net/wms"},
                   {"xmlns:xlink", "http://www.w3.org/1999/xlink"},
                   {"xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance"},
                   {"xsi:schemaLocation",
                    "http://www.opengis.net/wms "
                    "http://schemas.opengis.net/wms/1.3.0/capabilities_1_3_0.xsd"}});
    }
    write_service();
    xml_.open("Capability").open("Request");
    write_operation("GetCapabilities", {is_older_ ? "application/vnd.ogc.wms_xml" : "text/xml"});
    write_operation("GetMap", {"image/png", "image/jpeg"});
    write_operation("GetFeatureInfo", {"text/plain", "application/json"});
    xml_.close();
    xml_.open("Exception").leaf("Format", is_older_ ? "application/vnd.ogc.se_xml" : "XML").close();
    xml_.open("Layer").leaf("Title", "stormcellar");
    if (is_older_) {
        for (const std::string_view system : {wms_systems[0], wms_systems[1], older_web_mercator})
            xml_.leaf("SRS", system);
    } else {
        for (const std::string_view system : wms_systems)
            xml_.leaf("CRS", system);
    }
}

void CapabilitiesWriter::write_link(std::string_view address) {
    if (is_older_) {
        xml_.empty("OnlineResource", {{"xmlns:xlink", "http://www.w3.org/1999/xlink"},
                                      {"xlink:type", "simple"},
                                      {"xlink:href", address}});
    } else {
        xml_.empty("OnlineResource", {{"xlink:type", "simple"}, {"xlink:href", address}});
    }
}

void CapabilitiesWriter::write_service() {
    xml_.open("Service")
        .leaf("Name", is_older_ ? "OGC:WMS" : "WMS")
        .leaf("Title", "stormcellar")
        .leaf(
            "Abstract",
            "Weather radars: maps of what they saw. What no beam saw is a thin gray veil; no echo "
            "is clear.");
    write_link(address_);
    if (!is_older_) {
        xml_.leaf("LayerLimit", std::to_string(most_wms_layers))
            .leaf("MaxWidth", std::to_string(most_wms_side))
            .leaf("MaxHeight", std::to_string(most_wms_side));
    }
    xml_.close();
}

void CapabilitiesWriter::write_operation(std::string_view name,
                                         std::initializer_list<std::string_view> formats) {
    xml_.open(name);
    for (const std::string_view format : formats)
        xml_.leaf("Format", format);
    xml_.open("DCPType").open("HTTP").open("Get");
    write_link(address_ + "?");
    xml_.close().close().close().close();
}

void CapabilitiesWriter::write_box(const render::EarthBox& box) {
    // In this standard, a box across the antimeridian must span all longitudes.
    const bool crosses = box.west_deg < -180 || box.east_deg > 180;
    const double west = crosses ? -180 : box.west_deg;
    const double east = crosses ? 180 : box.east_deg;
    const auto number = [](double value) { return fmt::format("{:.6f}", value); };
    if (is_older_) {
        xml_.empty("LatLonBoundingBox", {{"minx", number(west)},
                                         {"miny", number(box.south_deg)},
                                         {"maxx", number(east)},
                                         {"maxy", number(box.north_deg)}});
    } else {
        xml_.open("EX_GeographicBoundingBox")
            .leaf("westBoundLongitude", number(west))
            .leaf("eastBoundLongitude", number(east))
            .leaf("southBoundLatitude", number(box.south_deg))
            .leaf("northBoundLatitude", number(box.north_deg))
            .close();
    }
    const auto write = [&](std::string_view system, std::array<double, 4> ends) {
        xml_.empty("BoundingBox", {{is_older_ ? "SRS" : "CRS", system},
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
    if (is_older_) {
        write(wms_systems[1], {west, box.south_deg, east, box.north_deg});
    } else {
        write(wms_systems[1], {box.south_deg, west, box.north_deg, east});
        write(wms_systems[2], {west, box.south_deg, east, box.north_deg});
    }
}

void CapabilitiesWriter::write_times(const MomentOfDomain& moment) {
    std::vector<std::string> texts(moment.times.size());
    std::ranges::transform(moment.times, texts.begin(), format_utc);
    const std::string newest = format_utc(moment.newest);
    const std::string all = fmt::format("{}", fmt::join(texts, ","));
    if (is_older_) {
        xml_.empty("Dimension", {{"name", "time"}, {"units", "ISO8601"}});
        xml_.leaf("Extent", all, {{"name", "time"}, {"default", newest}, {"nearestValue", "1"}});
    } else {
        xml_.leaf("Dimension", all,
                  {{"name", "time"},
                   {"units", "ISO8601"},
                   {"default", newest},
                   {"nearestValue", "1"},
                   {"current", "1"}});
    }
}

// Writes the styles. 1.1.1 requires the size of each legend, which is known only after drawing, so
// in 1.1.1 styles have no legends.
void CapabilitiesWriter::write_styles(const std::string& layer,
                                      const std::vector<std::string>& styles) {
    for (const std::string& style : styles) {
        xml_.open("Style").leaf("Name", style).leaf("Title", style);
        if (!is_older_) {
            xml_.open("LegendURL").leaf("Format", "image/png");
            write_link(
                fmt::format("{}?SERVICE=WMS&VERSION=1.3.0&REQUEST=GetLegendGraphic&FORMAT="
                            "image%2Fpng&LAYER={}&STYLE={}",
                            address_, encoded(layer), encoded(style)));
            xml_.close();
        }
        xml_.close();
    }
}

void CapabilitiesWriter::write(const std::string& domain,
                               const std::vector<MomentOfDomain>& moments) {
    xml_.open("Layer").leaf("Title", domain);
    for (const MomentOfDomain& moment : moments)
        write(domain, moment);
    xml_.close();
}

void CapabilitiesWriter::write(const std::string& domain, const MomentOfDomain& moment) {
    xml_.open("Layer").leaf("Title",
                            fmt::format("{} {}", domain, level2::moment_name(moment.moment)));
    write_box(moment.box);
    for (const MapProduct& layer : map_products_of({moment.moment}))
        if (layer.hours == 0 || moment.names_totals) write(domain, layer, moment);
    xml_.close();
}

void CapabilitiesWriter::write(const std::string& domain, const MapProduct& layer,
                               const MomentOfDomain& moment) {
    const std::string name = wms_layer_name(domain, layer);
    xml_.open("Layer", {{"queryable", "1"}})
        .leaf("Name", name)
        .leaf("Title", fmt::format("{}: {}", domain, title_of(layer)));
    write_times(moment);
    write_styles(name, styles_.of(layer));
    xml_.close();
}

}  // namespace

std::string wms_capabilities(const Request& request, MapPictures& pictures) {
    const auto path = segments_of(request.path);
    const std::string_view alone = path.size() > 1 ? path[1] : std::string_view{};
    CapabilitiesWriter writer(wms_nearest_version(WmsParameters(request.query)),
                              request.base + (alone.empty() ? "/wms" : "/wms/" + encoded(alone)));
    writer.begin();
    for (const std::string& domain : pictures.grids().domains()) {
        if (cache::is_part(domain) || (!alone.empty() && domain != alone)) continue;
        const auto moments = moments_of(pictures, domain);
        if (!moments.empty()) writer.write(domain, moments);
    }
    return writer.take();
}

}  // namespace stormcellar::web
