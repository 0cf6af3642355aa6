// retrieve/shear/plane_fit.h -- fits a plane to the velocities around each gate.
//
// The plane is V = a + b x + c y, where x is the number of gates from the middle along the range
// and y the sine of the angle from the middle, clockwise. With the sine, the rotation of a solid
// body is a plane. All velocities have the same weight. b and c come from the filtered velocities.
// Their standard errors come from the distances of the velocities before the filter from the plane,
// because filtered velocities are alike in adjacent gates and would look better than they are.
//
// Units     m/s a gate, m/s per unit of y, meters, radians.
// Cost      Sums along the range are made once for each gate, so the time of a gate grows with the
//           number of radials in its kernel, not with the number of gates.
// Accuracy  tests/retrieve/plane_fit_test.cpp compares with sums over each kernel: 1e-4.
// Threads   Immutable.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "retrieve/shear/velocity_rows.h"

namespace stormcellar::retrieve {

struct Kernel {
    // Half of the width across the radials. As an angle, it is at least one and a half spacings of
    // the radials, so that both neighbors are in the kernel, and at most 15 degrees.
    double half_width_m = 1250;
    std::size_t half_gates = 1;
    float least_share = 0.5F;
};

struct PlaneSlope {
    float along_range = 0, range_error = 0;      // m/s a gate
    float along_azimuth = 0, azimuth_error = 0;  // m/s per unit of y
    bool is_fitted = false;
};

class PlaneFit {
  public:
    // `filtered` has the shape of the rows' velocities, and a value wherever the rows have a value.
    // The rows and `filtered` must outlive the object.
    PlaneFit(const VelocityRows& rows, std::span<const float> filtered, const Kernel& kernel);

    // Fits the planes of all gates of a row. `slopes` has an entry for each gate.
    void fit_row(std::size_t row, std::span<PlaneSlope> slopes) const;

  private:
    static constexpr std::size_t block = 128;  // gates that are fitted at once
    // Sums over the gates of one radial within the kernel, for each gate. x is the number of gates
    // from the middle.
    enum Sum : std::size_t { n, x, xx, v, xv, raw, x_raw, raw_raw, sums };
    // Sums over the radials of the kernel, too.
    struct BlockSums;
    // A radial in the kernel of a row, for the gates before `end`.
    struct Neighbor {
        std::size_t row;
        float sine;  // of the angle from the row
        std::size_t end;
    };

    [[nodiscard]] float* sum(std::size_t row, Sum kind) {
        return sums_.data() + (row * sums + kind) * rows_.gates;
    }
    [[nodiscard]] const float* sum(std::size_t row, Sum kind) const {
        return sums_.data() + (row * sums + kind) * rows_.gates;
    }
    void add_row(std::size_t row, const float* filtered);
    void find_reach();
    [[nodiscard]] std::vector<Neighbor> neighbors_of(std::size_t row) const;
    [[nodiscard]] std::size_t end_of(double angle) const;
    void add_neighbor(const Neighbor& neighbor, std::size_t first, std::size_t end,
                      BlockSums& total) const;
    void solve(const BlockSums& total, std::size_t first, std::span<PlaneSlope> slopes) const;

    const VelocityRows& rows_;
    Kernel kernel_;
    std::vector<float> sums_;           // rows x sums x gates
    std::vector<std::size_t> ends_;     // of each row: its last gate with a sum, plus 1
    std::vector<double> reach_;         // of each gate: the largest angle of its kernel
    std::vector<float> expected_rows_;  // of each gate: radials of its kernel without gaps
};

}  // namespace stormcellar::retrieve
