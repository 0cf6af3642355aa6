// retrieve/kdp/phase_slope.h -- the slope of the differential phase along one radial, by least
// squares in windows that adapt to it.
//
// Windows before, about and after a gate grow until the slope in a longer window contradicts the
// slope in a shorter window by more than their errors allow (intersection of confidence intervals:
// Goldenshluger and Nemirovski 1997, Katkovnik 1999). The slope is the mean of all windows that
// agree, and windows about the gate weigh most. So the windows are long where the phase changes
// evenly, as in weak rain, and short beside the edges of a core. At gates where the phase is a line
// in most windows of the greatest length, long windows weigh most, which halves the error.
//
// Units     Degrees and gates.
// Accuracy  include/stormcellar/retrieve/kdp.h.
// Threads   One thread at a time.
#pragma once

#include <cstddef>
#include <vector>

#include "retrieve/kdp/line_sums.h"
#include "retrieve/kdp/phase_row.h"
#include "retrieve/kdp/window_slopes.h"

namespace stormcellar::retrieve {

struct PhaseSlopes {
    std::vector<float> deg_per_gate;  // NaN where no slope can be fitted
    std::vector<float> error;         // standard error of the slope; NaN likewise
};

// Fits the slopes of one radial after another. Each radial reuses the memory of the last radial.
class SlopeFitter {
  public:
    explicit SlopeFitter(double spacing_m);

    // Marks gates with backscatter phase as not good, and fits slopes at the gates that have a
    // phase. The row must have gates. The result is valid until the next call.
    const PhaseSlopes& fit(PhaseRow& row);

  private:
    void read(const PhaseRow& row);
    [[nodiscard]] bool leave_out_backscatter(PhaseRow& row) const;
    void extend_noise();

    double spacing_m_;
    std::ptrdiff_t reach_;  // gates of the longest window
    RowSums sums_;
    std::vector<double> noise_deg_;
    std::vector<WindowSlopes> lengths_;
    SlopeSums means_;
    PhaseSlopes slopes_;
};

}  // namespace stormcellar::retrieve
