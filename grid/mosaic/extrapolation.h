// grid/mosaic/extrapolation.h -- makes a grid for a time after the last volume, from the motion of
// the echo until then.
//
// Model     Echo keeps its value and moves along a field of motions that does not change
//           (Lagrangian persistence). Nothing grows, decays or begins. Each column is traced back
//           through the field in steps of at most 300 s, each by the midpoint rule (semi-Lagrangian
//           advection). Its cells are the bilinear mean, in dB, of the four columns around the
//           place that is found.
// States    The status rule of grid/sweep/mixture.h applies, with bilinear weights. In a mean, no
//           echo counts as 0 dBZ, or as the lowest of the four values if that is lower. A cell
//           whose echo would come from beyond the grid, or from a place that was not seen, is not
//           seen.
// Units     Motions in columns per second (grid/mosaic/motion.h), times in seconds.
// Accuracy  A uniform motion by whole columns gives the codes of the moved grid. By half a column,
//           values err by 0.6 dB at most, rounding included, where the reflectivity curves by less
//           than 0.8 dB per square column (enforced by tests/grid/extrapolation_test.cpp). There is
//           no bound for real echo, which changes; retrieve/nowcast/hindcast.h measures its errors.
// Source    Germann and Zawadzki (2002), Mon. Wea. Rev. 130, 2859.
// Threads   Pure. The result has the same bits for any number of threads.
#pragma once

#include <span>

#include "grid/mosaic/motion.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::grid {

// Returns the median of several fields over the columns of a grid, each component by itself. The
// median of an even number of fields is the mean of the two in the middle. There must be at least
// one field.
[[nodiscard]] MotionField median_motion(std::span<const MotionField> fields, const GridSpec& spec);

// Makes the grid `seconds` later than the view. The moment must be in dBZ, which is not checked.
// Errors: bad_argument if `seconds` is negative or not finite.
[[nodiscard]] Result<BrickGrid> extrapolate(const BrickView& latest, const MotionField& motion,
                                            double seconds, int threads = 1);

}  // namespace stormcellar::grid
