// Parses the placefile of storm cells with the parser of this test, which knows the statements of
// https://www.grlevelx.com/manuals/gis/files_places.htm and accepts nothing else.
#include <array>
#include <map>
#include <sstream>
#include <stdexcept>

#include <gtest/gtest.h>

#include "stormcellar/export/cell_text.h"
#include "tests/export/tracked_cells.h"

namespace stormcellar::cell_export {
namespace {

struct PlacefileText {
    double x = 0, y = 0;  // degrees north and east, or pixels in an object
    std::string text, hover;
    bool in_object = false;
};
struct PlacefileLine {
    std::vector<std::array<double, 2>> points;
    std::string hover;
    bool in_object = false;
};

class PlacefileParser {
  public:
    std::map<std::string, std::string> settings;  // of the head
    std::vector<PlacefileText> texts;
    std::vector<PlacefileLine> lines;
    std::vector<std::array<double, 2>> objects;

    explicit PlacefileParser(const std::string& content) {
        std::istringstream from(content);
        for (std::string line; std::getline(from, line);)
            parse(without_comment(line));
        if (in_line_ || in_object_) throw std::runtime_error("End: is missing");
    }

  private:
    bool in_line_ = false, in_object_ = false;

    static std::string without_comment(std::string line) {
        bool quoted = false;
        for (std::size_t i = 0; i < line.size(); ++i) {
            if (line[i] == '"') quoted = !quoted;
            if (!quoted && line[i] == ';') line.resize(i);
        }
        if (quoted) throw std::runtime_error("a text does not end: " + line);
        const std::size_t first = line.find_first_not_of(' ');
        return first == std::string::npos ? std::string{} : line.substr(first);
    }

    // Splits at commas outside of quotes, and removes blanks and quotes around the parts.
    static std::vector<std::string> parts_of(const std::string& text) {
        std::vector<std::string> parts(1);
        bool quoted = false;
        for (const char c : text) {
            if (c == '"')
                quoted = !quoted;
            else if (c == ',' && !quoted)
                parts.emplace_back();
            else if (quoted || c != ' ')
                parts.back() += c;
        }
        return parts;
    }

    static double number(const std::string& text) {
        std::size_t end = 0;
        const double value = std::stod(text, &end);
        if (end != text.size()) throw std::runtime_error("not a number: " + text);
        return value;
    }

    void parse(const std::string& line) {
        if (line.empty()) return;
        if (line == "End:") return end();
        if (in_line_) {
            const auto parts = parts_of(line);
            if (parts.size() != 2) throw std::runtime_error("not a point: " + line);
            lines.back().points.push_back({number(parts[0]), number(parts[1])});
            return;
        }
        const std::size_t colon = line.find(':');
        if (colon == std::string::npos) throw std::runtime_error("no statement: " + line);
        statement(line.substr(0, colon), line.substr(colon + 1));
    }

    void end() {
        if (in_line_)
            in_line_ = false;
        else if (in_object_)
            in_object_ = false;
        else
            throw std::runtime_error("End: without a statement");
    }

    void statement(const std::string& name, const std::string& rest) {
        const auto parts = parts_of(rest);
        if (name == "Title" || name == "Refresh" || name == "Threshold" || name == "Font") {
            settings[name] = rest;
        } else if (name == "Color") {
            int r = -1, g = -1, b = -1;
            std::istringstream(rest) >> r >> g >> b;
            if (std::min({r, g, b}) < 0 || std::max({r, g, b}) > 255)
                throw std::runtime_error("no color: " + rest);
        } else if (name == "Line") {
            lines.push_back({{}, parts.at(2), in_object_});
            in_line_ = true;
        } else if (name == "Object") {
            objects.push_back({number(parts.at(0)), number(parts.at(1))});
            in_object_ = true;
        } else if (name == "Text") {
            if (parts.size() != 5 || parts[2] != "1") throw std::runtime_error("text: " + rest);
            texts.push_back({number(parts[0]), number(parts[1]), parts[3], parts[4], in_object_});
        } else {
            throw std::runtime_error("unknown statement: " + name);
        }
    }
};

TEST(CellPlacefile, HasCellsTracksAndForecasts) {
    const PlacefileParser file(cells_placefile(two_tracked_cells(), {"KTLX cells", 2}));
    EXPECT_EQ(file.settings.at("Title"), " KTLX cells");
    EXPECT_EQ(file.settings.at("Refresh"), " 2");
    ASSERT_EQ(file.objects.size(), 2U);
    EXPECT_EQ(file.objects[0][0], 35.33333);
    EXPECT_EQ(file.objects[0][1], -97.5);
    ASSERT_EQ(file.lines.size(), 4U);  // a track, a forecast, and a mark for each cell
    EXPECT_EQ(file.lines[0].hover, "track of 20130520_195500_35.32N_97.51W");
    EXPECT_EQ(file.lines[0].points.size(), 2U);
    EXPECT_EQ(file.lines[1].points.size(), 3U);
    EXPECT_EQ(file.lines[1].points[2][0], 35.6);
    EXPECT_TRUE(file.lines[2].in_object);
    EXPECT_EQ(file.lines[2].points.front(), file.lines[2].points.back());
    ASSERT_EQ(file.texts.size(), 4U);  // two forecasts and two maxima
    EXPECT_EQ(file.texts[1].hover, "60 min +- 15 km");
    EXPECT_EQ(file.texts[2].text, "62");
    const std::string& hover = file.texts[2].hover;
    for (const char* part : {"split from 20130520_193000", "Top at least 50 kft", "MESH 38 mm",
                             "Shear 0.0123 /s", "From 243 deg at 22 kt"})
        EXPECT_NE(hover.find(part), std::string::npos) << part << " in " << hover;
    EXPECT_EQ(file.texts[3].hover.find("MESH"), std::string::npos);
}

TEST(CellPlacefile, WithoutCellsIsAHead) {
    const PlacefileParser file(cells_placefile({}));
    EXPECT_EQ(file.settings.size(), 4U);
    EXPECT_TRUE(file.lines.empty() && file.texts.empty() && file.objects.empty());
}

TEST(CellPlacefile, NamesFromOutsideDoNotBreakIt) {
    auto cells = two_tracked_cells();
    cells[0].id = "a\"; Text: 1, 2, 3\nEnd:\n";
    const PlacefileParser file(cells_placefile(cells, {"x\nRefresh: 0; \"", -5}));
    EXPECT_EQ(file.objects.size(), 2U);
    EXPECT_EQ(file.settings.at("Refresh"), " 1");
}

}  // namespace
}  // namespace stormcellar::cell_export
