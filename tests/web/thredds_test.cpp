// Tests every request and answer of THREDDS that Siphon and the IDV depend on, with real volumes.
#include "web/doors/thredds/thredds.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "stormcellar/cache/store.h"
#include "tests/cache/made_grids.h"
#include "tests/web/raw_client.h"
#include "tests/web/served_volumes.h"
#include "web/http/server.h"

namespace stormcellar::web {
namespace {

constexpr const char* level2 = "/thredds/radarServer/nexrad/level2/IDD";

// Returns the text between the first `before` and the next `behind`.
std::string text_between(const std::string& text, std::string_view before,
                         std::string_view behind) {
    const std::size_t from = text.find(before);
    if (from == text.npos) return {};
    const std::size_t begin = from + before.size();
    return text.substr(begin, text.find(behind, begin) - begin);
}

std::size_t count_in(const std::string& text, std::string_view part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

class Thredds : public VolumesDoorTest<ThreddsDoor> {
  protected:
    std::string query(std::string_view text) { return body_of(get(level2 + std::string{text})); }
    void configure(ThreddsConfig config, std::size_t most_results = 10'000) {
        door_ = std::make_unique<ThreddsDoor>(
            served_volumes().files(),
            ThreddsOptions{.config = std::move(config), .most_results = most_results});
    }
};

TEST_F(Thredds, TheTopCatalogNamesTheDataSets) {
    for (const char* path : {"/thredds/radarServer/catalog.xml", "/thredds/radarServer/",
                             "/thredds//radarServer//catalog.xml"}) {
        const Answer answer = get(path);
        EXPECT_EQ(answer.status, 200U);
        EXPECT_EQ(header_of(answer, "Content-Type"), "application/xml");
        const std::string xml = body_of(answer);
        EXPECT_NE(xml.find("xmlns=\"http://www.unidata.ucar.edu/namespaces/thredds/InvCatalog/"
                           "v1.0\""),
                  xml.npos);
        EXPECT_NE(xml.find("xmlns:xlink=\"http://www.w3.org/1999/xlink\""), xml.npos);
        EXPECT_NE(xml.find("<service name=\"radarServer\" serviceType=\"QueryCapability\" "
                           "base=\"/thredds/radarServer/\"/>"),
                  xml.npos);
        EXPECT_NE(xml.find("<catalogRef xlink:href=\"nexrad/level2/IDD/dataset.xml\" "
                           "xlink:title=\"NEXRAD Level II Radar from IDD\" "
                           "name=\"NEXRAD Level II Radar from IDD\"/>"),
                  xml.npos);
    }
    EXPECT_EQ(header_of(get("/thredds/radarServer"), "Location"),
              "http://localhost:8090/thredds/radarServer/");
    EXPECT_NE(body_of(get("/thredds/catalog.xml")).find("/thredds/radarServer/catalog.xml"),
              std::string::npos);
}

TEST_F(Thredds, ADataSetSaysWhatItHas) {
    const std::string xml = query("/dataset.xml");
    EXPECT_NE(xml.find("serviceType=\"DQC\""), xml.npos);
    EXPECT_NE(xml.find("urlPath=\"nexrad/level2/IDD\""), xml.npos);
    EXPECT_NE(xml.find("<serviceName>radarServer</serviceName>"), xml.npos);
    EXPECT_NE(xml.find("<dataFormat>NEXRAD2</dataFormat>"), xml.npos);
    EXPECT_NE(xml.find("<metadata inherited=\"true\">"), xml.npos);
    EXPECT_NE(xml.find("<documentation type=\"summary\">"), xml.npos);
    const std::string north = text_between(xml, "<northsouth>", "</northsouth>");
    EXPECT_LE(std::stod(text_between(north, "<start>", "<")), 35.33 - 4);
    EXPECT_GE(std::stod(text_between(north, "<start>", "<")) +
                  std::stod(text_between(north, "<size>", "<")),
              45.46 + 4);
    const std::string time = text_between(xml, "<timeCoverage>", "</timeCoverage>");
    EXPECT_EQ(text_between(time, "<start>", "<"), "1991-07-20T16:05:18Z");
    EXPECT_EQ(text_between(time, "<end>", "<"), "present");
    EXPECT_NE(xml.find("<variables vocabulary=\"DIF\">"), xml.npos);
    for (const char* name :
         {"Reflectivity", "Velocity", "SpectrumWidth", "DifferentialReflectivity",
          "CorrelationCoefficient", "DifferentialPhase"})
        EXPECT_NE(xml.find(fmt::format("<variable name=\"{}\"", name)), xml.npos) << name;
}

TEST_F(Thredds, StationsHaveNoNamespace) {
    for (const char* path : {"/stations.xml", "?station=all", "/?station=all"}) {
        const std::string xml = query(path);
        EXPECT_NE(xml.find("\n<stationsList>\n"), xml.npos) << path;
        EXPECT_EQ(count_in(xml, "<station "), 2U);
        EXPECT_NE(xml.find("<station id=\"KTLX\" state=\"OK\" country=\"US\">"), xml.npos);
        const std::string ktlx = text_between(xml, "id=\"KTLX\"", "</station>");
        EXPECT_EQ(text_between(ktlx, "<name>", "<"), "Oklahoma City");
        EXPECT_EQ(std::stod(text_between(ktlx, "<latitude>", "<")), 35.33336);
        EXPECT_EQ(std::stod(text_between(ktlx, "<longitude>", "<")), -97.27776);
        EXPECT_EQ(std::stod(text_between(ktlx, "<elevation>", "<")), 389.5);
    }
}

// 2026-11-28: a radar whose place is known only from its file was in no list and in no box.
TEST_F(Thredds, AStationThatItsFilesPlaceHasAPlace) {
    const auto file = *testing::data_directory() /
                      "cases/files/6-station-not-in-the-table/ROP420240601_220000_V06";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    ServedVolumes served(false);
    served.take(file, "ROP420240601_220000_V06");
    grid::Grid made = testing::small_grid();
    made.sites = {{"ROP4", 35.24, -97.46, 300}};
    auto store = *cache::StoreWriter::open(real_file_system(), served.state() / "cache", false);
    ASSERT_TRUE(store.commit(
        "ROP4", cache::describe(made),
        grid::BrickGrid::from(made, grid::default_quantization(level2::Moment::ref)).view()));
    const auto files = [&](const std::shared_ptr<Grids>& grids) {
        return RawFiles::open_catalog(
            {.catalog = served.state() / "catalog", .grids = grids, .scratch = {}});
    };
    door_ = std::make_unique<ThreddsDoor>(files(*Grids::open({.cache = served.state() / "cache"})));
    const std::string station = text_between(query("/stations.xml"), "id=\"ROP4\"", "</station>");
    EXPECT_EQ(text_between(station, "<latitude>", "<"), "35.24");
    EXPECT_EQ(text_between(station, "<elevation>", "<"), "300.0");
    const std::string_view box = "?north=36&south=34&west=-98&east=-96&temporal=all";
    EXPECT_EQ(count_in(query(box), "urlPath"), 1U);
    door_ = std::make_unique<ThreddsDoor>(files(nullptr));
    EXPECT_EQ(count_in(query(box), "urlPath"), 0U) << "without a grid the place is unknown";
}

// 2026-11-28: for each station without a place in the table, all stations were listed again.
TEST(ThreddsStations, AllPlacesAreAskedForAtOnce) {
    class CountedFiles final : public RawFiles {
      public:
        Result<std::vector<RawStation>> stations() override {
            ++asked;
            std::vector<RawStation> all;
            for (int i = 100; i < 200; ++i) {
                RawStation& station = all.emplace_back();
                station.icao = "Z" + std::to_string(i);
                station.has_place = i % 2 == 0;
                station.latitude_deg = 40;
            }
            return all;
        }
        Result<std::vector<RawVolume>> list(std::string_view, const RawRange&) override {
            return std::vector<RawVolume>{};
        }
        OpenedOrMissing open(std::string_view, std::string_view) override {
            return tl::unexpected(RawFailure{});
        }
        std::optional<OpenedVolume> open_kept(std::string_view, std::string_view) override {
            return std::nullopt;
        }
        int asked = 0;
    };
    const auto files = std::make_shared<CountedFiles>();
    ThreddsDoor door(files);
    const std::string xml = body_of(asked(door, level2 + std::string{"/stations.xml"}));
    EXPECT_EQ(count_in(xml, "<station "), 50U) << "the other stations have no place";
    EXPECT_EQ(files->asked, 2);
}

TEST_F(Thredds, AnAnswerHasWhatClientsResolve) {
    const Answer answer = get(level2 + std::string{"?stn=KTLX&time=2017-01-01T03%3A30%3A00"});
    EXPECT_EQ(answer.status, 200U);
    EXPECT_EQ(header_of(answer, "Content-Type"), "application/xml");
    const std::string xml = body_of(answer);
    EXPECT_TRUE(xml.ends_with("</catalog>\n"));
    EXPECT_NE(xml.find("<service name=\"RadarServices\" serviceType=\"Compound\" base=\"\">"),
              xml.npos);
    EXPECT_EQ(text_between(xml, "<serviceName>", "<"), "RadarServices");
    EXPECT_NE(xml.find("serviceType=\"HTTPServer\" "
                       "base=\"/thredds/fileServer/nexrad/level2/IDD/\""),
              xml.npos);
    EXPECT_EQ(xml.find("OPENDAP"), xml.npos) << "OPeNDAP is not served";
    EXPECT_NE(xml.find("<documentation>1 datasets found for query</documentation>"), xml.npos);
    EXPECT_NE(xml.find("<dataset name=\"KTLX20170101_030027_V06\" "), xml.npos);
    const std::string path = text_between(xml, "V06\" urlPath=\"", "\"");
    EXPECT_EQ(path, "KTLX/20170101/KTLX20170101_030027_V06");
    EXPECT_NE(xml.find("<date type=\"start of ob\">2017-01-01T03:00:27Z</date>"), xml.npos);
    EXPECT_NE(xml.find("ID=\"stn=KTLX&amp;time=2017-01-01T03:30:00\""), xml.npos);

    const Answer file = get("/thredds/fileServer/nexrad/level2/IDD/" + path);
    EXPECT_EQ(file.status, 200U);
    EXPECT_EQ(header_of(file, "Content-Type"), "application/octet-stream");
    const auto bytes =
        read_file(*testing::data_directory() / "volumes/KTLX20170101_030027_V06").value();
    EXPECT_EQ(body_of(file),
              std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

TEST_F(Thredds, ALoneTimeGivesTheNearestFileOfEachStationWithinAnHour) {
    EXPECT_EQ(count_in(query("?stn=KTLX&stn=KABR&time=2017-01-01T04:00:00"), "urlPath"), 1U);
    EXPECT_EQ(count_in(query("?stn=KTLX&time=2017-01-01T02:00:27Z"), "urlPath"), 1U);
    EXPECT_EQ(count_in(query("?stn=KTLX&time=2017-01-01T02:00:26Z"), "urlPath"), 0U);
    EXPECT_EQ(count_in(query("?stn=KTLX&time=2017-01-01T04:01:00Z"), "urlPath"), 0U);
    const std::string several =
        query("?stn=KTLX&stn=KABR&time=1991-07-20T16:00&time=2005-01-01&time=2005-01-01T00:10");
    EXPECT_EQ(count_in(several, "urlPath"), 2U) << "each name comes once";
}

TEST_F(Thredds, RangesAndPlacesAreHeard) {
    EXPECT_EQ(count_in(query("?stn=KTLX&temporal=all"), "urlPath"), 2U);
    EXPECT_EQ(count_in(query("?stn=all&temporal=all"), "urlPath"), 3U);
    EXPECT_EQ(count_in(query("?stn=KTLX&time_start=2016-12-31&time_duration=P2D"), "urlPath"), 1U);
    EXPECT_EQ(count_in(query("/?stn=KTLX&time_end=1992-01-01&time_duration=1 year"), "urlPath"),
              1U);
    const std::string nearest = query("?longitude=-99&latitude=44&temporal=all");
    EXPECT_EQ(count_in(nearest, "urlPath"), 1U);
    EXPECT_NE(nearest.find("KABR20050101_000745"), nearest.npos);
    EXPECT_EQ(count_in(query("?north=50&south=40&east=-90&west=-100&temporal=all"), "KABR/"), 2U);
    EXPECT_EQ(count_in(query("?north=50&south=48&east=-90&west=-100&temporal=all"), "urlPath"), 0U);
    for (const char* across : {"east=-90&west=170", "east=270&west=170", "east=-90&west=-190"})
        EXPECT_EQ(
            count_in(query(std::string("?north=50&south=40&temporal=all&") + across), "KABR/"), 2U)
            << across;
}

// The IDV sends "?&stn=" and the end "present". Unknown names are not an error.
TEST_F(Thredds, TheIdvsQueriesAreAnswered) {
    const std::string all = query("?&stn=KTLX&time_start=1990-01-01T00:00:00&time_end=present");
    EXPECT_NE(all.find("2 datasets found for query"), all.npos);
    EXPECT_LT(all.find("KTLX19910720"), all.find("KTLX20170101"))
        << "volumes are in the order of time";
    const std::string none = query("?&stn=KZZZ&time_start=1990-01-01&time_end=present");
    EXPECT_NE(none.find("0 datasets found for query"), none.npos);
    EXPECT_NE(query("?stn=../../etc&temporal=all").find("0 datasets"), std::string::npos);
}

TEST_F(Thredds, AQueryThatMakesNoSenseIsASentenceWithStatus200) {
    for (const char* text : {"", "/", "?stn=KTLX", "?time=present", "?stn=KTLX&time=never",
                             "?stn=KTLX&time_start=2015-01-01"}) {
        const Answer answer = get(level2 + std::string{text});
        EXPECT_EQ(answer.status, 200U) << text;
        EXPECT_EQ(header_of(answer, "Content-Type").substr(0, 10), "text/plain") << text;
        EXPECT_TRUE(body_of(answer).ends_with(".\n")) << text;
    }
}

TEST_F(Thredds, WhatIsNotThereIsARealError) {
    EXPECT_EQ(get("/thredds/radarServer/nexrad/level9/IDD/dataset.xml").status, 404U);
    EXPECT_EQ(get("/thredds/radarServer/nexrad/level2/IDD/other.xml").status, 404U);
    EXPECT_EQ(get("/thredds/dodsC/nexrad/level2/IDD/x").status, 404U);
    const std::string files = "/thredds/fileServer/nexrad/level2/IDD/";
    for (const char* path :
         {"KTLX/20170101/KTLX20170101_030028_V06", "KTLX/20170102/KTLX20170101_030027_V06",
          "KTLX/KTLX20170101_030027_V06", "KABR/20170101/KTLX20170101_030027_V06", "", "KTLX",
          "KTLX/20170101/KTLX20170101_030027_V06/"})
        EXPECT_EQ(get(files + path).status, 404U) << path;
}

TEST_F(Thredds, AnswersAreBounded) {
    configure(WebConfig::usual_thredds(), 2);
    EXPECT_EQ(count_in(query("?stn=KTLX&temporal=all"), "urlPath"), 2U);
    const Answer answer = get(level2 + std::string{"?stn=all&temporal=all"});
    EXPECT_EQ(answer.status, 200U);
    EXPECT_NE(body_of(answer).find("more than 2 datasets"), std::string::npos);
    EXPECT_NE(query("?stn=A,B,C&time=present").find("more than 2 datasets"), std::string::npos);
}

TEST_F(Thredds, NamesAndQueriesAreEscaped) {
    configure({{{"nexrad/level2/IDD", "A <b> & \"c\"", {}, {}, {}}}, {}, {}});
    const std::string xml = query("?stn=%3Cscript%3E&temporal=all&%22%26%3E='");
    EXPECT_EQ(xml.find("<script>"), xml.npos);
    EXPECT_NE(xml.find("ID=\"stn=&lt;script&gt;&amp;temporal=all&amp;&quot;&amp;&gt;=&#39;\""),
              xml.npos)
        << xml;
    EXPECT_NE(xml.find("A &lt;b&gt; &amp; &quot;c&quot;"), xml.npos);
}

TEST_F(Thredds, PlacesOfTheConfigurationCountBeforeTheTable) {
    ThreddsConfig config = WebConfig::usual_thredds();
    config.collections[0].stations = {"KTLX", "KFTG"};
    config.places = {{"KFTG", "DENVER/Boulder", "CO", 39.78, -104.53, 1675}};
    configure(std::move(config));
    const std::string xml = query("/stations.xml");
    EXPECT_EQ(count_in(xml, "<station "), 2U);
    const std::string kftg = text_between(xml, "id=\"KFTG\" state=\"CO\"", "</station>");
    EXPECT_EQ(text_between(kftg, "<elevation>", "<"), "1675.0");
    EXPECT_EQ(text_between(kftg, "<latitude>", "<"), "39.78");
    EXPECT_EQ(text_between(kftg, "<longitude>", "<"), "-104.53");
    EXPECT_EQ(count_in(query("?stn=KABR&temporal=all"), "urlPath"), 0U)
        << "the station is not named";
}

TEST_F(Thredds, ADeniedBeginningIs403) {
    configure(
        {WebConfig::usual_thredds().collections, {}, {"aws", "fileServer/nexrad/level2/IDD/KTLX"}});
    EXPECT_EQ(get("/thredds/aws/radarServer/catalog.xml").status, 403U);
    const std::string files = "/thredds/fileServer/nexrad/level2/IDD/";
    EXPECT_EQ(get(files + "KTLX/20170101/KTLX20170101_030027_V06").status, 403U);
    EXPECT_EQ(get(files + "KABR/20050101/KABR20050101_000745.gz").status, 200U);
    EXPECT_EQ(get(files + "KTLXX/20170101/KTLX20170101_030027_V06").status, 404U);
}

TEST_F(Thredds, ADataSetOfLevelIIINeedsAVariableAndHasTheFilesOfItsDirectory) {
    const testing::TemporaryDirectory directory;
    for (const char* name :
         {"Level3_FTG_N0Q_20150615_1201.nids", "Level3_FTG_N0Q_20150615_1301.nids",
          "Level3_FTG_N0C_20150615_1201.nids", "Level3_FTG_XYZ_20150615_1201.nids", "other"})
        std::ofstream(directory / name) << name;
    ThreddsConfig config = WebConfig::usual_thredds();
    config.collections.push_back({"nexrad/level3/IDD",
                                  "NEXRAD Level III Radar from IDD",
                                  {"N0Q", "N0C"},
                                  directory.path(),
                                  {}});
    configure(std::move(config));
    const std::string level3 = "/thredds/radarServer//nexrad/level3/IDD/";
    const std::string described = body_of(get(level3 + "dataset.xml"));
    EXPECT_NE(described.find("<variable name=\"N0C\""), described.npos);
    EXPECT_NE(described.find("<dataFormat>NIDS</dataFormat>"), described.npos);
    EXPECT_NE(body_of(get(level3 + "stations.xml")).find("<station id=\"FTG\" state=\"CO\""),
              std::string::npos);
    EXPECT_NE(body_of(get(level3 + "?stn=FTG&time=2015-06-15T12%3A00%3A00")).find("variables are"),
              std::string::npos);
    const std::string found =
        body_of(get(level3 + "?stn=FTG&var=N0Q&time=2015-06-15T12%3A00%3A00"));
    EXPECT_EQ(count_in(found, "urlPath"), 1U);
    const std::string path = text_between(found, "nids\" urlPath=\"", "\"");
    EXPECT_EQ(path, "N0Q/FTG/20150615/Level3_FTG_N0Q_20150615_1201.nids");
    const std::string files = "/thredds/fileServer/nexrad/level3/IDD/";
    EXPECT_EQ(body_of(get(files + path)), "Level3_FTG_N0Q_20150615_1201.nids");
    EXPECT_EQ(get(files + "N0Q/FTG/20150615/other").status, 404U);
    EXPECT_EQ(get(files + "XYZ/FTG/20150615/Level3_FTG_XYZ_20150615_1201.nids").status, 404U);
    EXPECT_EQ(count_in(body_of(get(level3 + "?stn=FTG&var=N0Q&temporal=all")), "urlPath"), 2U);
}

// 2026-11-28: if stations were on both sides of 180 degrees, the coverage had all longitudes.
TEST_F(Thredds, TheCoverageGoesOnAcrossTheAntimeridian) {
    const auto east_west_of = [&](std::vector<std::string> stations) {
        ThreddsConfig config = WebConfig::usual_thredds();
        config.collections.push_back(
            {"nexrad/level3/IDD", "Level III", {"N0Q"}, {}, std::move(stations)});
        configure(std::move(config));
        return text_between(body_of(get("/thredds/radarServer/nexrad/level3/IDD/dataset.xml")),
                            "<eastwest>", "<units>");
    };
    const auto starts = [](const std::string& text, const char* start, const char* size) {
        return text.find(std::string("<start>") + start + "</start>") != text.npos &&
               text.find(std::string("<size>") + size + "</size>") != text.npos;
    };
    const std::string pacific = east_west_of({"GUA", "HKI"});  // 144.81 and -159.55
    EXPECT_TRUE(starts(pacific, "139.0", "67.0")) << pacific;
    const std::string plains = east_west_of({"TLX"});  // -97.28
    EXPECT_TRUE(starts(plains, "-103.0", "11.0")) << plains;
}

// Reads a file over a connection, as the IDV's HTTP layer does.
TEST_F(Thredds, TheIdvOpensAFileByRanges) {
    auto doors = std::make_shared<Doors>();
    doors->add("/thredds", std::make_shared<ThreddsDoor>(served_volumes().files()));
    const auto server = Server::open({}, doors).value();
    const std::string url = server->addresses().at(0);
    const int port = std::stoi(url.substr(url.rfind(':') + 1));
    const std::string path =
        "/thredds/fileServer/nexrad/level2/IDD/KTLX/20170101/KTLX20170101_030027_V06";
    RawClient client(port);
    client.send("HEAD " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
    const std::string head = client.read_until("\r\n\r\n");
    EXPECT_EQ(status_in(head), 200);
    EXPECT_NE(head.find("Content-Length: 488081\r\n"), head.npos) << head;
    EXPECT_NE(head.find("Accept-Ranges: bytes\r\n"), head.npos);
    client.send("GET " + path + " HTTP/1.1\r\nHost: localhost\r\nRange: bytes=0-23\r\n\r\n");
    const std::string part = client.read_until("AR2V0006");
    EXPECT_EQ(status_in(part), 206);
    EXPECT_NE(part.find("Content-Range: bytes 0-23/488081\r\n"), part.npos) << part;
    const std::string closed = RawClient::get(port, level2 + std::string{"?stn=KTLX&temporal=all"});
    EXPECT_NE(closed.find("Connection: close\r\n"), closed.npos);
    EXPECT_TRUE(closed.ends_with("</catalog>\n"));
}

// Behind a proxy, paths have the prefix under which clients reach the server.
TEST_F(Thredds, BasesHaveThePrefixOfAProxy) {
    Request request = request_for(level2 + std::string{"?stn=KTLX&temporal=all"});
    request.base = "https://radar.example.org/storms";
    const std::string xml = body_of(door_->answer(request));
    EXPECT_NE(xml.find("base=\"/storms/thredds/fileServer/nexrad/level2/IDD/\""), xml.npos);
}

}  // namespace
}  // namespace stormcellar::web
