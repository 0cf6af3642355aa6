// Requests the files that GR2Analyst, GRLevel2 and others poll (docs/web/raw.md), as these programs
// do.
#include "web/doors/raw/polling.h"

#include <gtest/gtest.h>

#include "tests/web/served_volumes.h"

namespace stormcellar::web {
namespace {

using Polling = VolumesDoorTest<PollingDoor>;

TEST_F(Polling, TheConfigurationNamesTheListsAndTheSites) {
    for (const char* path : {"/nexrd2/config.cfg", "/nexrd2/grlevel2.cfg"}) {
        const Answer answer = get(path);
        EXPECT_EQ(answer.status, 200U);
        EXPECT_EQ(header_of(answer, "Content-Type"), "text/plain; charset=utf-8");
        EXPECT_EQ(header_of(answer, "Cache-Control"), "no-cache");
        EXPECT_EQ(body_of(answer), "ListFile: dir.list\nSite: KABR\nSite: KTLX\n");
    }
}

TEST_F(Polling, AListHasSizesAndNamesTheNewestLastAndEachIsThere) {
    const std::string list = body_of(get("/nexrd2/KTLX/dir.list"));
    const std::size_t end = list.find('\n');
    EXPECT_EQ(list.substr(0, 20), "144853 KTLX19910720_");
    EXPECT_EQ(list.substr(end + 1), "488081 KTLX20170101_030027_V06\n");
    EXPECT_EQ(body_of(get("/nexrd2/KABR/dir.list")), "153355 KABR20050101_000745.gz\n");
    for (const std::string& name : {list.substr(7, end - 7), list.substr(end + 8, 23)}) {
        const Answer answer = get("/nexrd2/KTLX/" + name);
        EXPECT_EQ(answer.status, 200U) << name;
        EXPECT_EQ(body_of(answer).size(), std::stoul(list.substr(list.find(name) - 7)));
    }
    // A program that has the beginning of a volume requests the rest.
    const Answer rest = get("/nexrd2/KTLX/KTLX20170101_030027_V06", {{"Range", "bytes=488000-"}});
    EXPECT_EQ(rest.status, 206U);
    EXPECT_EQ(body_of(rest).size(), 81U);
}

TEST_F(Polling, AListIsBoundedAndKeepsTheNewest) {
    PollingDoor door(served_volumes().files(), {.most_listed = 1});
    EXPECT_EQ(body_of(asked(door, "/nexrd2/KTLX/dir.list")), "488081 KTLX20170101_030027_V06\n");
}

// The list must give the size of the volume, because a program that polls fetches the added bytes.
TEST_F(Polling, AVolumeThatGrowsIsListedAtItsSizeOfNow) {
    ServedVolumes served(false);
    served.take_chunks(3);
    PollingDoor early(served.files());
    EXPECT_EQ(body_of(asked(early, "/nexrd2/KLOT/dir.list")), "")
        << "the first sweep has not ended";
    for (const std::size_t chunks : {10, 20}) {
        const std::string bytes = served.take_chunks(chunks);
        PollingDoor door(
            RawFiles::open_catalog({.catalog = served.state() / "catalog", .scratch = {}}));
        const std::string list = body_of(asked(door, "/nexrd2/KLOT/dir.list"));
        const std::size_t space = list.find(' ');
        EXPECT_EQ(list.substr(0, space), std::to_string(bytes.size()));
        const std::string name = list.substr(space + 1, list.size() - space - 2);
        EXPECT_EQ(name.substr(0, 19), "KLOT20260328_201457");
        EXPECT_TRUE(body_of(asked(door, "/nexrd2/KLOT/" + name)) == bytes) << chunks << " chunks";
    }
}

TEST_F(Polling, NothingElseIsThere) {
    for (const char* target :
         {"/nexrd2", "/nexrd2/", "/nexrd2/other.cfg", "/nexrd2/KZZZ/dir.list", "/nexrd2/KTLX/",
          "/nexrd2/KTLX/dir.list/", "/nexrd2/KTLX/nothing", "/nexrd2/KTLX/x/dir.list"})
        EXPECT_EQ(get(target).status, 404U) << target;
}

}  // namespace
}  // namespace stormcellar::web
