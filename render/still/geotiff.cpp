// Writes GeoTIFF: the cells of a map in the grid's own projection. A pixel is a column of the grid,
// so nothing is resampled. Each overview takes every second cell of the previous raster, so each of
// its values is also the value of a cell.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "render/image/xmp.h"
#include "render/still/map_attributes.h"
#include "render/still/map_raster.h"
#include "render/still/still_format.h"
#include "render/still/tiff_file.h"
#include "stormcellar/base/version.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/render/product.h"

namespace stormcellar::render {
namespace {

// Keys and their values: OGC 19-008r4, annex B, and the EPSG codes for WGS 84, degree and meter.
namespace geo_key {
constexpr std::uint16_t model_type = 1024, raster_type = 1025, geographic_type = 2048;
constexpr std::uint16_t angular_units = 2054, projected_type = 3072, citation = 3073;
constexpr std::uint16_t projection = 3074, method = 3075, linear_units = 3076;
constexpr std::uint16_t parallel_1 = 3078, parallel_2 = 3079, false_easting = 3082;
constexpr std::uint16_t false_northing = 3083, origin_longitude = 3084, origin_latitude = 3085;
constexpr std::uint16_t origin_easting = 3086, origin_northing = 3087, center_longitude = 3088;
constexpr std::uint16_t center_latitude = 3089;
}  // namespace geo_key
constexpr std::uint16_t user_defined = 32767, wgs84 = 4326, degree = 9102, metre = 9001;

GeoKey short_key(std::uint16_t id, std::uint16_t number) {
    return {.id = id, .number = number};
}
GeoKey double_key(std::uint16_t id, double value) {
    return {.id = id, .is_double = true, .value = value};
}

std::vector<GeoKey> keys_of_plane(std::uint16_t method, const std::string& name) {
    constexpr std::uint16_t projected = 1, pixel_is_area = 1;
    return {short_key(geo_key::model_type, projected),
            short_key(geo_key::raster_type, pixel_is_area),
            short_key(geo_key::geographic_type, wgs84),
            short_key(geo_key::angular_units, degree),
            short_key(geo_key::projected_type, user_defined),
            {.id = geo_key::citation, .text = name},
            short_key(geo_key::projection, user_defined),
            short_key(geo_key::method, method),
            short_key(geo_key::linear_units, metre)};
}

std::vector<GeoKey> geo_keys(const grid::GridSpec& spec) {
    std::vector<GeoKey> keys;
    const auto add = [&](std::uint16_t id, double value) { keys.push_back(double_key(id, value)); };
    switch (spec.projection) {
        case grid::Projection::azimuthal_equidistant: {
            constexpr std::uint16_t method = 12;
            keys = keys_of_plane(method, "azimuthal equidistant, WGS 84");
            add(geo_key::false_easting, 0);
            add(geo_key::false_northing, 0);
            add(geo_key::center_longitude, spec.center_longitude_deg);
            add(geo_key::center_latitude, spec.center_latitude_deg);
            return keys;
        }
        case grid::Projection::lambert_conformal: {
            constexpr std::uint16_t method = 8;  // two standard parallels, which may be equal
            keys = keys_of_plane(method, "Lambert conformal conic, WGS 84");
            add(geo_key::parallel_1, spec.parallels_deg[0]);
            add(geo_key::parallel_2, spec.parallels_deg[1]);
            add(geo_key::origin_longitude, spec.center_longitude_deg);
            add(geo_key::origin_latitude, spec.center_latitude_deg);
            add(geo_key::origin_easting, 0);
            add(geo_key::origin_northing, 0);
            return keys;
        }
        case grid::Projection::latitude_longitude: {
            constexpr std::uint16_t geographic = 2, pixel_is_area = 1;
            return {short_key(geo_key::model_type, geographic),
                    short_key(geo_key::raster_type, pixel_is_area),
                    short_key(geo_key::geographic_type, wgs84),
                    short_key(geo_key::angular_units, degree)};
        }
    }
    return keys;
}

// Places the raster. The corner of the first pixel is half a cell outside the center of the
// northwest column.
void place_raster(const grid::GridSpec& spec, TiffFacts& facts) {
    if (spec.in_degrees()) {
        const grid::GridProjection projection(spec);
        const double half_deg = spec.spacing_deg / 2;
        facts.pixel_size = {spec.spacing_deg, spec.spacing_deg};
        facts.top_left = {projection.column_longitude_deg(0) - half_deg,
                          projection.row_latitude_deg(spec.ny - 1) + half_deg};
        return;
    }
    facts.pixel_size = {spec.spacing_m, spec.spacing_m};
    facts.top_left = {spec.x_m(0) - spec.spacing_m / 2, spec.y_m(spec.ny - 1) + spec.spacing_m / 2};
}

std::string states_text(level2::Moment moment) {
    std::string text;
    for (const StateClass& one : state_classes(moment))
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", one.code, one.name);
    return text;
}

// Makes a raster of a field. Rows of the field run from south to north; rows of the raster run from
// north to south.
template <class PixelOf>
TiffRaster raster_of(const FlatField& field, const PixelOf& pixel_of) {
    TiffRaster raster{field.width, field.height, {}};
    for (int y = field.height; y-- > 0;) {
        for (int x = 0; x < field.width; ++x) {
            const auto pixel = pixel_of(field.index(x, y));
            const auto bytes = std::as_bytes(std::span(&pixel, 1));
            raster.pixels.insert(raster.pixels.end(), bytes.begin(), bytes.end());
        }
    }
    return raster;
}

TiffRaster content_of(const FlatField& field, TiffContent content, const ColorTable& table) {
    switch (content) {
        case TiffContent::values:
            return raster_of(field, [&](std::size_t place) {
                return field.status[place] == grid::CellStatus::value ? field.values[place]
                                                                      : std::nanf("");
            });
        case TiffContent::states:
            return raster_of(field, [&](std::size_t place) { return state_of(field, place); });
        case TiffContent::colors:
            return raster_of(field,
                             [&](std::size_t place) { return overlay_color(field, place, table); });
    }
    return {};
}

TiffRaster halved(const TiffRaster& from) {
    const auto bytes_each = from.pixels.size() / (static_cast<std::size_t>(from.width) *
                                                  static_cast<std::size_t>(from.height));
    TiffRaster half{(from.width + 1) / 2, (from.height + 1) / 2, {}};
    for (int y = 0; y < half.height; ++y) {
        for (int x = 0; x < half.width; ++x) {
            const auto at =
                (static_cast<std::size_t>(2 * y) * static_cast<std::size_t>(from.width) +
                 static_cast<std::size_t>(2 * x)) *
                bytes_each;
            half.pixels.insert(half.pixels.end(),
                               from.pixels.begin() + static_cast<std::ptrdiff_t>(at),
                               from.pixels.begin() + static_cast<std::ptrdiff_t>(at + bytes_each));
        }
    }
    return half;
}

// Escapes a text twice: GDAL parses texts as XML, and then parses the result as XML again.
std::string gdal_escaped(std::string_view text) {
    return xml_escaped(xml_escaped(text));
}

// Returns the texts that GDAL shows as metadata and as the name and the unit of the band.
std::string gdal_metadata(const StillMap& map, const StillOptions& options) {
    std::string items;
    for (const auto& [keyword, text] : options.metadata) {
        items += fmt::format("  <Item name=\"{}\">{}</Item>\n", xml_escaped(keyword),
                             gdal_escaped(text));
    }
    items += fmt::format("  <Item name=\"TIME\">{}</Item>\n", format_utc(map.facts.time));
    const auto band = [&](std::string_view name, const std::string& text) {
        items += fmt::format("  <Item name=\"{}\" sample=\"0\" role=\"{}\">{}</Item>\n", name, name,
                             gdal_escaped(text));
    };
    switch (options.tiff) {
        case TiffContent::values:
            band("description", product_title(map.scene));
            if (const std::string unit = unit_shown(map.scene); !unit.empty()) {
                band("unittype", unit);
            }
            break;
        case TiffContent::states:
            items +=
                fmt::format("  <Item name=\"STATES\">{}</Item>\n", states_text(map.scene.moment));
            band("description", product_title(map.scene) + ", states");
            break;
        case TiffContent::colors:
            break;
    }
    return fmt::format("<GDALMetadata>\n{}</GDALMetadata>\n", items);
}

TiffFacts facts_of_file(const StillMap& map, const StillOptions& options) {
    TiffFacts facts;
    switch (options.tiff) {
        case TiffContent::values:
            facts.samples = TiffSamples::gray_float;
            facts.gdal_nodata = "nan";
            break;
        case TiffContent::states:
            facts.samples = TiffSamples::palette;
            for (const StateClass& one : state_classes(map.scene.moment))
                facts.palette.push_back(one.color);
            break;
        case TiffContent::colors:
            facts.samples = TiffSamples::rgba;
            break;
    }
    place_raster(*map.view.spec, facts);
    facts.geo_keys = geo_keys(*map.view.spec);
    facts.description = text_of(options.metadata);
    facts.software = fmt::format("stormcellar {}", software_version);
    const std::string time = format_utc(map.facts.time);  // 2022-03-17T00:08:42.596Z
    facts.date_time = fmt::format("{}:{}:{} {}", time.substr(0, 4), time.substr(5, 2),
                                  time.substr(8, 2), time.substr(11, 8));
    facts.gdal_metadata = gdal_metadata(map, options);
    return facts;
}

}  // namespace

Result<std::vector<std::byte>> encode_geotiff(const StillMap& map, const StillOptions& options) {
    const auto field = still_field(map, options.threads);
    if (!field) return pass_on(field);
    std::vector<TiffRaster> rasters = {content_of(*field, options.tiff, colors_of(map.scene))};
    while (std::max(rasters.back().width, rasters.back().height) > tiff_tile_side)
        rasters.push_back(halved(rasters.back()));
    return write_tiff(rasters, facts_of_file(map, options), options.threads);
}

}  // namespace stormcellar::render
