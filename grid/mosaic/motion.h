// grid/mosaic/motion.h -- how echo moved from one grid to a later one, estimated from the two.
//
// Model     Echo moves in the grid's plane, the same at all heights; it may grow and decay. The
//           motion is that which makes parts of the two column-maximum images
//           (grid/mosaic/echo_image.h) correlate best: first for the whole image, then for
//           overlapping blocks near to that, each by as much as its correlation is worth; what
//           blocks say is smoothed, and where there is no echo the motion of the whole holds.
// Units     columns of the grid per second east (x) and north (y), so that a grid in degrees needs
//           no more; in m/s by GridSpec::cell_width_m() and cell_height_m().
// Accuracy  of a pattern that moves rigidly, at 2 km pixels and 300 s: 1.5 m/s (enforced by
//           tests/grid/motion_test.cpp). Storms that grow, merge or turn have no such bound: see
//           the scores on real volumes in docs/accuracy.md.
// Source    correlation tracking: Rinehart and Garvey (1978), Nature 273, 287; Li, Schmid and Joss
//           (1995), J. Appl. Meteor. 34, 1286.
// Threads   a MotionField is immutable; the estimate has the same bits for any number of threads.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"

namespace stormcellar::grid {

// Columns per second.
struct CellMotion {
    float x = 0;
    float y = 0;
    bool operator==(const CellMotion&) const = default;
};

// Bilinear between the nodes of a lattice over a grid's columns, constant beyond it.
class MotionField {
  public:
    // The same everywhere.
    explicit MotionField(CellMotion motion);
    // Nodes every `step` columns, row by row, the first over column 0 of row 0.
    // `whole` is that of all echo together.
    MotionField(int width, int height, double step, std::vector<CellMotion> nodes,
                CellMotion whole);

    [[nodiscard]] CellMotion at(double ix, double iy) const;
    [[nodiscard]] CellMotion whole() const { return whole_; }
    // Of the nodes; so no place has a faster one along either axis.
    [[nodiscard]] CellMotion greatest() const { return greatest_; }

  private:
    int width_ = 1, height_ = 1;
    double step_ = 1;
    std::vector<CellMotion> nodes_;
    CellMotion whole_, greatest_;
};

struct MotionOptions {
    double greatest_mps = 50;       // no echo is looked for that moved faster
    double pixel_m = 2000;          // of the images that are compared, as near as columns allow
    double block_m = 64'000;        // parts of the image that have a motion of their own
    double block_differs_mps = 15;  // by so much at most from the motion of the whole
    int threads = 1;
};

// None where too little echo stands in both (less than 200 pixels of 4 km) for a motion to be
// known. bad_argument: views of different specs, a moment in other units than dBZ is the caller's
// to avoid, or seconds that are not positive.
[[nodiscard]] Result<std::optional<MotionField>> estimate_motion(const BrickView& before,
                                                                 const BrickView& after,
                                                                 double seconds,
                                                                 const MotionOptions& options = {});

}  // namespace stormcellar::grid
