// stormcellar/render/overlays.h -- what is drawn over a picture besides its map: columns of
// rotation, marks of storm cells, and shapes from files of other programs, such as warnings.
//
// Units     As in stormcellar/retrieve/storm_cells.h; widths in pixels at scale 1.
// Threads   Plain data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/site_frame.h"
#include "stormcellar/render/image.h"
#include "stormcellar/retrieve/storm_cells.h"

namespace stormcellar::render {

// The storm cells of the newest volume at or before a picture.
struct CellOverlay {
    retrieve::TrackedScan scan;
    retrieve::CellOptions method;  // by which the cells were found
    std::size_t volumes = 1;       // through which the cells were followed
};

// A line or a point on the ground. The outline of an area is a line that ends where it begins.
struct OverlayShape {
    std::vector<grid::GeoPoint> points;  // one point: a dot with a label
    std::optional<Rgba8> color = {};     // none: the color of the map's text
    float width = 2;
    std::string label = {};                        // of a point
    std::optional<UtcTime> from = {}, until = {};  // when it is in force; none: no limit

    [[nodiscard]] bool is_in_force(UtcTime time) const {
        return (!from || *from <= time) && (!until || time < *until);
    }
};

struct ShapeOverlay {
    std::string name;  // of the file, or the files
    std::vector<OverlayShape> shapes;
    std::size_t unknown = 0;  // parts of the file that cannot be drawn, such as images
};

// Null: not drawn. The referenced objects must outlive the picture's drawing.
struct Overlays {
    const grid::BrickView* rotation = nullptr;  // over a volume; on the grid of the picture
    const CellOverlay* cells = nullptr;         // over a map or a volume
    const ShapeOverlay* shapes = nullptr;       // over a map or a volume
};

}  // namespace stormcellar::render
