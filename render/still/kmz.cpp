// Writes KMZ: a zip with doc.kml, the map in degrees as a GroundOverlay, and a legend as a
// ScreenOverlay. Source: OGC 12-007r2 (KML 2.3).
#include <span>
#include <string>

#include <fmt/format.h>

#include "render/image/xmp.h"
#include "render/still/degree_picture.h"
#include "render/still/legend_panel.h"
#include "render/still/map_raster.h"
#include "render/still/still_format.h"
#include "render/still/zip_file.h"
#include "stormcellar/render/png_file.h"
#include "stormcellar/render/product.h"

namespace stormcellar::render {
namespace {

std::string kml_of(const StillMap& map, const EarthBox& box, const StillOptions& options) {
    const std::string time = format_utc(map.facts.time);
    const std::string name = fmt::format("{} {}", map.facts.domain, product_title(map.scene));
    return fmt::format(
        R"(<?xml version="1.0" encoding="UTF-8"?>
<kml xmlns="http://www.opengis.net/kml/2.2">
<Document>
  <name>{0} {1}</name>
  <open>1</open>
  <description>{2}</description>
  <GroundOverlay>
    <name>{0}</name>
    <TimeStamp><when>{1}</when></TimeStamp>
    <Icon><href>overlay.png</href></Icon>
    <LatLonBox>
      <north>{3:.9f}</north>
      <south>{4:.9f}</south>
      <east>{5:.9f}</east>
      <west>{6:.9f}</west>
    </LatLonBox>
  </GroundOverlay>
  <ScreenOverlay>
    <name>Legend</name>
    <Icon><href>legend.png</href></Icon>
    <overlayXY x="0" y="0.5" xunits="fraction" yunits="fraction"/>
    <screenXY x="0.01" y="0.5" xunits="fraction" yunits="fraction"/>
    <size x="-1" y="-1" xunits="pixels" yunits="pixels"/>
  </ScreenOverlay>
</Document>
</kml>
)",
        xml_escaped(name), time, xml_escaped(text_of(options.metadata)), box.north_deg,
        box.south_deg, box.east_deg, box.west_deg);
}

std::vector<std::byte> bytes_of_text(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

}  // namespace

Result<std::vector<std::byte>> encode_kmz(const StillMap& map, const StillOptions& options) {
    const auto field = still_field(map, options.threads);
    if (!field) return pass_on(field);
    const auto drawn =
        draw_in_degrees(*map.view.spec, *field, colors_of(map.scene), options.threads);
    if (!drawn) return pass_on(drawn);
    const auto legend = draw_legend_panel(map);
    if (!legend) return pass_on(legend);
    auto overlay_png = encode_png(drawn->image, {}, PngAlpha::always);
    if (!overlay_png) return pass_on(overlay_png);
    auto legend_png = encode_png(*legend);
    if (!legend_png) return pass_on(legend_png);
    return write_zip({{"doc.kml", bytes_of_text(kml_of(map, drawn->box, options))},
                      {"overlay.png", std::move(*overlay_png)},
                      {"legend.png", std::move(*legend_png)}});
}

}  // namespace stormcellar::render
