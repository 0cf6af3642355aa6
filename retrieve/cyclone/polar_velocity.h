// retrieve/cyclone/polar_velocity.h -- the unfolded velocities of one sweep, thinned to bins along
// the arc, for reading at any point of the plane about the site.
//
// A bin has the median of its gates, as the horizontal wind along the beam: the velocity divided by
// the cosine of the elevation. The fall of the drops adds at most 0.1 m/s below 1 degree.
//
// Units     Meters in the azimuthal equidistant plane about the site; m/s, positive away from the
//           radar.
// Threads   One thread may change a PolarVelocity while no other thread uses it; `const` is
//           thread-safe.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "stormcellar/grid/site_frame.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/dealias.h"

namespace stormcellar::retrieve {

// Returns the radials that have this moment, finite angles and a Nyquist velocity of 1 to 200 m/s,
// by azimuth.
[[nodiscard]] std::vector<std::size_t> usable_radials(const level2::Sweep& sweep,
                                                      const level2::SweepMoment& moment);

class PolarVelocity {
  public:
    // The sweep must have the moment, and `folds` one number for each of its gates.
    PolarVelocity(const level2::Volume& volume, const SweepFolds& folds);

    // Interpolates between the four bins around a point. If a velocity is expected, each bin is
    // first moved by whole turns (twice the Nyquist velocity) until it is nearest to that velocity.
    // Returns NaN where bins with a value have less than half of the weight.
    [[nodiscard]] double at(double x_m, double y_m) const { return at(x_m, y_m, unexpected); }
    [[nodiscard]] double at(double x_m, double y_m, double expected_mps) const;
    // Moves each bin by whole turns until it is nearest to the velocity that `expected` returns for
    // its place. Bins for which `expected` returns NaN stay.
    void refold(const std::function<double(double x_m, double y_m)>& expected);
    // Returns the height above the antenna of the beam's axis over an arc.
    [[nodiscard]] double height_m(double arc_m) const;

    [[nodiscard]] double reach_m() const { return reach_m_; }  // arc of the last gate
    [[nodiscard]] double elevation_deg() const { return elevation_deg_; }
    // Returns the number of bins with a value.
    [[nodiscard]] std::size_t values() const { return values_; }
    // Returns the number of bins whose fold numbers differ between this object and `other`, which
    // must be of the same sweep.
    [[nodiscard]] std::size_t differences(const PolarVelocity& other) const;

  private:
    static constexpr double unexpected = std::numeric_limits<double>::quiet_NaN();
    void index_azimuths();
    void fill_bins(const level2::Sweep& sweep, const std::vector<std::size_t>& radials,
                   const SweepFolds& folds);

    std::vector<float> azimuths_deg_;     // of the rows, sorted, 0 to 360
    std::vector<std::size_t> row_after_;  // the first row at or after each tenth of a degree
    std::vector<float> turns_mps_;        // of the rows
    std::vector<float> bins_;             // rows x bins_in_row_; NaN where there is no value
    std::size_t bins_in_row_ = 0;
    std::size_t values_ = 0;
    double bin_m_ = 1000, reach_m_ = 0, elevation_deg_ = 0;
};

}  // namespace stormcellar::retrieve
