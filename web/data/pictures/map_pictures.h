// web/data/pictures/map_pictures.h -- 2D products drawn on rectangles of a map's plane, for tiles
// and WMS: as PNG or JPEG, kept in memory.
//
// A picture follows from the grid's bytes, the options and the rectangle alone, so its ETag is made
// of these and is known before the picture is.
//
// Threads   Many threads may use it. If several want the same picture at the same time, one draws
//           it. Who calls it bounds how many are drawn at once (web/http/work_queue.h).
// Errors    See each function.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/recently_used.h"
#include "render/still/plane_picture.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/result.h"
#include "web/data/grids/grids.h"
#include "web/data/grids/kept_answers.h"
#include "web/data/pictures/flat_map.h"
#include "web/data/pictures/map_product.h"
#include "web/http/request.h"

namespace stormcellar::web {

struct MapPicturesOptions {
    std::shared_ptr<Grids> grids;
    // Other doors may keep their pictures in it, too.
    std::shared_ptr<KeptAnswers> kept = std::make_shared<KeptAnswers>(32'000'000);
    std::uint64_t map_bytes = 32'000'000;  // for the products that pictures are drawn of
    int threads = 1;                       // that make one product of a grid
};

// A layer of a grid. Several of them in one picture lie one over another, the first at the bottom.
struct PictureLayer {
    std::shared_ptr<const OpenGrid> grid;
    MapStyle style;
};

struct MapPicture {
    std::vector<PictureLayer> layers;  // at least one
    render::PlaneWindow window;
    // The color under the layers; none: clear.
    std::optional<render::Rgba8> ground;
    bool is_jpeg = false;  // which needs a ground; else PNG

    [[nodiscard]] std::string key() const;
    [[nodiscard]] std::string etag() const;  // with its quotes
};

// The value that a layer shows at a place. It is 0 unless the status says that there is one.
struct MapValue {
    grid::CellStatus status = grid::CellStatus::not_seen;
    float value = 0;
};

class MapPictures {
  public:
    explicit MapPictures(MapPicturesOptions options);

    // Returns the picture if it is kept. Takes microseconds.
    [[nodiscard]] std::optional<Kept> find(const MapPicture& picture);
    // Errors: those of FlatMaps::find_or_make() and of the encoder.
    [[nodiscard]] Result<Kept> find_or_draw(const MapPicture& picture);

    // Returns what the column that holds the place has, from the product at its finest; none
    // outside of the grid. Errors: those of FlatMaps::find_or_make().
    [[nodiscard]] Result<std::optional<MapValue>> value_at(const PictureLayer& layer,
                                                           const grid::GeoPoint& place);
    // Draws what the layer's colors mean, as PNG. Errors: those of draw_legend_panel() and of the
    // encoder.
    [[nodiscard]] static Result<Kept> legend(const PictureLayer& layer);

    // Where a grid is, from its spec; it is worked out once for each of the newest specs.
    [[nodiscard]] render::EarthBox box_of(const std::string& domain, const grid::GridSpec& spec);
    [[nodiscard]] Grids& grids() { return *options_.grids; }

  private:
    [[nodiscard]] Result<Kept> draw(const MapPicture& picture);
    [[nodiscard]] Result<render::Image> drawn(const PictureLayer& layer,
                                              const render::PlaneWindow& window);

    using DomainSpec = std::pair<std::string, grid::GridSpec>;
    MapPicturesOptions options_;
    FlatMaps maps_;
    Mutex boxes_mutex_;
    RecentlyUsed<DomainSpec, render::EarthBox> boxes_ STORMCELLAR_GUARDED_BY(boxes_mutex_);
};

// Returns how often to halve a field for pixels of this window: until a cell has at least 0.87 of
// the side of a pixel, so that next to no cell falls between pixels, or there is no smaller form.
// The result does not depend on where the window is, so that tiles fit together.
[[nodiscard]] int halvings_for(const render::PlaneWindow& window, const grid::GridSpec& spec,
                               std::size_t levels);

// "latest" or an instant as time of a grid of this layer. Errors: not_found if there is none;
// bad_argument for a text that is no time.
[[nodiscard]] Result<UtcTime> time_of_grid(const Grids& grids, std::string_view domain,
                                           level2::Moment moment, std::string_view text);

}  // namespace stormcellar::web
