// web/data/pictures/map_pictures.h -- draws 2D products on rectangles of a map's plane, for tiles
// and WMS, as PNG, WebP or JPEG. Keeps the pictures in memory.
//
// A picture depends only on the grid's bytes, the options and the rectangle. Its ETag is made from
// these, so the ETag is known before the picture is drawn.
//
// Threads   Many threads may use it. If several want the same picture at the same time, one draws
//           it. The caller limits how many are drawn at the same time (web/http/work_queue.h).
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
#include "web/data/storms/rain_totals.h"
#include "web/http/request.h"

namespace stormcellar::web {

struct MapPicturesOptions {
    std::shared_ptr<Grids> grids;
    std::shared_ptr<SweepPictures> sweeps = {};  // null: no sweeps are drawn
    std::shared_ptr<RainTotals> rain = {};       // null: made of `grids`
    // Keeps the pictures. Other owners may share this object.
    std::shared_ptr<KeptAnswers> kept = std::make_shared<KeptAnswers>(32'000'000);
    std::uint64_t map_bytes = 32'000'000;  // for the 2D products from which pictures are drawn
    int threads = 1;                       // for making one product of a grid
};

// A layer of a picture, which shows a grid. Layers are drawn one over another, the first at the
// bottom.
struct PictureLayer {
    std::shared_ptr<const OpenGrid> grid;
    MapStyle style;
    std::optional<SweepPicture> sweep = {};  // of the grid's raw volume, shown instead of the grid
};

struct MapPicture {
    std::vector<PictureLayer> layers;  // at least one
    render::PlaneWindow window;
    // The color under the layers; none: transparent.
    std::optional<render::Rgba8> ground;
    // The format: ".png", ".webp" (lossless), or ".jpg", which needs a ground.
    std::string_view ending = ".png";

    [[nodiscard]] std::string key() const;
    [[nodiscard]] std::string etag() const;  // with its quotes
};

// The value that a layer shows at a place. It is 0 unless the status is `value`.
struct MapValue {
    grid::CellStatus status = grid::CellStatus::not_seen;
    float value = 0;
};

class MapPictures {
  public:
    explicit MapPictures(MapPicturesOptions options);

    // Returns the picture if it is kept. Takes microseconds.
    [[nodiscard]] std::optional<Kept> find(const MapPicture& picture);
    // Returns the picture. If it is not kept, draws it. Errors: those of FlatMaps::find_or_make()
    // and of the encoder.
    [[nodiscard]] Result<Kept> find_or_draw(const MapPicture& picture);

    // Returns the 2D product of a grid. Errors: those of FlatMaps::find_or_make().
    [[nodiscard]] Result<std::shared_ptr<const FlatMap>> map_of(const OpenGrid& grid,
                                                                const render::Scene& scene) {
        return maps_.find_or_make(grid, scene, options_.threads);
    }
    // Returns the value of the column at the place, from the product at full resolution. Returns
    // none outside the grid. Errors: those of FlatMaps::find_or_make().
    [[nodiscard]] Result<std::optional<MapValue>> value_at(const PictureLayer& layer,
                                                           const grid::GeoPoint& place);
    // Draws the legend of the layer's colors as PNG. Errors: those of draw_legend_panel() and of
    // the encoder.
    [[nodiscard]] static Result<Kept> legend(const PictureLayer& layer);

    // Returns the extent on the earth of grids with this spec. Keeps the results for the newest
    // specs.
    [[nodiscard]] render::EarthBox box_of(const std::string& domain, const grid::GridSpec& spec);
    [[nodiscard]] Grids& grids() { return *options_.grids; }
    // Returns the layers of a domain. A domain of a single grid has no rain totals.
    [[nodiscard]] std::vector<MapProduct> layers_of(std::string_view domain) const;
    // Returns the moment whose grids have the times of a layer: the layer's own, or that of
    // RainTotals::listed_moment().
    [[nodiscard]] level2::Moment listed_moment(std::string_view domain,
                                               const MapProduct& layer) const;
    // Returns the grid of a layer: a kept grid, or a rain total. Errors: those of Grids::find() and
    // RainTotals::find().
    [[nodiscard]] Result<std::shared_ptr<const OpenGrid>> find_grid(std::string_view domain,
                                                                    const MapProduct& layer,
                                                                    UtcTime time);
    // Returns the grid if that takes only microseconds; else null.
    [[nodiscard]] std::shared_ptr<const OpenGrid> find_grid_if_open(std::string_view domain,
                                                                    const MapProduct& layer,
                                                                    UtcTime time);
    [[nodiscard]] SweepPictures* sweeps() { return options_.sweeps.get(); }
    // Returns the plane of a sweep. Errors: those of SweepPictures::decode().
    [[nodiscard]] Result<grid::GridSpec> plane_of(const SweepPicture& sweep);

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

// Returns how often to halve a field for the pixels of this window. The field is halved until the
// side of a cell is at least 0.87 of a pixel's side, so that almost no cell falls between pixels,
// or until there is no coarser level. The result does not depend on the position of the window, so
// tiles fit together.
[[nodiscard]] int halvings_for(const render::PlaneWindow& window, const grid::GridSpec& spec,
                               std::size_t levels);

// Reads the time of a grid: "latest" or an instant. Errors: not_found for "latest" if there is no
// grid; bad_argument for a text that is not a time.
[[nodiscard]] Result<UtcTime> time_of_grid(const Grids& grids, std::string_view domain,
                                           level2::Moment moment, std::string_view text);

}  // namespace stormcellar::web
