// render/frame/probe.h -- reads the data at one place of a picture.
//
// In a map, the probe reads the value or the state of the column whose cell is drawn at the place.
// In a volume, it reads the column maximum over the ground at the pixel, and not the echo along the
// ray. In a section, it reads the value or the state at the pixel, and in a ppi the gate. The probe
// also gives the lowest and the highest height at which the column was seen (in a section, the
// nearest column). For a ppi it gives instead where and when the gate was measured.
//
// Threads   Pure functions.
#pragma once

#include <optional>
#include <string>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/site_frame.h"
#include "stormcellar/grid/sweep_lookup.h"
#include "stormcellar/render/render.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

struct Probe {
    grid::GeoPoint place;  // the requested point
    grid::CellStatus status = grid::CellStatus::not_seen;
    float value = 0;         // if the status is value
    bool at_least = false;   // the true value may be larger
    std::string unit;        // of the value as it is stored: "m/s", "km"
    std::string class_name;  // if the value is the number of a class: "big drops"
    // Height of the value: of a maximum, a CAPPI, a point of a section, or the beam at a gate.
    std::optional<double> height_m;
    std::optional<double> distance_m;                     // along a section
    std::optional<double> lowest_seen_m, highest_seen_m;  // none if the column was not seen
    std::optional<grid::GatePosition> gate;               // for a ppi, if there is a gate
};

// Reads a pixel of the whole picture; (0, 0) is its top left. Errors: bad_argument if the pixel is
// outside the picture, the grid or the section, or in the sky; those of render_frame().
[[nodiscard]] Result<Probe> probe_pixel(const grid::BrickView& view, const FrameFacts& facts,
                                        const Scene& scene, int x, int y, int threads);
// Reads a place in a map or a volume. Errors: bad_argument for a section, and for a place outside
// the grid; those of render_frame().
[[nodiscard]] Result<Probe> probe_place(const grid::BrickView& view, const FrameFacts& facts,
                                        const Scene& scene, grid::GeoPoint place, int threads);

// Returns a text such as "52.5 dBZ", "at least 12 km", "big drops" or "no echo". The value is in
// `units`.
[[nodiscard]] std::string probe_text(const Probe& probe, const Units& units);

}  // namespace stormcellar::render
