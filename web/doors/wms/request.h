// web/doors/wms/request.h -- reads a request to the Web Map Service (OGC 06-042, and the older
// 1.1.1).
//
// The case of parameter names does not matter, and unknown parameters are ignored, as the standard
// says. A box in EPSG:4326 begins with latitudes in 1.3.0 and with longitudes in 1.1.1. A box in
// CRS:84 begins with longitudes.
//
// Units     Those of the coordinate system: meters in EPSG:3857, degrees in EPSG:4326 and CRS:84.
// Threads   Plain values and pure functions.
// Errors    A WmsFault. Its code is one of the standard's, or empty.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/still/plane_picture.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "web/data/pictures/map_product.h"
#include "web/http/request.h"

namespace stormcellar::web {

inline constexpr int most_wms_side = 4096;          // pixels
inline constexpr std::size_t most_wms_layers = 16;  // in one picture
inline constexpr std::array<std::string_view, 3> wms_systems{"EPSG:3857", "EPSG:4326", "CRS:84"};
// The name that EPSG:3857 had before it had a number. Older clients know only this name.
inline constexpr std::string_view older_web_mercator = "EPSG:900913";

struct WmsFault {
    std::string_view code;
    std::string text;  // a sentence
    unsigned status = 400;
};
template <class Value>
using WmsRead = tl::expected<Value, WmsFault>;
[[nodiscard]] inline tl::unexpected<WmsFault> wms_fault(std::string_view code, std::string text,
                                                        unsigned status = 400) {
    return tl::unexpected(WmsFault{code, std::move(text), status});
}

class WmsParameters {
  public:
    explicit WmsParameters(const Fields& query) : query_(query) {}
    // Returns the first parameter of this name; none if it is absent or empty.
    [[nodiscard]] std::optional<std::string_view> find(std::string_view name) const;
    [[nodiscard]] const Fields& all() const { return query_; }

  private:
    const Fields& query_;
};

enum class WmsVersion { v1_1_1, v1_3_0 };
// Returns the version that VERSION names, or 1.3.0 if VERSION is absent.
[[nodiscard]] WmsRead<WmsVersion> wms_version(const WmsParameters& parameters);
// Returns the version in which to describe the service: 1.1.1 if VERSION is below 1.3.0, else
// 1.3.0.
[[nodiscard]] WmsVersion wms_nearest_version(const WmsParameters& parameters);

// A layer of the service is a layer of a domain: "KTLX:composite.REF".
struct WmsLayer {
    std::string domain;
    MapStyle style;
};
[[nodiscard]] std::string wms_layer_name(std::string_view domain, const MapProduct& layer);

// Returns the styles of a layer, which are the names of its color tables. "default" comes first.
[[nodiscard]] std::vector<std::string> wms_styles_of(const MapProduct& layer);

// Reads the lists of layers and styles. An empty style means the default style. The options of
// layers (web/data/pictures/map_product.h) are parameters, too. Each applies to those layers that
// use it.
[[nodiscard]] WmsRead<std::vector<WmsLayer>> wms_layers(const WmsParameters& parameters,
                                                        std::string_view layers,
                                                        std::string_view styles);

struct WmsMap {
    std::vector<WmsLayer> layers;
    render::PlaneWindow window;
    std::optional<render::Rgba8> ground;  // none: transparent
    // The instant that TIME names; none: the newest grid.
    std::optional<UtcTime> time;
    bool is_jpeg = false;  // false: PNG
};
[[nodiscard]] WmsRead<WmsMap> wms_map(const WmsParameters& parameters, UtcTime now);

// A pixel of a picture. wms_pixel() reads the pixel that GetFeatureInfo asks about. place_of()
// returns the place of the center of a pixel.
struct WmsPixel {
    int column = 0, row = 0;
};
[[nodiscard]] WmsRead<WmsPixel> wms_pixel(const WmsParameters& parameters,
                                          const render::PlaneWindow& window);
[[nodiscard]] grid::GeoPoint place_of(const WmsPixel& pixel, const render::PlaneWindow& window);

}  // namespace stormcellar::web
