// Tests the events of cells: one for each new grid, from a feed that watches a cache.
#include "web/data/storms/cell_events.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/testing/waiting.h"
#include "tests/web/served_storms.h"
#include "web/data/events/event_feed.h"

namespace stormcellar::web {
namespace {

using nlohmann::json;

class EventsOfCells : public ::testing::Test {
  protected:
    // Reads all events that the listener has, and returns the events of cells.
    std::vector<json> cells_heard() {
        for (std::string more = listener_->read(1 << 16); !more.empty();
             more = listener_->read(1 << 16))
            stream_ += more;
        std::vector<json> events;
        const std::string begin = "event: cells\ndata: ";
        for (std::size_t at = stream_.find(begin); at != std::string::npos;
             at = stream_.find(begin, at + 1)) {
            const std::size_t from = at + begin.size();
            events.push_back(json::parse(stream_.substr(from, stream_.find('\n', from) - from)));
        }
        return events;
    }
    ServedStorms served_;
    std::shared_ptr<EventHub> hub_ = EventHub::make();
    std::shared_ptr<EventHub::Listener> listener_ = hub_->listen({});
    std::string stream_;
};

TEST_F(EventsOfCells, TellWhereAndHowMany) {
    served_.add("KTLX", 0);
    {
        CellEvents events(served_.scans(), hub_);
        events.hear("KTLX");
        ASSERT_TRUE(testing::eventually([&] { return hub_->published() == 1; }));
    }
    const auto heard = cells_heard();
    ASSERT_EQ(heard.size(), 1U);
    EXPECT_EQ(heard[0]["station"], "KTLX");
    EXPECT_EQ(heard[0]["domain"], "KTLX");
    EXPECT_EQ(heard[0]["grid"], "2024-11-22T12:00:00Z");
    EXPECT_EQ(heard[0]["count"], 1);
    EXPECT_EQ(heard[0]["path"], "/api/v1/cells?area=KTLX");
    EXPECT_NE(stream_.find("-1\nevent: cells"), std::string::npos)
        << "events of cells are numbered as other events are";
}

TEST_F(EventsOfCells, TellOfEachGridOnce) {
    served_.add("KTLX", 0);
    CellEvents events(served_.scans(), hub_);
    events.hear("KTLX");
    ASSERT_TRUE(testing::eventually([&] { return hub_->published() == 1; }));
    events.hear("KTLX");
    events.hear("KOKX");  // has no grids
    served_.add("KFWS", 0);
    events.hear("KFWS");  // comes last
    ASSERT_TRUE(testing::eventually([&] { return hub_->published() == 2; }));
    const auto heard = cells_heard();
    ASSERT_EQ(heard.size(), 2U);
    EXPECT_EQ(heard[1]["domain"], "KFWS");
}

TEST_F(EventsOfCells, FollowTheEventOfTheGrid) {
    const auto cells = std::make_shared<CellEvents>(served_.scans(), hub_);
    const auto feed = EventFeed::open(
        {.grids = served_.grids(),
         .catalog = {},
         .hub = hub_,
         .on_reflectivity = [cells](const std::string& area) { cells->hear(area); }});
    served_.add("KTLX", 0);
    ASSERT_TRUE(testing::eventually([&] { return cells_heard().size() == 1; }));
    EXPECT_LT(stream_.find("event: volume_complete"), stream_.find("event: cells"));
}

}  // namespace
}  // namespace stormcellar::web
