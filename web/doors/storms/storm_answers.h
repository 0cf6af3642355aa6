// web/doors/storms/storm_answers.h -- the storms of areas as text, kept in memory until a grid of
// the areas changes.
//
// GeoJSON is a FeatureCollection whose member `areas` lists the areas with the times of their
// newest grids. Each feature names its area.
//
// Threads   Many threads may use it. If several want the same text, one makes it.
// Errors    See each function.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "web/data/grids/compressed.h"
#include "web/data/grids/kept_answers.h"
#include "web/data/storms/storm_scans.h"

namespace stormcellar::web {

enum class StormText { cells_geojson, cells_placefile, rotation_geojson };

// The text that a request wants, with its key among the kept answers.
struct WantedStorms {
    StormText text = StormText::cells_geojson;
    std::vector<StormArea> areas;
    Coding coding = Coding::identity;
    std::string key;
};

class StormAnswers {
  public:
    StormAnswers(std::shared_ptr<StormScans> scans, std::shared_ptr<KeptAnswers> kept)
        : scans_(std::move(scans)), kept_(std::move(kept)) {}

    // Finds the areas without opening a grid. Ignores the moment of the query and takes the moment
    // that the text needs. Errors: those of storm_areas().
    [[nodiscard]] Result<WantedStorms> want(StormText text, StormQuery query, Coding coding) const;
    // Returns the text if it is kept; takes microseconds.
    [[nodiscard]] std::optional<Kept> find(const WantedStorms& wanted) const;
    // Makes the text and keeps it. Errors: those of StormScans::track(), Grids::find() and
    // GridFile::check_whole().
    [[nodiscard]] Result<Kept> make(const WantedStorms& wanted) const;

  private:
    [[nodiscard]] Result<std::string> made(const WantedStorms& wanted) const;
    [[nodiscard]] Result<std::string> cells_geojson(const WantedStorms& wanted) const;
    [[nodiscard]] Result<std::string> cells_placefile(const WantedStorms& wanted) const;
    [[nodiscard]] Result<std::string> rotation_geojson(const WantedStorms& wanted) const;

    const std::shared_ptr<StormScans> scans_;
    const std::shared_ptr<KeptAnswers> kept_;
};

// Returns the answer with a kept text.
[[nodiscard]] Answer storm_answer(const Request& request, StormText text, const Kept& kept);

}  // namespace stormcellar::web
