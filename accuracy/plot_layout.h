// accuracy/plot_layout.h -- the positions of everything in an accuracy plot.
//
// Layout and drawing are separate, so that tests can check that nothing overlaps. A logarithmic
// axis cannot show an error of 0, so a row below the axis shows these errors. The row also shows
// errors more than four decades below the greatest error, because they are only rounding errors and
// would compress the rest of the axis.
//
// Units     Pixels, with y downward.
// Threads   Pure functions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "accuracy/plot.h"

namespace stormcellar::accuracy {

struct PlotBox {
    double left = 0, top = 0, right = 0, bottom = 0;
    [[nodiscard]] double overlap(const PlotBox& other) const;  // area
};

struct PlotTick {
    double position = 0;  // x or y
    std::string text;
};

struct PlotMarker {
    double x = 0, y = 0;
    std::size_t series = 0;
    bool pareto = false;
};

struct PlotLabel {
    PlotBox box;  // the text is inside, at the side toward its marker
    enum class Side { left, middle, right } side = Side::middle;
    std::string text;
    std::size_t marker = 0;  // number of the marker that has this label
    bool leader = false;     // true: the label is away from its marker, so a line joins them
};

struct PlotLayout {
    PlotBox frame;
    std::vector<std::vector<PlotMarker>> fronts;  // of each series, left to right
    std::vector<double> lines_below;              // y of each line below the title
    std::vector<std::string> series;              // in the order of first appearance
    std::vector<PlotTick> time_ticks, error_ticks;
    std::optional<double> zero_y;     // the row of exact points, if there are any
    double zero_below = 0;            // the row of exact points also holds errors below this value
    std::vector<PlotMarker> markers;  // one for each point, in order
    std::vector<PlotLabel> labels;    // one for each marker, in order
};

inline constexpr double marker_radius = 5;
inline constexpr double label_size = 12;
inline constexpr double title_y = 30;
inline constexpr double line_height = 20;

// Lays out a plot. Errors: the errors of draw_plot().
[[nodiscard]] Result<PlotLayout> lay_out_plot(const Plot& plot);

}  // namespace stormcellar::accuracy
