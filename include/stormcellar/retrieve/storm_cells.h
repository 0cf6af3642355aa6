// stormcellar/retrieve/storm_cells.h -- finds storm cells in a 3D grid of reflectivity, and follows
// them from scan to scan.
//
// Cells     A cell is a peak of reflectivity with the echo around it. Starting at the strongest
//           grid cells, echo grows down to `least_dbz`. Where two peaks meet, they stay two cells
//           if both rise above the pass between them by `prominence_db` and are far enough apart,
//           so that the cells of a line separate. Peaks above each other are one cell.
// Tracks    Each earlier cell is moved with its predicted motion. A cell continues a track if it is
//           near the predicted place or overlaps the moved footprint; pairs with the shortest
//           distance and the most overlap come first. An unmatched cell within a moved footprint
//           was split off. A track that ends within another track's cell was merged into it.
// Motion    Joins two estimates, each weighted by its error: a straight line through the last
//           positions by least squares, and the motion of the echo pattern (guess_motions()).
// Units     Degrees (WGS84), meters above mean sea level, dBZ, kg m^-2, mm, s^-1, m/s to the east
//           and north.
// Source    Ideas: SCIT (Johnson et al. 1998, Wea. Forecasting 13, 263), TITAN (Dixon and Wiener
//           1993), TINT (Raut et al. 2021), tobac (Heikenfeld et al. 2019). VIL: Greene and Clark
//           (1972). The rules and numbers here are our own.
// Accuracy  Six simulated storms go through the gridder (tests/retrieve/storm_cells_test.cpp,
//           track_cells_test.cpp). All are found and nothing else, within 2 km of the storm's place
//           at the start of the volume. After three volumes the motion is within 2 m/s and 10
//           degrees.
// Not covered  Real cells have no truth. The growth of the error of forecasts (4 m/s and axis) is
//           an assumption. Positions count as of the scan's time, although sweeps are up to a
//           volume's length later. Farther than 60 km from the radar, a melting layer may look deep
//           and count as a cell.
// Errors    See each function. An input without strong echo gives no cells, which is no error.
// Threads   Pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/retrieve/hail.h"
#include "stormcellar/retrieve/wind_profile.h"

namespace stormcellar::retrieve {

struct CellOptions {
    float least_dbz = 35;         // a cell ends below this reflectivity
    float prominence_db = 6;      // of a peak above the passes to stronger cells
    float least_peak_dbz = 41;    // weaker peaks are no cells
    double separation_m = 5'000;  // horizontally between the peaks of two cells
    double least_area_km2 = 10;
    // Extent in height; layers thinner than this, such as a melting layer, are no cells. If the air
    // above was not seen, thin echo of 50 dBZ is a cell. Does not apply to grids of one level.
    double least_depth_m = 2'000;
    float top_dbz = 18;  // of echo tops
};

// A run of columns of a grid row: first_x <= ix < end_x.
struct ColumnRun {
    int iy = 0, first_x = 0, end_x = 0;
    bool operator==(const ColumnRun&) const = default;
};

struct StormCell {
    grid::GeoPoint position;  // center of mass, with the liquid water of each grid cell as its mass
    double area_km2 = 0;      // of all columns of the cell
    float max_dbz = 0, max_dbz_height_m = 0;
    // Height of the highest echo of `top_dbz` over the cell's columns. The error is one distance
    // between levels. `top_is_at_least` is true if the air above this echo was not seen in some
    // column.
    float top_m = 0;
    bool top_is_at_least = false;
    float vil_kg_per_m2 = 0;       // the largest of its columns (vertical_liquid.h)
    std::optional<float> mesh_mm;  // the largest of its columns; absent without freezing levels
    // MESH in the column of `mesh_mm`, if both freezing levels err by usual_level_error_m.
    std::optional<MeshRange> mesh_range;
    std::optional<float> azimuthal_shear_per_s;  // the largest in its columns; absent if not given
    std::vector<ColumnRun> columns;              // of the scan's grid, by row, then column
    // Motion of the echo around the cell since the scan before; absent if nobody estimated it.
    std::optional<Motion> echo_motion;
};

// The cells of one grid, the strongest first.
struct CellScan {
    UtcTime time;
    std::string area;  // station or domain
    grid::GridSpec spec;
    std::vector<StormCell> cells;
    std::optional<FreezingLevels> freezing = {};  // from which the MESH of the cells follows
};

// The grids of one time in which cells are found. All have the same spec.
struct CellFields {
    grid::BrickView reflectivity;
    std::optional<grid::BrickView> azimuthal_shear;  // of the moment AZSH, in 0.001/s
    std::optional<FreezingLevels> freezing;          // for hail
    // The height of the radar above sea level, for VIL (vertical_liquid.h); the mean for several
    // radars, none if it is unknown.
    std::optional<double> radar_m = {};
};

// Finds the cells of a grid. Errors: bad_argument if an option makes no sense, if the spec is not
// valid, or if the specs of two fields differ.
[[nodiscard]] Result<CellScan> find_cells(const CellFields& fields, UtcTime time, std::string area,
                                          const CellOptions& options = {});

// Sets `echo_motion` of the cells of `scan` from the motion of all echo between the grids `before`
// and `after`. The cells were found in `after`. Changes nothing if there is too little echo.
// Errors: bad_argument if the specs differ or `seconds` is not positive.
[[nodiscard]] Status guess_motions(CellScan& scan, const grid::BrickView& before,
                                   const grid::BrickView& after, double seconds);

enum class CellOrigin : std::uint8_t {
    first,      // found for the first time
    continued,  // continues a track
    split,      // split off from a cell that also continues
    merged,     // continues a track, and at least one other track ended in it
};
// Returns "new", "continued", "split" or "merged".
[[nodiscard]] std::string_view cell_origin_name(CellOrigin origin);

struct CellSighting {
    UtcTime time;
    grid::GeoPoint position;
};

// Lead times of the forecasts.
inline constexpr std::array forecast_minutes = {15, 30, 45, 60};

// The place of a cell if it keeps its motion. The error is the standard deviation along each axis.
struct CellForecast {
    int minutes = 0;
    UtcTime time;
    grid::GeoPoint position;
    double error_m = 0;
};

struct TrackMotion {
    Motion velocity;
    double error_mps = 0;  // standard error of each component
};

struct TrackedCell {
    StormCell cell;
    // Time and place of the first sighting among the scans, as in "20130520_200400_35.32N_97.51W".
    // So the id stays the same if later scans are added. The id is unique within a result.
    std::string id;
    CellOrigin origin = CellOrigin::first;
    std::vector<std::string> parents;  // split: the track it left; merged: the ended tracks
    UtcTime time;                      // of the scan
    std::vector<CellSighting> past;    // with this id, from the first sighting to the scan before
    std::optional<TrackMotion> motion;
    std::vector<CellForecast> forecasts;  // for 15, 30, 45 and 60 minutes; empty without a motion
};

struct TrackedScan {
    UtcTime time;
    std::string area;
    std::vector<TrackedCell> cells;               // the strongest first
    std::optional<FreezingLevels> freezing = {};  // as in CellScan
};

struct TrackOptions {
    double longest_gap_s = 1'260;     // a track ends if no scan shows its cell for longer
    double position_error_m = 1'000;  // of a cell's position, before residuals are known
    double fastest_mps = 40;
    std::size_t most_positions = 10;  // for the fit by least squares
};

// Follows the cells through scans of one area. Scans may come in any order; the result is in order
// of time. If several scans have the same time, the last of them counts. The last element has the
// newest cells. Errors: bad_argument if the areas differ, or an option makes no sense.
[[nodiscard]] Result<std::vector<TrackedScan>> track_cells(std::span<const CellScan> scans,
                                                           const TrackOptions& options = {});

}  // namespace stormcellar::retrieve
