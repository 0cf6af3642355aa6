// render/frame/picture_metadata.h -- the metadata in the file of a picture or a loop.
//
// The metadata are keywords and texts in printable ASCII. They are equal for the same picture on
// every machine.
//   Title               domain and times
//   Description         the picture in a sentence
//   First time          ISO 8601, UTC
//   Last time           for a loop
//   Frames              for a loop
//   Domain, Stations, Product, Moment, Units
//   Freezing levels     for hail
//   Melting layer       for hydrometeor classes; for hail, if the layer's top is far from the
//                       assumed height of 0 C
//   Hail error          if the freezing levels err; for a still
//   Storm cells         if they are marked: how they were found and followed
//   Shapes              if files of shapes are drawn: their names, and how many are in force
//   Grid                cells, spacing, levels
//   Gridding            method, beam, averaging, effects
//   Gridding error      as predicted, if it was predicted
//   Notes               what the grid says about its making; for a still
//   Between grids       how frames between grids were made
//   Picture             slices, integration, light
//   Picture error       as planned and measured
//   Software            name and version
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "stormcellar/cache/grid_file.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

using Metadata = std::vector<std::pair<std::string, std::string>>;

// Facts about the picture that the grid does not have.
struct PictureFacts {
    std::string domain;
    UtcTime first, last;
    std::optional<std::size_t> frames;  // none: a still
    std::string between;                // how frames between grids were made; empty: there are none
    std::string error;                  // error of the picture by its plan; empty: not planned
    std::string hail = {};              // error of the largest hail; empty: no hail
    std::string cells = {};             // the storm cells that are marked; empty: none are marked
    std::string shapes = {};            // the files of shapes that are drawn; empty: none
};

// Returns the metadata. `scene` must be the scene that was drawn. `grid` describes one grid; its
// method is written as the method of all frames.
[[nodiscard]] Metadata metadata_of(const PictureFacts& facts, const cache::GridDescription& grid,
                                   const Scene& scene);

}  // namespace stormcellar::render
