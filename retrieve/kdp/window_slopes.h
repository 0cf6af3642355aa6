// retrieve/kdp/window_slopes.h -- slopes in windows of one length, and their means at gates.
//
// Units     Degrees and gates.
// Accuracy  Every target of the vectors gives the same bits: tests/retrieve/window_slopes_test.cpp.
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "retrieve/kdp/line_sums.h"

namespace stormcellar::retrieve {

// The slopes in all windows of one length, by the first gate of the window, from 1 - gates on. The
// error of a slope comes from the noise about the window's middle.
struct WindowSlopes {
    std::ptrdiff_t gates = 0;
    std::vector<float> slope;
    std::vector<float> fit_error;  // error from the residuals, if they exceed the noise
    std::vector<float> low,
        high;  // the slope's interval of confidence; all numbers without a slope
    std::vector<float> precision;  // 1 / fit_error^2; 0 without a slope
    std::vector<float> weight;     // error / fit_error^2; 0 without a slope
    // 1 if the phase is a line in the window, -2 if it is no line, and 0 without a slope. So a
    // positive sum means that more than two thirds of the windows show a line.
    std::vector<float> line_score;
};

// A window without enough good gates has no slope.
struct WindowRule {
    float confidence = 0;      // standard errors from the slope to the ends of its interval
    double least_good = 0;     // gates
    double most_residual = 0;  // of a line, in noise
};

// Fits the windows of `windows.gates` gates that touch a row. `noise_deg` has the noise about each
// gate of the row, preceded by the noise of the first gate, `reach` times, and followed by the
// noise of the last gate, reach + RowSums::spare times. `reach` is that of the sums.
void fit_windows(const RowSums& sums, std::span<const double> noise_deg, std::size_t reach,
                 const WindowRule& rule, WindowSlopes& windows);

// Sums over the windows that count at a gate.
struct SlopeSums {
    std::vector<float> is_even;  // 1 where the phase is a line in the longest windows, else 0
    std::vector<float> weights, slopes, squares, errors;  // all but `weights` are weighted

    // Begins the sums of `gates` gates. `longest` are the windows of the greatest length, of which
    // 0, 1, ... or all `parts` parts are before the gate.
    void begin(const WindowSlopes& longest, std::ptrdiff_t parts, std::size_t gates);
};

// Adds, at each gate, the windows of which `part` of `parts` parts are before the gate, from the
// first length on, as long as their intervals have a slope in common. `share` multiplies their
// weights. Where the phase is even, the weight of a window is its precision.
void add_windows(std::span<const WindowSlopes> lengths, std::ptrdiff_t part, std::ptrdiff_t parts,
                 float share, std::size_t gates, SlopeSums& sums);

}  // namespace stormcellar::retrieve
