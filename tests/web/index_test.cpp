// Tests the index page as the server sends it. tests/viewer/index_page.spec.mjs checks its script.
#include "web/doors/index/index.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/web/asked.h"
#include "web/doors/api/operations.h"

namespace stormcellar::web {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// Checks that tags are closed in order and that attributes have quotes. Returns the first error, or
// an empty text.
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

std::string page_of(const std::vector<std::string>& doors,
                    const std::string& base = "https://radar.example.org/storms",
                    const std::string& bucket = "my-bucket") {
    IndexDoor door(doors, bucket);
    Request request = request_for("/");
    request.base = base;
    const std::string html = body_of(door.answer(request));
    EXPECT_EQ(trouble_in_html(html), "");
    return html;
}

TEST(IndexPage, LinksKeepThePathOfTheProxyAndExamplesTheWholeAddress) {
    EXPECT_THAT(
        page_of({"/api/v1", "/nexrd2", "/s3", "/volumes"}),
        AllOf(HasSubstr("<h1>Weather radar <span>radar.example.org/storms</span></h1>"),
              HasSubstr("href=\"/storms/index.css\""), HasSubstr("src=\"/storms/index.mjs\""),
              HasSubstr("href=\"/storms/volumes/\""), HasSubstr("href=\"/storms/volumes/NAME/\""),
              HasSubstr("<code>https://radar.example.org/storms/nexrd2</code>"),
              HasSubstr("s3://my-bucket/<var")));
    EXPECT_THAT(page_of({"/api/v1"}, "http://127.0.0.1:8090"),
                AllOf(HasSubstr("href=\"/index.css\""), HasSubstr("curl -o grid.nc http://127.0")));
}

TEST(IndexPage, OffersOnlyWhatIsServed) {
    const auto all = std::to_array<std::string>({"/api/v1", "/api/v1/events", "/metrics", "/nexrd2",
                                                 "/placefiles", "/s3", "/thredds", "/tiles", "/v2",
                                                 "/view", "/volumes", "/wms", "/zarr"});
    for (const std::string& door : all) {
        std::vector<std::string> others(all.begin(), all.end());
        std::erase(others, door);
        const std::string shown = door == "/v2" ? "/public/weather-maps.json" : door;
        const auto address = door == "/view" ? HasSubstr("/storms/view/\"")
                                             : HasSubstr("://radar.example.org/storms" + shown);
        EXPECT_THAT(page_of({door}), address);
        if (door == "/api/v1") continue;  // the address of the events also begins with "/api/v1"
        EXPECT_THAT(page_of(others), Not(address));
    }
    EXPECT_THAT(page_of({"/zarr"}), Not(HasSubstr("NAME"))) << "lists are made from the API";
    EXPECT_THAT(page_of({"/api/v1"}), HasSubstr("latest/netcdf"));
    EXPECT_THAT(page_of({"/api/v1", "/zarr"}), Not(HasSubstr("latest/netcdf")))
        << "arrays over time are better for xarray";
}

TEST(IndexPage, NoDoorLeavesASentence) {
    EXPECT_THAT(page_of({}), AllOf(HasSubstr("This server does not serve the API"),
                                   Not(HasSubstr("<script")), Not(HasSubstr("<details"))));
}

TEST(IndexPage, KeepsToTheContentSecurityPolicy) {
    const std::string html = page_of({"/api/v1"});
    EXPECT_THAT(html, AllOf(HasSubstr("index.mjs\"></script>"), Not(HasSubstr("<script>")),
                            Not(HasSubstr("style=")), Not(HasSubstr("<style"))));
}

TEST(IndexPage, NamesCannotBreakIt) {
    const std::string evil = "\"><script>alert('x')</script>{{base}}&\x01";
    EXPECT_THAT(page_of({"/nexrd2", "/s3"}, "http://h/" + evil, evil), Not(HasSubstr("<script>")));
}

TEST(Index, AnswersItsFilesAndNothingElse) {
    IndexDoor door({"/api/v1"}, "b");
    const std::vector<std::pair<std::string, std::string>> files = {
        {"/", "text/html"}, {"/index.css", "text/css"}, {"/index.mjs", "text/javascript"}};
    for (const auto& [path, type] : files) {
        const Answer file = asked(door, path);
        EXPECT_EQ(file.status, 200u) << path;
        EXPECT_EQ(header_of(file, "Content-Type"), type + "; charset=utf-8");
        const Fields known{{"If-None-Match", header_of(file, "ETag")}};
        EXPECT_EQ(asked(door, path, known).status, 304u) << path;
    }
    for (const char* target : {"/nothing", "/index.css/", "/index.html", "/index.css/x"})
        EXPECT_EQ(asked(door, target).status, 404u) << target;
}

// Finds the operations that the script requests, and checks that the API has them.
TEST(Index, TheScriptAsksOperationsOfTheApi) {
    IndexDoor door({"/api/v1"}, "b");
    const std::string script = body_of(asked(door, "/index.mjs"));
    const std::string begin = "asked('";
    std::vector<std::string> names;
    for (std::size_t at = script.find(begin); at != std::string::npos;
         at = script.find(begin, at + 1)) {
        const std::size_t name = at + begin.size();
        names.push_back(script.substr(name, script.find('\'', name) - name));
    }
    EXPECT_THAT(names, ::testing::ElementsAre("stations", "domains"));
    for (const std::string& name : names) {
        EXPECT_TRUE(std::ranges::any_of(api_operations(), [&](const ApiOperation& operation) {
            return operation.path == "/api/v1/" + name;
        })) << name;
    }
}

}  // namespace
}  // namespace stormcellar::web
