// web/doors/zarr/zarr.h -- serves grids over time as Zarr arrays (docs/web/zarr.md).
//
//   /zarr                      the groups, as JSON
//   /zarr/DOMAIN/MOMENT/...    a group in version 2 of the format, with consolidated metadata
//   /zarr3/DOMAIN/MOMENT/...   a group in version 3
//
// In place of a moment, a path may name a 2D product as tiles do (map_product.h): /zarr/KTLX/mesh.
//
// Chunks are made on request and kept. A chunk of an evicted grid gets 404, which is the protocol's
// answer for a missing chunk. Readers then use the fill value. In the array of states, the fill
// value means "unavailable".
//
// Threads   Many threads may use it.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "web/data/grids/grids.h"
#include "web/data/grids/kept_answers.h"
#include "web/data/pictures/map_pictures.h"
#include "web/data/zarr/time_numbers.h"
#include "web/data/zarr/zarr_layout.h"
#include "web/http/door.h"

namespace stormcellar::web {

// The sources that the doors of both versions share.
struct ZarrSources {
    std::shared_ptr<Grids> grids;
    std::shared_ptr<KeptAnswers> kept;
    std::shared_ptr<TimeNumbers> numbers;
    std::shared_ptr<MapPictures> maps;  // makes 2D products
};

class ZarrDoor final : public Door {
  public:
    ZarrDoor(ZarrSources sources, ZarrVersion version)
        : sources_(std::move(sources)), version_(version) {}
    // Answers with a kept chunk, if its grid is open.
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;

  private:
    struct Named;   // a domain, and a moment or a product, that a path names
    struct Opened;  // the group of a Named

    [[nodiscard]] std::optional<Named> named(const std::vector<std::string_view>& path) const;
    [[nodiscard]] Result<Opened> open(const Named& named) const;
    [[nodiscard]] Result<std::shared_ptr<const OpenGrid>> find_grid(const Named& named,
                                                                    UtcTime time) const;
    [[nodiscard]] static bool has_same_columns(const Named& named, grid::GridSpec spec,
                                               const OpenGrid& grid);
    [[nodiscard]] bool has_cells_of_newest(const Named& named, const OpenGrid& grid) const;
    [[nodiscard]] Answer index(const Request& request) const;
    [[nodiscard]] Answer document(const Request& request, const Opened& opened,
                                  const std::vector<std::string_view>& rest) const;
    [[nodiscard]] Answer chunk(const Request& request, const Named& named, const Opened& opened,
                               const ZarrArray& array, const std::vector<std::size_t>& place) const;
    [[nodiscard]] Answer cells(const Request& request, const Named& named, const Opened& opened,
                               const ZarrArray& array, const std::vector<std::size_t>& place) const;
    [[nodiscard]] Result<Kept> made(const OpenGrid& grid, const Named& named,
                                    const ZarrArray& array,
                                    const std::vector<std::size_t>& place) const;
    // Returns the indices of a chunk, or none if the key is not a chunk's.
    [[nodiscard]] std::optional<std::vector<std::size_t>> place_in(
        const std::vector<std::string_view>& rest, std::size_t dimensions) const;

    const ZarrSources sources_;
    const ZarrVersion version_;
};

}  // namespace stormcellar::web
