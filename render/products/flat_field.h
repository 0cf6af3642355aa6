// render/products/flat_field.h -- 2D products: one value or state for each column of a grid.
//
//   composite   The largest value of the column; ColumnSummary::status() gives the state.
//   cappi       The value at one height, linear between the two levels around it. cell_mixer.h says
//               which state results if the two states differ. At the height of a level, the result
//               is the value of that level.
//   echo_top    km: the greatest height at which reflectivity reaches a threshold. If the cell
//               above the highest cell that reaches it has a value, reflectivity is linear in dB
//               between the two. If there is no echo above, the top is the height of the cell
//               itself. If the cell above was not seen, is range folded or does not exist, the top
//               is not known, and the height is marked "at least".
//   vil         kg/m2: vertically integrated liquid (stormcellar/retrieve/vertical_liquid.h). The
//               first and the last level reach half a spacing beyond themselves, as cells do.
//   vil_density   g/m3: the VIL of a column over the height of its echo top above the radar. The
//                 result is a mean density, so tall and low storms can be compared; hail has a high
//                 density. Columns with an echo top have a value. If the top may be higher, or if
//                 VIL lacks cells that were not seen, the result covers the part that was seen. A
//                 top of less than least_depth_m counts as least_depth_m.
//   maximum_height   km: the height of the lowest cell that has the largest value of the column, if
//                    that value reaches a threshold.
//   ppi         The gate of a sweep at the center of each column. A picture looks up each pixel
//               (sweep_field.h).
//   lowest_seen, highest_seen   km: the height of the lowest or highest cell that is not "not
//                               seen".
//   rotation, rotation_aloft   The largest value of the cells whose height above the radar is in
//                              the product's layer. A mosaic, which merges the shear of its
//                              radars by maximum, has its layer above the lowest radar.
//   rotation_tracks            As rotation, of a grid that has the largest value of each cell over
//                              time.
//   mesh, posh, shi   mm, %, J/m/s: hail (hail_field.h)
//   rain_total   mm: the cells of a grid of one level, which holds the total.
// For products of reflectivity or shear, a column without a value is range folded if any cell is
// range folded, because the echo behind it is unknown; else no echo (below the threshold) if any
// cell was seen; else not seen. For shear, such a column may also be ambiguous.
//
// Units     Heights are above mean sea level.
// Threads   Pure functions; the same bits for any number of threads.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "render/products/column_summary.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/render/frame_facts.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

struct FlatField {
    int width = 0, height = 0;             // columns, and rows from south to north
    std::vector<float> values;             // 0 if the status is not value
    std::vector<grid::CellStatus> status;  // of each column
    // 1 for a column whose true value may be larger; empty if no column is like this
    std::vector<std::uint8_t> at_least;

    FlatField() = default;
    FlatField(int columns, int rows);
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }
    void put(std::size_t place, grid::CellStatus state, float value) {
        status[place] = state;
        values[place] = state == grid::CellStatus::value ? value : 0;
    }
};

[[nodiscard]] FlatField composite_field(const grid::BrickView& view,
                                        const std::vector<ColumnSummary>& columns);
// Makes the CAPPI. Errors: bad_argument for a height at which the grid has no cells.
[[nodiscard]] Result<FlatField> cappi_field(const grid::BrickView& view, level2::Moment moment,
                                            double height_m, int threads);
// The functions from here to maximum_height_field() need a grid of reflectivity.
[[nodiscard]] FlatField echo_top_field(const grid::BrickView& view, double threshold_dbz,
                                       int threads);
// `radar_m` is the height of the radar; none if it is unknown.
[[nodiscard]] FlatField vil_field(const grid::BrickView& view, std::optional<double> radar_m,
                                  int threads);
inline constexpr double least_depth_m = 500;
// `radar_m` is the height of the radar.
[[nodiscard]] FlatField vil_density_field(const grid::BrickView& view, double threshold_dbz,
                                          double radar_m, int threads);
[[nodiscard]] FlatField maximum_height_field(const grid::BrickView& view, double threshold_dbz,
                                             int threads);

// `radar_m` is the height of the radar. Errors: bad_argument if the grid has no level in the layer.
[[nodiscard]] Result<FlatField> layer_maximum_field(const grid::BrickView& view,
                                                    const HeightLayer& layer, double radar_m,
                                                    int threads);

[[nodiscard]] FlatField rain_total_field(const grid::BrickView& view, int threads);
[[nodiscard]] FlatField lowest_seen_field(const grid::BrickView& view, int threads);
[[nodiscard]] FlatField highest_seen_field(const grid::BrickView& view, int threads);

// Returns the height of the radar, or the mean of several.
[[nodiscard]] double radar_height_m(const FrameFacts& facts);

// Returns the field of the scene's product, which must be a map. The scene must be valid for the
// view and its facts. Only a composite and hail use `columns`. Errors: those of cappi_field() and
// layer_maximum_field(); internal for a product that is not a map.
[[nodiscard]] Result<FlatField> map_field(const grid::BrickView& view, const FrameFacts& facts,
                                          const Scene& scene,
                                          const std::vector<ColumnSummary>& columns, int threads);

// One column, from the lowest level up.
struct ColumnCells {
    std::vector<grid::CellStatus> status;
    std::vector<float> values;  // 0 if the status is not value
};
// Reads a column into `cells`, reusing its memory.
void read_column(const grid::BrickView& view, int ix, int iy, ColumnCells& cells);

}  // namespace stormcellar::render
