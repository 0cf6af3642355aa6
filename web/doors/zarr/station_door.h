// web/doors/zarr/station_door.h -- serves a station's raw volumes over time as a tree of Zarr
// groups, version 3 (docs/web/zarr.md).
//
//   /zarr3/volumes                               the stations, as JSON
//   /zarr3/volumes/KTLX/...                      the tree, with consolidated metadata
//   /zarr3/volumes/KTLX/VCP-212/sweep_0/...      a group of it, for readers without trees
//
// A chunk is one moment of one sweep. It is decoded from the raw file on request and kept. A chunk
// gets 404, so that readers use the fill value, if the volume does not have the sweep or the
// moment, or if its file is gone, damaged or not the cataloged one. If the file cannot be read now,
// it gets 503.
//
// Threads   Many threads may use it. Listing a station and decoding is for long workers.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "web/data/grids/kept_answers.h"
#include "web/data/station/station_trees.h"
#include "web/http/door.h"

namespace stormcellar::web {

class StationDoor final : public Door {
  public:
    // `grids` answers for moments and products of a domain with the name "volumes".
    StationDoor(std::shared_ptr<StationTrees> trees, std::shared_ptr<KeptAnswers> kept,
                std::shared_ptr<Door> grids)
        : trees_(std::move(trees)), kept_(std::move(kept)), grids_(std::move(grids)) {}
    std::optional<Answer> answer_soon(const Request& request) override {
        return answer_of(request, true);
    }
    Answer answer(const Request& request) override { return *answer_of(request, false); }

  private:
    struct Named;  // a group of the tree that a path names

    // Returns none only if it must be quick and would take long.
    [[nodiscard]] std::optional<Answer> answer_of(const Request& request, bool must_be_quick);
    [[nodiscard]] Answer stations_index(const Request& request) const;
    [[nodiscard]] std::optional<Answer> answer_in(const Request& request, const StationTree& tree,
                                                  std::span<const std::string_view> path,
                                                  bool must_be_quick);
    [[nodiscard]] std::optional<Answer> chunk(const Request& request, const StationTree& tree,
                                              const Named& named, const ZarrArray& array,
                                              std::span<const std::size_t> place,
                                              bool must_be_quick);
    [[nodiscard]] std::optional<Answer> sweep_chunk(const Request& request, const StationTree& tree,
                                                    const Named& named, const ZarrArray& array,
                                                    std::size_t time, bool must_be_quick);

    const std::shared_ptr<StationTrees> trees_;
    const std::shared_ptr<KeptAnswers> kept_;
    const std::shared_ptr<Door> grids_;
};

}  // namespace stormcellar::web
