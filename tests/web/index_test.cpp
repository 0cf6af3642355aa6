// The index page: what it says, what it offers, and that names cannot break it.
#include "web/doors/index/index.h"

#include <gtest/gtest.h>

#include "stormcellar/cache/store.h"
#include "tests/cache/made_grids.h"
#include "tests/testing/temporary_directory.h"
#include "tests/web/asked.h"
#include "web/doors/index/clients.h"

namespace stormcellar::web {
namespace {

using namespace std::chrono_literals;
const UtcTime page_time = *parse_utc("2026-05-01T12:00", UtcTime{});

// Every tag that is opened is closed in its order, and attributes have quotes; gives what is wrong.
std::string trouble_in_html(const std::string& html) {
    std::vector<std::string> open;
    for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
        const std::size_t end = html.find('>', at);
        if (end == std::string::npos) return "no end of a tag";
        std::string tag = html.substr(at + 1, end - at - 1);
        if (tag.find('<') != std::string::npos) return "a tag within " + tag;
        if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) return "quotes of " + tag;
        const std::string name = tag.substr(0, tag.find_first_of(" \n"));
        if (name == "!DOCTYPE" || name == "meta" || name == "link") continue;
        if (name.front() != '/') {
            open.push_back(name);
        } else if (open.empty() || open.back() != name.substr(1)) {
            return "</" + name.substr(1) + "> without its beginning";
        } else {
            open.pop_back();
        }
    }
    return open.empty() ? "" : open.back() + " is not closed";
}

bool says(const std::string& html, std::string_view text) {
    return html.find(text) != std::string::npos;
}

IndexFacts facts_of_a_day() {
    IndexFacts facts;
    facts.now = page_time;
    facts.base = "https://radar.example.org/storms";
    facts.doors = {"/api/v1/events", "/nexrd2", "/api/v1", "/volumes", "/s3"};
    facts.bucket = "my-bucket";
    IndexStation silent{"KABR", "Aberdeen, SD", page_time - 3h, {}, page_time - 3h, {}, true};
    IndexStation live{"KTLX",
                      "Oklahoma City, OK",
                      page_time - 2min,
                      page_time - 2min,
                      page_time - 10s,
                      {"REF", "VEL"},
                      false};
    facts.stations = {silent, live};
    facts.domains = {{"northeast", {"REF"}, page_time - 4min}};
    return facts;
}

TEST(IndexPage, SaysWhatThereIsAndHowOldItIs) {
    const std::string html = index_html(facts_of_a_day());
    EXPECT_EQ(trouble_in_html(html), "");
    for (const char* text :
         {"2 stations, 1 of them silent; the newest volume began 2 min ago.",
          "<i>silent</i> for 3 h 0 min", "<i>live</i>", "Oklahoma City, OK", "2026-05-01 11:58:00",
          "<b>northeast</b>", "REF VEL", "As of 2026-05-01 12:00:00 UTC"})
        EXPECT_TRUE(says(html, text)) << text;
    EXPECT_FALSE(says(html, "<script")) << "it needs none";
    EXPECT_FALSE(says(html, "style=")) << "the Content-Security-Policy forbids it";
}

TEST(IndexPage, LinksKeepThePathOfTheProxyAndExamplesTheWholeAddress) {
    const std::string html = index_html(facts_of_a_day());
    EXPECT_TRUE(says(html, "href=\"/storms/index.css\""));
    EXPECT_TRUE(says(html, "href=\"/storms/volumes/KTLX/\""));
    EXPECT_TRUE(says(html, "<code>https://radar.example.org/storms/nexrd2</code>"));
    EXPECT_TRUE(says(html, "s3://my-bucket/2026/05/01/KTLX/")) << "the live station is the example";
    EXPECT_EQ(path_of_base("http://127.0.0.1:8090"), "");
}

TEST(IndexPage, OffersOnlyWhatIsServed) {
    IndexFacts facts = facts_of_a_day();
    EXPECT_FALSE(says(index_html(facts), "thredds"));
    facts.doors.emplace_back("/thredds");
    EXPECT_TRUE(says(index_html(facts), "/storms/thredds/radarServer/catalog.xml"));
    EXPECT_TRUE(says(index_html(facts),
                     "query.stations(&#39;KTLX&#39;).time(datetime(2026, 5, 1, 11, 58))"))
        << "2026-11-27: the example asked for now, which found nothing in an archive";
    EXPECT_FALSE(says(index_html(facts), "href=\"/storms/zarr\""));
    facts.doors.emplace_back("/zarr");
    EXPECT_TRUE(says(index_html(facts), "href=\"/storms/zarr\""));
    const ClientPlaces places{"http://h",          "b", "KTLX", "KTLX", "REF", "2026/05/01",
                              "2026, 5, 1, 11, 58"};
    const auto xarray = [&](const std::vector<std::string>& doors) {
        for (const ClientHelp& help : client_help(places, doors))
            if (help.program == "Python: xarray") return help.code;
        return std::string{};
    };
    EXPECT_TRUE(says(xarray({"/api/v1"}), "/api/v1/grids/KTLX/REF/latest/netcdf"));
    EXPECT_TRUE(says(xarray({"/api/v1", "/zarr"}), "http://h/zarr/KTLX/REF/"));
    EXPECT_EQ(xarray({}), "");
    for (const ClientHelp& help : client_help(places, {"/api/v1", "/s3", "/tiles", "/nexrd2"}))
        EXPECT_EQ(help.code.find_first_of("{}"), std::string::npos) << help.code;
    facts = {};
    facts.base = "http://h";
    EXPECT_EQ(trouble_in_html(index_html(facts)), "");
    EXPECT_TRUE(says(index_html(facts), "Nothing has come yet."));
}

TEST(IndexPage, NamesCannotBreakIt) {
    IndexFacts facts = facts_of_a_day();
    const std::string evil = "\"><script>alert('x')</script>&\x01";
    facts.base = "http://h/" + evil;
    facts.bucket = facts.domains[0].name = facts.stations[0].icao = facts.stations[0].place = evil;
    facts.stations[1].newest_volume = {};
    facts.stations[1].moments = {evil};
    const std::string html = index_html(facts);
    EXPECT_EQ(trouble_in_html(html), "");
    EXPECT_FALSE(says(html, "<script"));
}

TEST(IndexPage, ATimeInTheFutureIsNotAgo) {
    IndexFacts facts = facts_of_a_day();
    facts.stations[1].newest_volume = page_time + 2min;
    const std::string html = index_html(facts);
    EXPECT_TRUE(says(html, "; the newest volume has a time in the future."));
    EXPECT_FALSE(says(html, "future ago"));
}

TEST(IndexPage, AStationWhoseClockIsAheadIsNotLive) {
    IndexFacts facts = facts_of_a_day();
    facts.stations.resize(1);
    facts.stations[0].is_silent = false;
    facts.stations[0].newest_volume.reset();
    facts.stations[0].newest_grid = page_time + 24h * 180;
    const std::string html = index_html(facts);
    EXPECT_FALSE(says(html, "<i>live</i>"));
    EXPECT_TRUE(says(html, "not known"));
}

TEST(IndexPage, AgesAreRead) {
    const auto age = [](std::chrono::milliseconds ago) {
        return age_text(page_time - ago, page_time);
    };
    EXPECT_EQ(age(0s), "0 s");
    EXPECT_EQ(age(-30s), "0 s");
    EXPECT_EQ(age(-2min), "in the future");
    EXPECT_EQ(age(89s), "89 s");
    EXPECT_EQ(age(90s), "1 min");
    EXPECT_EQ(age(89min), "89 min");
    EXPECT_EQ(age(5h + 20min + 59s), "5 h 20 min");
    EXPECT_EQ(age(48h), "2 days");
    EXPECT_EQ(age(24h * 365 * 3 + 24h), "3 years");
}

TEST(Index, ListsStationsAndDomainsOfTheCache) {
    const testing::TemporaryDirectory directory;
    auto store = *cache::StoreWriter::open(real_file_system(), directory / "cache", false);
    for (const char* domain : {"KBGM", "northeast", "northeast.KBGM"})
        ASSERT_TRUE(testing::commit_sized(store, domain, testing::noon));
    const std::shared_ptr<Grids> grids = *Grids::open({.cache = directory / "cache"});
    IndexDoor door({.grids = grids, .feed = nullptr, .doors = {"/api/v1"}, .bucket = "b"});
    const Answer page = asked(door, "/");
    EXPECT_EQ(page.status, 200u);
    EXPECT_EQ(header_of(page, "Content-Type"), "text/html; charset=utf-8");
    const std::string html = body_of(page);
    EXPECT_TRUE(says(html, "<b>KBGM</b> <span>Binghamton, NY</span>"));
    EXPECT_TRUE(says(html, "<b>northeast</b>"));
    EXPECT_FALSE(says(html, "northeast.KBGM"));
    const Answer style = asked(door, "/index.css");
    EXPECT_EQ(header_of(style, "Content-Type"), "text/css; charset=utf-8");
    EXPECT_EQ(asked(door, "/index.css", {{"If-None-Match", header_of(style, "ETag")}}).status,
              304u);
    for (const char* target : {"/nothing", "/index.css/", "/index.html", "/index.css/x"})
        EXPECT_EQ(asked(door, target).status, 404u) << target;
}

}  // namespace
}  // namespace stormcellar::web
