// stormcellar/export/cell_text.h -- storm cells and their tracks as text for other programs.
//
// GeoJSON     RFC 7946: a FeatureCollection. Each cell is a Point with all attributes as flat
//             properties, `kind` "cell". Its past positions are a LineString, `kind` "track", and
//             its forecasts a LineString, `kind` "forecast" with the errors in meters; both have
//             the cell's `id`. A cell without past positions has no track, and a cell without
//             motion has no forecast.
// CSV         RFC 4180: a row for each cell. An unknown value is an empty field.
// Placefile   Of GR2Analyst and GRLevel3; supercell-wx and other programs read it, too. Icons are
//             drawn as text and lines, so that no image file is needed. A cell is an Object at its
//             place with a circle and a text; its track and its forecast are Lines. Source:
//             "Placefiles", https://www.grlevelx.com/manuals/gis/files_places.htm.
// Units       Positions in degrees with 5 decimals. Names of columns and properties end with their
//             units; heights are above mean sea level. The placefile has kft and knots, which its
//             readers use. Times are in ISO 8601, UTC.
// Hail        In JSON and GeoJSON, `assumed_freezing_levels_m` has the freezing levels from which
//             the MESH of the cells follows. `freezing_levels_error_m` has the error of both
//             levels, from which `mesh_least_mm` and `mesh_most_mm` follow. In GeoJSON both are
//             members of the collection.
// Unknown     JSON and GeoJSON leave out unknown values.
// Threads     Pure functions. The same cells give the same bytes.
#pragma once

#include <span>
#include <string>

#include "stormcellar/retrieve/storm_cells.h"

namespace stormcellar::cell_export {

// Returns one JSON object: {"area":..., "time":..., "cells":[...]}.
[[nodiscard]] std::string cells_json(const retrieve::TrackedScan& scan);
[[nodiscard]] std::string cells_geojson(const retrieve::TrackedScan& scan);
[[nodiscard]] std::string cells_csv(std::span<const retrieve::TrackedCell> cells);

struct PlacefileLook {
    std::string title = "stormcellar cells";
    int refresh_minutes = 1;  // how often a reader asks again; at least 1
};
[[nodiscard]] std::string cells_placefile(std::span<const retrieve::TrackedCell> cells,
                                          const PlacefileLook& look = {});

}  // namespace stormcellar::cell_export
