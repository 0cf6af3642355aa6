// Tests events as text, and filters.
#include "web/data/events/event.h"

#include <gtest/gtest.h>

namespace stormcellar::web {
namespace {

Event grid_event(std::string station, std::string domain, level2::Moment moment) {
    return {EventType::sweep_gridded, std::move(station), std::move(domain), moment, "{}"};
}

TEST(Event, IsThreeLinesAndAnEmptyOne) {
    const Event event{EventType::mosaic, "", "conus", level2::Moment::ref, R"({"a":1})"};
    EXPECT_EQ(event_frame(event, "5f3a09c1", 17),
              "id: 5f3a09c1-17\nevent: mosaic\ndata: {\"a\":1}\n\n");
}

TEST(Event, IdsAreReadBackAndNothingElseIs) {
    const auto id = parse_event_id(event_id_text("5f3a09c1", 18446744073709551615u));
    ASSERT_TRUE(id);
    EXPECT_EQ(id->run, "5f3a09c1");
    EXPECT_EQ(id->number, 18446744073709551615u);
    for (const char* text : {"", "-", "17", "5f3a09c1", "5f3a09c1-", "-17", "5f3a09c1-x",
                             "5f3a09c1-1 ", "5f3a09c1--1", "5f3a09c1-18446744073709551616",
                             "5F3A09C1-1", "g-1", "\n-1", "0123456789abcdef0123456789abcdef0-1"})
        EXPECT_FALSE(parse_event_id(text)) << text;
}

TEST(Event, NamesAreReadBack) {
    for (const EventTypeFacts& facts : event_types)
        EXPECT_EQ(event_type_from_name(facts.name), facts.type);
    EXPECT_FALSE(event_type_from_name("Mosaic"));
}

TEST(EventFilter, PlacesAreStationsOrDomains) {
    const Event site = grid_event("KTLX", "KTLX", level2::Moment::ref);
    const Event mosaic{EventType::mosaic, "", "conus", level2::Moment::ref, "{}"};
    EXPECT_TRUE(EventFilter{}.fits(site));
    EXPECT_TRUE(EventFilter{}.fits(mosaic));
    const EventFilter station{.stations = {"KTLX"}};
    EXPECT_TRUE(station.fits(site));
    EXPECT_FALSE(station.fits(mosaic));
    EXPECT_FALSE(station.fits(grid_event("KLOT", "KLOT", level2::Moment::ref)));
    const EventFilter both{.stations = {"KTLX"}, .domains = {"conus"}};
    EXPECT_TRUE(both.fits(site));
    EXPECT_TRUE(both.fits(mosaic));
    EXPECT_FALSE(both.fits(grid_event("KLOT", "KLOT", level2::Moment::ref)));
}

TEST(EventFilter, MomentsAndKindsMustFitToo) {
    const EventFilter filter{.stations = {"KTLX"},
                             .moments = {level2::Moment::vel},
                             .types = {EventType::sweep_gridded, EventType::station_silent}};
    EXPECT_TRUE(filter.fits(grid_event("KTLX", "KTLX", level2::Moment::vel)));
    EXPECT_FALSE(filter.fits(grid_event("KTLX", "KTLX", level2::Moment::ref)));
    EXPECT_FALSE(
        filter.fits({EventType::volume_complete, "KTLX", "KTLX", level2::Moment::vel, ""}));
    EXPECT_TRUE(filter.fits({EventType::station_silent, "KTLX", "KTLX", std::nullopt, ""}))
        << "the event has no moment";
    EXPECT_TRUE(filter.fits(reset_event("lost")));
}

}  // namespace
}  // namespace stormcellar::web
