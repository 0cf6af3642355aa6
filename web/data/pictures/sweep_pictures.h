// web/data/pictures/sweep_pictures.h -- draws sweeps (ppi) from the raw volume of a grid.
//
// The cache holds only grids, so the gates are read from the raw file, which the catalog finds.
// `stormcellar frame` with the same options gives the same bytes; times are in UTC.
//
// Threads   Many threads may use it. If several want the same picture at the same time, one draws
//           it.
// Errors    See each function. No message names a directory.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grid/place/source_volume.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/catalog/catalog.h"
#include "stormcellar/grid/sweep_lookup.h"
#include "web/data/pictures/frame_pictures.h"
#include "web/data/pictures/frame_style.h"
#include "web/data/raw/served_catalog.h"

namespace stormcellar::web {

struct SweepPicture {
    std::string domain;
    std::string grid_id;  // in the key, so that a growing volume is drawn again
    catalog::CatalogEntry volume;
    std::uint64_t chunks = 0;  // changes when more chunks come
    FrameStyle style;

    [[nodiscard]] std::string key() const;
    [[nodiscard]] std::string etag() const;  // with its quotes
};

// A sweep of a decoded volume, on the plane of `description`.
struct PlacedSweep {
    std::shared_ptr<const grid::SourceVolume> source;
    grid::SweepLookup sweep;
    cache::GridDescription description;
};

class SweepPictures {
  public:
    SweepPictures(std::shared_ptr<ServedCatalog> catalog, FramePicturesOptions options)
        : catalog_(std::move(catalog)), options_(std::move(options)) {}

    // Finds the raw volume of a grid. Returns none if the catalog does not have it. Errors:
    // bad_argument for a grid of several sites; those of the catalog.
    [[nodiscard]] Result<std::optional<SweepPicture>> find(const OpenGrid& grid, FrameStyle style);
    // Returns the picture. If it is not kept, draws it. Errors: not_found if the raw file is gone
    // or has no such sweep; those of decoding and drawing.
    [[nodiscard]] Result<Kept> find_or_draw(const SweepPicture& picture);
    // Decodes the sweep of each panel. All sweeps are on the plane of the first. Errors: not_found
    // if the raw file is gone or has no such sweep; those of decoding.
    [[nodiscard]] Result<std::vector<PlacedSweep>> decode(const SweepPicture& picture) const;

  private:
    [[nodiscard]] Result<Kept> draw(const SweepPicture& picture);

    std::shared_ptr<ServedCatalog> catalog_;
    FramePicturesOptions options_;
};

}  // namespace stormcellar::web
