// Serves overlays from files as other programs write them, and leaves out what cannot be read.
#include "web/doors/overlays/overlays.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/testing/temporary_directory.h"
#include "tests/web/asked.h"

namespace stormcellar::web {
namespace {

using nlohmann::json;

class Overlays : public ::testing::Test {
  protected:
    void write(const std::string& name, std::string_view text) const {
        std::filesystem::create_directories(directory_ / "warnings");
        std::ofstream(directory_ / "warnings" / name) << text;
    }
    [[nodiscard]] json collection() {
        const Answer answer = asked(door_, "/overlays/warnings.geojson");
        EXPECT_EQ(answer.status, 200U);
        EXPECT_EQ(header_of(answer, "Content-Type"), "application/geo+json");
        return json::parse(body_of(answer));
    }

    testing::TemporaryDirectory directory_;
    OverlaysDoor door_{
        {{"warnings", directory_ / "warnings"}, {"roads", directory_ / "roads.txt"}}};
};

constexpr const char* one_warning = R"({"type": "Feature",
    "properties": {"event": "Tornado Warning", "onset": "2016-06-01T10:02:00-05:00",
                   "ends": "2016-06-01T10:45:00-05:00", "description": "long text"},
    "geometry": {"type": "Polygon", "coordinates": [[[-102, 33], [-101, 33], [-102, 33]]]}})";

TEST_F(Overlays, AreListed) {
    const Answer answer = asked(door_, "/overlays");
    ASSERT_EQ(answer.status, 200U);
    EXPECT_EQ(json::parse(body_of(answer)),
              json::parse(R"({"overlays": [{"name": "warnings"}, {"name": "roads"}]})"));
}

TEST_F(Overlays, FilesOfADirectoryBecomeFeaturesWithFewProperties) {
    write("b.txt", "Color: 1 2 3\nText: 33.5, -101.5, 1, \"Lubbock\"\n");
    write("a.geojson", one_warning);
    write(".half-written", "{");
    EXPECT_EQ(collection(), json::parse(R"({"type": "FeatureCollection", "features": [
        {"type": "Feature",
         "properties": {"stroke": "#ff0000", "stroke-width": 2.0,
                        "begin": "2016-06-01T15:02:00Z", "end": "2016-06-01T15:45:00Z"},
         "geometry": {"type": "LineString", "coordinates": [[-102, 33], [-101, 33], [-102, 33]]}},
        {"type": "Feature",
         "properties": {"stroke": "#010203", "stroke-width": 2.0, "name": "Lubbock"},
         "geometry": {"type": "Point", "coordinates": [-101.5, 33.5]}}]})"));
}

TEST_F(Overlays, ADamagedFileIsNamedAndTheOthersAreServed) {
    write("a.geojson", one_warning);
    write("b.geojson", R"({"type": "Point", "coordinates": [1]})");
    const json read = collection();
    EXPECT_EQ(read["features"].size(), 1U);
    ASSERT_EQ(read["left_out"].size(), 1U);
    const std::string why = read["left_out"][0];
    EXPECT_TRUE(why.starts_with("b.geojson: ")) << why;
    EXPECT_NE(why.find("a position is no list of two numbers"), std::string::npos) << why;
    EXPECT_EQ(why.find(directory_.path().native()), std::string::npos)
        << "clients see no paths of the server";
}

TEST_F(Overlays, AreReadAgainWhenAFileChangesOrComes) {
    EXPECT_EQ(collection()["left_out"].size(), 1U) << "there is no such directory yet";
    write("a.geojson", one_warning);
    EXPECT_EQ(collection()["features"].size(), 1U);
    write("b.geojson", one_warning);
    EXPECT_EQ(collection()["features"].size(), 2U);
    std::filesystem::remove(directory_ / "warnings" / "a.geojson");
    write("b.geojson", R"({"type": "FeatureCollection", "features": []})");
    EXPECT_EQ(collection()["features"].size(), 0U);
}

// The same bytes in memory answer again and again, until a file changes.
TEST_F(Overlays, AreCompressedOnce) {
    std::string line = R"({"type": "LineString", "coordinates": [[1, 2])";
    for (int i = 0; i < 1000; ++i)
        line += ", [1, 2]";
    write("a.geojson", line + "]}");
    const ServedOverlays served({{"warnings", directory_ / "warnings"}});
    const auto sent = [&](Coding coding) { return served.geojson("warnings", coding)->value(); };
    const SentOverlay first = sent(Coding::gzip);
    EXPECT_EQ(first.coding, Coding::gzip);
    EXPECT_LT(first.bytes->size(), sent(Coding::identity).bytes->size() / 4);
    EXPECT_EQ(sent(Coding::gzip).bytes, first.bytes) << "compressed once more";
    EXPECT_NE(sent(Coding::zstd).etag, first.etag);
    write("a.geojson", line + ", [3, 4]]}");
    EXPECT_NE(sent(Coding::gzip).etag, first.etag);
    EXPECT_NE(sent(Coding::gzip).bytes, first.bytes);
    std::filesystem::remove(directory_ / "warnings" / "a.geojson");
    EXPECT_EQ(sent(Coding::gzip).coding, Coding::identity) << "short texts are not compressed";
    const Answer answer = asked(door_, "/overlays/warnings.geojson",
                                {{"If-None-Match", sent(Coding::identity).etag}});
    EXPECT_EQ(answer.status, 304U);
}

TEST_F(Overlays, WhatIsTooMuchIsLeftOut) {
    std::string line = R"({"type": "LineString", "coordinates": [[1, 2])";
    for (int i = 0; i < 150'000; ++i)
        line += ", [1, 2]";
    write("a.geojson", line + "]}");
    write("b.geojson", line + "]}");
    const json read = collection();
    EXPECT_EQ(read["features"].size(), 1U);
    EXPECT_EQ(read["left_out"], json::parse(R"(["b.geojson: too many points"])"));
}

TEST_F(Overlays, OtherAddressesAreNotFound) {
    for (const char* path : {"/overlays/other.geojson", "/overlays/warnings",
                             "/overlays/warnings/a.geojson", "/overlays/..geojson"})
        EXPECT_EQ(asked(door_, path).status, 404U) << path;
}

}  // namespace
}  // namespace stormcellar::web
