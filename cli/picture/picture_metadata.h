// cli/picture/picture_metadata.h -- what a picture or a loop says of itself in its file.
//
// Keyword and text, all of it printable ASCII; the same for the same picture on every machine.
//   Title            domain and times             Moment, Units
//   Description      the picture in a sentence    Grid             cells, spacing, levels
//   First time       ISO 8601, UTC                Gridding         method, beam, averaging, effects
//   Last time        of a loop                    Gridding error   as predicted, where it was
//   Frames           of a loop                    Between grids    how frames were made there
//   Domain, Stations                              Picture          slices, integration, light
//   Product                                       Picture error    as planned and measured
//   Software         and its version
// Thread contract: pure functions.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "stormcellar/cache/grid_file.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {

using Metadata = std::vector<std::pair<std::string, std::string>>;

// What the grid does not say.
struct PictureFacts {
    std::string domain;
    UtcTime first, last;
    std::optional<std::size_t> frames;  // none: a still
    std::string between;                // how frames between grids were made; empty: there are none
    std::string error;                  // of the picture, by its plan; empty: not planned
};

// `scene` as it was drawn; `grid` stands for the method of all frames.
[[nodiscard]] Metadata metadata_of(const PictureFacts& facts, const cache::GridDescription& grid,
                                   const render::Scene& scene);

}  // namespace stormcellar::cli
