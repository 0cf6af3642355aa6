#include "web/doors/thredds/answers.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "web/doors/xml_writer.h"

namespace stormcellar::web {
namespace {

constexpr std::string_view catalog_namespace =
    "http://www.unidata.ucar.edu/namespaces/thredds/InvCatalog/v1.0";
constexpr std::string_view link_namespace = "http://www.w3.org/1999/xlink";

void open_catalog(XmlWriter& xml, std::string_view name) {
    xml.open("catalog", {{"xmlns", catalog_namespace},
                         {"xmlns:xlink", link_namespace},
                         {"name", name},
                         {"version", "1.0.7"}});
}

// Returns a number such as "39.78" or "1675.0". It always has a point, because other servers write
// numbers so.
std::string decimal_text(double value) {
    std::string text = fmt::format("{}", value);
    if (text.find_first_of(".e") == text.npos) text += ".0";
    return text;
}

struct Extent {
    double start = 0, size = 0;
};

void write_extent(XmlWriter& xml, std::string_view name, Extent extent, std::string_view units) {
    xml.open(name)
        .leaf("start", decimal_text(extent.start))
        .leaf("size", decimal_text(extent.size))
        .leaf("units", units)
        .close();
}

// Returns the range of longitudes that holds all stations and leaves out the widest gap between
// them. If the range crosses the antimeridian, it continues beyond 180.
Extent longitudes_of(std::vector<double> stations_deg, double margin_deg) {
    std::ranges::sort(stations_deg);
    double west = stations_deg.front(), east = stations_deg.back();
    double widest = west + 360 - east;
    for (std::size_t i = 1; i < stations_deg.size(); ++i) {
        const double gap = stations_deg[i] - stations_deg[i - 1];
        if (gap <= widest) continue;
        widest = gap;
        west = stations_deg[i];
        east = stations_deg[i - 1] + 360;
    }
    const double start = std::floor(west - margin_deg);
    const double size = std::ceil(east + margin_deg) - start;
    if (size >= 360) return {-180, 360};
    return {start < -180 ? start + 360 : start, size};
}

// Writes the area that the radars see, in whole degrees. Radars reach 460 km, so the box has a
// margin of 5 degrees around their places.
void write_coverage(XmlWriter& xml, const std::vector<ThreddsStation>& stations) {
    constexpr double margin_deg = 5, top_km = 20;
    double north = -90, south = 90;
    std::vector<double> longitudes;
    for (const ThreddsStation& station : stations) {
        if (!station.has_place) continue;
        north = std::max(north, std::min(std::ceil(station.latitude_deg + margin_deg), 90.0));
        south = std::min(south, std::max(std::floor(station.latitude_deg - margin_deg), -90.0));
        longitudes.push_back(station.longitude_deg);
    }
    const bool is_known = !longitudes.empty();
    if (!is_known) std::swap(north, south);
    xml.open("geospatialCoverage");
    write_extent(xml, "northsouth", {south, north - south}, "degrees_north");
    write_extent(xml, "eastwest",
                 is_known ? longitudes_of(std::move(longitudes), margin_deg) : Extent{-180, 360},
                 "degrees_east");
    write_extent(xml, "updown", {0, top_km}, "km");
    xml.close();
}

void write_time_coverage(XmlWriter& xml, std::optional<UtcTime> oldest) {
    xml.open("timeCoverage");
    if (oldest) {
        xml.leaf("start", format_utc(std::chrono::floor<std::chrono::seconds>(*oldest)));
        xml.leaf("end", "present");
    } else {
        xml.leaf("end", "present");
        xml.leaf("duration", "0 days");
    }
    xml.close();
}

void write_variables(XmlWriter& xml, const ThreddsCollection& collection) {
    xml.open("variables", {{"vocabulary", "DIF"}});
    for (const ThreddsVariable& variable : collection.variables()) {
        xml.empty("variable", {{"name", variable.name},
                               {"vocabulary_name", variable.vocabulary_name},
                               {"units", variable.units}});
    }
    xml.close();
}

}  // namespace

std::string path_for_clients(const Request& request, std::string_view path) {
    const std::size_t scheme = request.base.find("://");
    const std::size_t slash = scheme == request.base.npos ? 0 : request.base.find('/', scheme + 3);
    const std::string prefix = slash == request.base.npos ? "" : request.base.substr(slash);
    return prefix + std::string{path};
}

std::string thredds_top_xml(const Request& request) {
    XmlWriter xml;
    open_catalog(xml, "stormcellar");
    xml.empty("catalogRef",
              {{"xlink:href", path_for_clients(request, "/thredds/radarServer/catalog.xml")},
               {"xlink:title", "Radar Data"},
               {"name", "Radar Data"}});
    return xml.take();
}

std::string thredds_catalog_xml(const Request& request, const ThreddsCollections& collections) {
    XmlWriter xml;
    open_catalog(xml, "THREDDS Radar Server");
    xml.empty("service", {{"name", "radarServer"},
                          {"serviceType", "QueryCapability"},
                          {"base", path_for_clients(request, "/thredds/radarServer/")}});
    xml.open("dataset", {{"name", "Radar Data"}});
    for (const auto& collection : collections) {
        xml.empty("catalogRef", {{"xlink:href", collection->path() + "/dataset.xml"},
                                 {"xlink:title", collection->title()},
                                 {"name", collection->title()}});
    }
    return xml.take();
}

std::string thredds_dataset_xml(const Request& request, const ThreddsCollection& collection,
                                const std::vector<ThreddsStation>& stations,
                                std::optional<UtcTime> oldest) {
    XmlWriter xml;
    open_catalog(xml, "Radar Data");
    xml.empty("service", {{"name", "radarServer"},
                          {"serviceType", "DQC"},
                          {"base", path_for_clients(request, "/thredds/radarServer/")}});
    xml.open(
        "dataset",
        {{"name", collection.title()}, {"ID", collection.path()}, {"urlPath", collection.path()}});
    xml.leaf("serviceName", "radarServer");
    xml.leaf("dataType", "RADIAL");
    xml.leaf("dataFormat", collection.format());
    xml.open("metadata", {{"inherited", "true"}});
    xml.leaf("documentation", collection.summary(), {{"type", "summary"}});
    write_coverage(xml, stations);
    write_time_coverage(xml, oldest);
    write_variables(xml, collection);
    return xml.take();
}

std::string thredds_stations_xml(const std::vector<ThreddsStation>& stations) {
    XmlWriter xml;
    xml.open("stationsList");
    for (const ThreddsStation& station : stations) {
        if (!station.has_place) continue;
        xml.open("station",
                 {{"id", station.id}, {"state", station.state}, {"country", station.country}});
        xml.leaf("name", station.name.empty() ? station.id : station.name);
        xml.leaf("elevation", decimal_text(station.altitude_m));
        xml.leaf("latitude", decimal_text(station.latitude_deg));
        xml.leaf("longitude", decimal_text(station.longitude_deg));
        xml.close();
    }
    return xml.take();
}

std::string thredds_result_xml(const Request& request, const ThreddsCollection& collection,
                               std::string_view asked, const std::vector<ThreddsFile>& files) {
    XmlWriter xml;
    open_catalog(xml, fmt::format("Radar {} datasets in near real time", collection.title()));
    xml.open("service", {{"name", "RadarServices"}, {"serviceType", "Compound"}, {"base", ""}});
    const std::string base =
        path_for_clients(request, "/thredds/fileServer/" + collection.path() + "/");
    xml.empty("service", {{"name", "HTTPServer"}, {"serviceType", "HTTPServer"}, {"base", base}});
    xml.close();
    xml.open("dataset", {{"name", fmt::format("Radar {} datasets for available stations and times",
                                              collection.title())},
                         {"collectionType", "TimeSeries"},
                         {"ID", asked}});
    xml.open("metadata", {{"inherited", "true"}});
    xml.leaf("serviceName", "RadarServices");
    xml.leaf("dataType", "RADIAL");
    xml.leaf("dataFormat", collection.format());
    xml.leaf("documentation", fmt::format("{} datasets found for query", files.size()));
    xml.close();
    for (const ThreddsFile& file : files) {
        xml.open("dataset", {{"name", file.name},
                             {"ID", collection.path() + "/" + file.path},
                             {"urlPath", file.path}});
        const auto start = std::chrono::floor<std::chrono::seconds>(file.start);
        xml.leaf("date", format_utc(start), {{"type", "start of ob"}});
        xml.close();
    }
    return xml.take();
}

}  // namespace stormcellar::web
