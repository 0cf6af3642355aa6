// accuracy/plot.h -- error against time, as an SVG picture.
//
// Both axes are logarithmic. Each series (a step of the chain) has a colour and a shape of its own,
// which are told apart in any colour vision (colours of Okabe and Ito 2008); points on the Pareto
// front are filled and joined by a line. Text is in whatever sans-serif font the viewer has.
// The result is well-formed XML 1.0 in UTF-8, the same bytes for the same plot.
// Errors: bad_argument without points, with more than 400, for a time that is not above zero, an
// error that is negative, or one that is not finite; a size outside 400 to 4000 pixels.
// Thread contract: pure functions.
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
    std::string title;
    std::string error_label;  // with its unit: "Value error, 99th percentile (dB)"
    std::string time_label = "Time";
    std::vector<PlotPoint> points;
    int width = 900;
    int height = 600;
};

[[nodiscard]] Result<std::string> draw_plot(const Plot& plot);

}  // namespace stormcellar::accuracy
