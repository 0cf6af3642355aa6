// web/doors/pictures/tiles.h -- 2D products as tiles of web maps (docs/web/pictures.md).
//
//   /tiles                                              domains and layers, as JSON
//   /tiles/DOMAIN/LAYER/TIME/{z}/{x}/{y}.png            256 pixels, in Web Mercator; "@2x": 512
//   /tiles/DOMAIN/LAYER/TIME/tilejson.json              TileJSON 3.0
//
// LAYER is a name of web/data/pictures/map_product.h or of web/data/pictures/sweep_layer.h. TIME is
// "latest" or the instant of a grid. The options of the layer are parameters.
//
// Threads   Many threads may use it.
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "web/data/pictures/map_pictures.h"
#include "web/doors/pictures/picture_answers.h"
#include "web/http/door.h"

namespace stormcellar::web {

// The place of a tile. Zoom 0 is the whole earth, and row 0 is the northernmost.
struct TilePlace {
    int zoom = 0;
    int column = 0, row = 0;
    int side = 256;  // pixels
};
inline constexpr int deepest_zoom = 22;
inline constexpr double most_latitude_deg = 85.0511;  // edge of Web Mercator's square
// Reads the parts of an address, such as "5", "7" and "12.png" or "12@2x.png". Returns none if
// there is no such tile.
[[nodiscard]] std::optional<TilePlace> tile_place_of(std::string_view zoom, std::string_view column,
                                                     std::string_view file);
[[nodiscard]] render::PlaneWindow window_of(const TilePlace& place);

class TilesDoor final : public Door {
  public:
    explicit TilesDoor(std::shared_ptr<MapPictures> pictures) : pictures_(std::move(pictures)) {}
    // Answers with a kept tile, if its grid is open.
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;

  private:
    struct ShownSweep {
        PictureLayer layer;
        std::optional<std::chrono::seconds> max_age;
    };
    // Finds the raw volume of a layer of sweeps, or refuses.
    [[nodiscard]] Found<ShownSweep> shown_sweep(const Request& request,
                                                const std::vector<std::string_view>& path);
    [[nodiscard]] Answer index(const Request& request);
    [[nodiscard]] Answer tilejson(const Request& request,
                                  const std::vector<std::string_view>& path);
    [[nodiscard]] Answer tilejson_of(const Request& request,
                                     const std::vector<std::string_view>& path,
                                     const PictureLayer& layer, const grid::GridSpec& spec);
    [[nodiscard]] Answer tile(const Request& request, const std::vector<std::string_view>& path);

    std::shared_ptr<MapPictures> pictures_;
};

}  // namespace stormcellar::web
