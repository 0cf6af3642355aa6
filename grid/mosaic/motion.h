// grid/mosaic/motion.h -- estimates how echo moved from one grid to a later one.
//
// Model     Echo moves in the plane of the grid, with the same motion at all heights; it may grow
//           and decay. From both grids, images of the maximum of each column are made
//           (grid/mosaic/echo_image.h). The estimate is the motion with which the images correlate
//           best: first for the whole image, then for overlapping blocks, near the motion of the
//           whole image. Each block counts by its correlation. The field of motions is smoothed.
//           Where there is no echo, the motion of the whole image counts.
// Units     Columns of the grid per second, east (x) and north (y), so that a grid in degrees needs
//           no conversion. Multiply by GridSpec::cell_width_m() and cell_height_m() for m/s.
// Accuracy  1.5 m/s for a pattern that moves rigidly, with pixels of 2 km and 300 s (enforced by
//           tests/grid/motion_test.cpp). There is no bound for storms that grow, merge or turn;
//           docs/accuracy.md has the scores on real volumes.
// Source    Correlation tracking: Rinehart and Garvey (1978), Nature 273, 287; Li, Schmid and Joss
//           (1995), J. Appl. Meteor. 34, 1286.
// Threads   A MotionField is immutable. The estimate has the same bits for any number of threads.
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

// A field of motions. It has nodes on a lattice over the columns of a grid. It is bilinear between
// the nodes, and constant beyond the lattice.
class MotionField {
  public:
    // Makes a field with the same motion everywhere.
    explicit MotionField(CellMotion motion);
    // Makes a field with a node every `step` columns, row by row. The first node is at column 0 of
    // row 0. `whole` is the motion of all echo together.
    MotionField(int width, int height, double step, std::vector<CellMotion> nodes,
                CellMotion whole);

    [[nodiscard]] CellMotion at(double ix, double iy) const;
    [[nodiscard]] CellMotion whole() const { return whole_; }
    // Returns the greatest magnitude of x and the greatest magnitude of y over all nodes. No motion
    // is faster along either axis.
    [[nodiscard]] CellMotion greatest() const { return greatest_; }

  private:
    int width_ = 1, height_ = 1;
    double step_ = 1;
    std::vector<CellMotion> nodes_;
    CellMotion whole_, greatest_;
};

struct MotionOptions {
    double greatest_mps = 50;  // faster motions are not considered
    double pixel_m = 2000;     // size of pixels, as nearly as columns allow
    // Size of the blocks of the image that have a motion of their own.
    double block_m = 64'000;
    double block_differs_mps = 15;  // a block may differ from the whole by this much at most
    int threads = 1;
};

// Estimates the motion. Returns none if there is too little echo for that (less than 200 pixels of
// 4 km). The moment must be in dBZ, which is not checked. Errors: bad_argument for views with
// different specs, or if `seconds` is not positive.
[[nodiscard]] Result<std::optional<MotionField>> estimate_motion(const BrickView& before,
                                                                 const BrickView& after,
                                                                 double seconds,
                                                                 const MotionOptions& options = {});

}  // namespace stormcellar::grid
