// accuracy/plot.h -- plots error against time as an SVG picture.
//
// Both axes are logarithmic. A series holds the points of one step of the chain. Each series has
// its own color and shape, which readers with any color vision can distinguish (colors of Okabe and
// Ito 2008). Points on the Pareto front are filled, and a line joins them. Text is in the viewer's
// sans-serif font. The result is well-formed XML 1.0 in UTF-8. The same plot gives the same bytes.
//
// Threads   Pure functions.
// Errors    bad_argument for no points or more than 400, a time that is not above zero, an error
//           that is negative or not finite, or a size outside 400 to 4000 pixels.
#pragma once

#include <string>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::accuracy {

struct PlotPoint {
    std::string label;
    std::string series;
    double time_s = 0;
    double error = 0;
    bool pareto = false;
};

struct Plot {
    std::string title;               // a statement about the plot; a long title has smaller letters
    std::vector<std::string> below;  // lines below the title, in smaller letters
    std::string main_series;         // the series with a bolder line and labels; empty: none
    std::string error_label;         // with its unit: "Value error, 99th percentile (dB)"
    std::string time_label = "Time";
    std::vector<PlotPoint> points;
    int width = 900;
    int height = 600;
};

[[nodiscard]] Result<std::string> draw_plot(const Plot& plot);

}  // namespace stormcellar::accuracy
