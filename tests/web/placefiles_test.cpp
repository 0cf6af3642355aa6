// Requests placefiles as GR2Analyst and GRLevel3 do, and reads each statement.
#include "web/doors/storms/placefiles.h"

#include <cstdio>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/web/served_storms.h"

namespace stormcellar::web {
namespace {

// The statements of a placefile. Lines of objects do not count.
struct ReadPlacefile {
    int refresh = 0, objects = 0, lines = 0;
    std::vector<grid::GeoPoint> places;
    std::string unread;
};

ReadPlacefile read_placefile(const std::string& text) {
    ReadPlacefile read;
    std::istringstream lines(text);
    bool is_object = false, is_inner_line = false;
    for (std::string line; std::getline(lines, line);) {
        line.erase(0, line.find_first_not_of(' '));
        grid::GeoPoint place;
        const auto begins = [&](const char* word) { return line.starts_with(word); };
        if (std::sscanf(line.c_str(), "Refresh: %d", &read.refresh) == 1) continue;
        if (std::sscanf(line.c_str(), "Object: %lf, %lf", &place.latitude_deg,
                        &place.longitude_deg) == 2) {
            ++read.objects;
            read.places.push_back(place);
            is_object = true;
        } else if (std::sscanf(line.c_str(), "%lf, %lf", &place.latitude_deg,
                               &place.longitude_deg) == 2) {
            if (!is_object) read.places.push_back(place);  // else in pixels from the object
        } else if (begins("Line:")) {
            is_inner_line = is_object;
            if (!is_object) ++read.lines;
        } else if (begins("End:")) {
            is_object = is_inner_line;
            is_inner_line = false;
        } else if (!line.empty() && !begins(";") && !begins("Title:") && !begins("Color:") &&
                   !begins("Threshold:") && !begins("Font:") && !begins("Text:")) {
            read.unread += line + "\n";
        }
    }
    return read;
}

TEST(Placefiles, CellsAreObjectsAndLines) {
    ServedStorms served;
    served.add_half_hour("KTLX");
    const Answer answer = asked(served.placefiles(), "/placefiles/cells.txt");
    ASSERT_EQ(answer.status, 200U);
    EXPECT_EQ(header_of(answer, "Content-Type"), "text/plain; charset=utf-8");
    const ReadPlacefile read = read_placefile(body_of(answer));
    EXPECT_EQ(read.unread, "");
    EXPECT_EQ(read.refresh, 1);
    EXPECT_EQ(read.objects, 1);
    EXPECT_EQ(read.lines, 2) << "track and forecast";
    EXPECT_EQ(read.places.size(), 1U + 6U + 5U);
    for (const grid::GeoPoint& place : read.places) {
        EXPECT_NEAR(place.latitude_deg, 35.333, 0.3);
        EXPECT_NEAR(place.longitude_deg, -97.278, 0.9);
    }
}

TEST(Placefiles, AreAnsweredOnceMadeAndRevalidated) {
    ServedStorms served;
    served.add("KTLX", 0);
    const char* const target =
        "/placefiles/cells.txt?area=KTLX&version=1.5&dist=120&lat=35&lon=-97";
    const Request request = request_for(target, {});
    EXPECT_FALSE(served.placefiles().answer_soon(request));
    const Answer answer = asked(served.placefiles(), target);
    EXPECT_EQ(answer.status, 200U);
    EXPECT_TRUE(served.placefiles().answer_soon(request));
    const Fields known{{"If-None-Match", header_of(answer, "ETag")}};
    EXPECT_EQ(asked(served.placefiles(), target, known).status, 304U);
}

TEST(Placefiles, RefuseWhatMakesNoSense) {
    ServedStorms served;
    served.add("KTLX", 0);
    const auto status = [&](const std::string& rest) {
        return asked(served.placefiles(), "/placefiles" + rest).status;
    };
    EXPECT_EQ(status("/cells.txt?colour=red"), 400U);
    EXPECT_EQ(status("/cells.txt?area=KTLX&area=KTLX"), 400U);
    EXPECT_EQ(status("/cells.txt?area=KOKX"), 404U);
    EXPECT_EQ(status("/cells.txt/"), 404U);
    EXPECT_EQ(status("/hail.txt"), 404U);
    EXPECT_EQ(status(""), 404U);
}

}  // namespace
}  // namespace stormcellar::web
