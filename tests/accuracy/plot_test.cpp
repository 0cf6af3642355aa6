#include "accuracy/plot.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/testing/program.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::accuracy {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Plot small_plot() {
    Plot plot;
    plot.title = "Error against time";
    plot.error_label = "Value error, 99th percentile (dB)";
    plot.points = {{"nearest", "interpolation", 0.02, 4.1, true},
                   {"8-point", "interpolation", 0.2, 0.4, true},
                   {"slow and bad", "interpolation", 0.5, 2, false},
                   {"exact", "beam", 1.5, 0, true}};
    return plot;
}

std::string drawn(const Plot& plot) {
    auto svg = draw_plot(plot);
    EXPECT_TRUE(svg);
    return svg.value_or("");
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++found;
    return found;
}

// Parses the SVG with an independent XML parser and returns its texts, one per line.
stormcellar::testing::ProgramResult parse_xml(const std::string& svg) {
    const stormcellar::testing::TemporaryDirectory directory;
    const auto path = directory.path() / "plot.svg";
    std::ofstream(path, std::ios::binary) << svg;
    return stormcellar::testing::run_program(
        "/usr/bin/python3", {"-c",
                             "import sys, xml.etree.ElementTree as tree\n"
                             "root = tree.parse(sys.argv[1]).getroot()\n"
                             "assert root.tag == '{http://www.w3.org/2000/svg}svg', root.tag\n"
                             "for node in root.iter('{http://www.w3.org/2000/svg}text'):\n"
                             "    sys.stdout.buffer.write((node.text + '\\n').encode())\n",
                             path});
}

#define STORMCELLAR_NEED_PYTHON()                     \
    if (!std::filesystem::exists("/usr/bin/python3")) \
    GTEST_SKIP() << "no /usr/bin/python3 to parse XML with"

TEST(Plot, IsWellFormedXmlWithAllItsTexts) {
    STORMCELLAR_NEED_PYTHON();
    const auto parsed = parse_xml(drawn(small_plot()));
    EXPECT_EQ(parsed.status, 0) << parsed.err;
    for (const char* text :
         {"Error against time\n", "Value error, 99th percentile (dB)\n", "nearest\n", "8-point\n",
          "slow and bad\n", "exact\n", "interpolation\n", "beam\n", "100 ms\n", "Time\n"}) {
        EXPECT_THAT(parsed.out, HasSubstr(text));
    }
}

TEST(Plot, TextFromOutsideIsTextAndNothingElse) {
    STORMCELLAR_NEED_PYTHON();
    Plot plot = small_plot();
    const std::string hostile = "</text><script>\"&amp;'<!-- ]]> \xff\x01 \xEF\xBF\xBE \xc3\xa9";
    plot.title = plot.error_label = plot.time_label = hostile;
    for (PlotPoint& point : plot.points)
        point.label = point.series = hostile;
    const std::string svg = drawn(plot);
    EXPECT_THAT(svg, Not(HasSubstr("<script")));
    const auto parsed = parse_xml(svg);
    EXPECT_EQ(parsed.status, 0) << parsed.err;
    EXPECT_THAT(parsed.out,
                HasSubstr("</text><script>\"&amp;'<!-- ]]> \\xff\\x01 \xEF\xBF\xBD \xc3\xa9\n"));
}

TEST(Plot, EveryPointIsDrawnAndTheFrontIsALine) {
    const std::string svg = drawn(small_plot());
    EXPECT_EQ(count(svg, "<circle"), 3U + 1);  // one in the plot, and one in the legend
    EXPECT_EQ(count(svg, "<polyline"), 1U);    // a single point has no line
    EXPECT_EQ(count(svg, "fill=\"#ffffff\" stroke=\"#0072B2\""), 1U);  // hollow: not on the front
    EXPECT_THAT(svg, Not(HasSubstr("http://www.w3.org/1999/xlink")));
    EXPECT_THAT(svg, Not(HasSubstr("url(")));
    EXPECT_THAT(svg, HasSubstr("font-family=\"sans-serif\""));
}

TEST(Plot, NoNumberInItIsNan) {
    Plot plot = small_plot();
    for (PlotPoint& point : plot.points)
        point = {"same", "same", 1, 1, true};
    const std::string svg = drawn(plot);
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(Plot, ThirtyFiveSeriesLookDifferent) {
    Plot plot = small_plot();
    plot.points.clear();
    for (int i = 0; i < 35; ++i) {
        plot.points.push_back({"", std::to_string(i), 1.0 + i, 1.0 + i, true});
    }
    const std::string svg = drawn(plot);
    // The markers in the legend take the colors and the shapes in turn.
    for (const char* color :
         {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"}) {
        EXPECT_EQ(count(svg, std::string("fill=\"") + color), 10U) << color;
    }
    EXPECT_EQ(count(svg, "<circle"), 14U);
}

TEST(Plot, PointsWithoutAPlaceAreRefused) {
    const auto refused = [](double time_s, double error) {
        Plot plot = small_plot();
        plot.points[1].time_s = time_s;
        plot.points[1].error = error;
        const auto svg = draw_plot(plot);
        return !svg && svg.error().code == ErrorCode::bad_argument;
    };
    constexpr double infinity = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(refused(1, 1));
    EXPECT_TRUE(refused(0, 1));
    EXPECT_TRUE(refused(-1, 1));
    EXPECT_TRUE(refused(1, -1));
    EXPECT_TRUE(refused(infinity, 1));
    EXPECT_TRUE(refused(1, infinity));
    EXPECT_TRUE(refused(std::nan(""), 1));
    EXPECT_TRUE(refused(1, std::nan("")));
    Plot plot = small_plot();
    plot.width = 399;
    EXPECT_FALSE(draw_plot(plot));
    plot = small_plot();
    plot.points.clear();
    EXPECT_FALSE(draw_plot(plot));
    plot.points.assign(401, {"a", "s", 1, 1, true});
    EXPECT_FALSE(draw_plot(plot));
}

}  // namespace
}  // namespace stormcellar::accuracy
