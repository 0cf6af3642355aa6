// Tests the hub's order and resumption of events, the losses of slow clients, and wake-ups.
#include "web/data/events/event_hub.h"

#include <thread>

#include <gtest/gtest.h>

namespace stormcellar::web {
namespace {

std::shared_ptr<EventHub> small_hub(std::size_t kept = 8) {
    return EventHub::make({.kept = kept, .heartbeat_ticks = 2, .run = "abc"});
}

Event of_station(const std::string& station, int number = 0) {
    return {EventType::sweep_gridded, station, station, level2::Moment::ref,
            "{\"n\":" + std::to_string(number) + "}"};
}

std::string read_all(EventHub::Listener& listener, std::size_t most = 4096) {
    std::string all;
    for (std::string some = listener.read(most); !some.empty(); some = listener.read(most)) {
        EXPECT_LE(some.size(), most);
        all += some;
    }
    return all;
}

// Returns the number of each id line, or "reset" for a reset.
std::vector<std::string> ids_in(const std::string& text) {
    std::vector<std::string> ids;
    std::string id;
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t end = text.find('\n', at);
        const std::string line = text.substr(at, end - at);
        at = end + 1;
        if (line.starts_with("id: ")) id = line.substr(4);
        if (line == "event: reset") ids.push_back("reset");
        if (line.starts_with("event: ") && line != "event: reset") ids.push_back(id);
    }
    return ids;
}
using Ids = std::vector<std::string>;

TEST(EventHub, ANewListenerHearsWhatComesFromNowOn) {
    const auto hub = small_hub();
    hub->publish(of_station("KTLX"));
    const auto listener = hub->listen({});
    EXPECT_EQ(listener->read(4096), "retry: 3000\nid: abc-1\n\n");
    EXPECT_EQ(listener->read(4096), "");
    hub->publish(of_station("KTLX", 2));
    hub->publish(of_station("KLOT", 3));
    EXPECT_EQ(read_all(*listener),
              "id: abc-2\nevent: sweep_gridded\ndata: {\"n\":2}\n\n"
              "id: abc-3\nevent: sweep_gridded\ndata: {\"n\":3}\n\n");
    EXPECT_EQ(hub->newest_id(), "abc-3");
}

TEST(EventHub, GoesOnAfterTheIdThatAClientGives) {
    const auto hub = small_hub();
    for (int i = 1; i <= 5; ++i)
        hub->publish(of_station(i % 2 == 1 ? "KTLX" : "KLOT", i));
    EXPECT_EQ(ids_in(read_all(*hub->listen({}, "abc-3"))), (Ids{"abc-4", "abc-5"}));
    EXPECT_EQ(ids_in(read_all(*hub->listen({.stations = {"KTLX"}}, "abc-1"))),
              (Ids{"abc-3", "abc-5"}));
    EXPECT_EQ(ids_in(read_all(*hub->listen({}, "abc-5"))), Ids{});
    EXPECT_EQ(ids_in(read_all(*hub->listen({}, "abc-0"))).size(), 5u) << "no event is lost";
    EXPECT_EQ(hub->resets(), 0u);
}

TEST(EventHub, AnIdThatIsTooOldOrOfAnotherRunResets) {
    const auto hub = small_hub(2);
    for (int i = 1; i <= 5; ++i)
        hub->publish(of_station("KTLX", i));
    for (const char* id : {"abc-2", "abd-5", "abc-6", "nonsense", "abc-99999999999999999999999"}) {
        const std::string heard = read_all(*hub->listen({}, id));
        EXPECT_EQ(ids_in(heard), (Ids{"reset"})) << id;
        EXPECT_NE(heard.find("id: abc-5\nevent: reset\n"), std::string::npos)
            << "a client that has this event goes on with the next event";
    }
    EXPECT_EQ(hub->resets(), 5u);
    EXPECT_EQ(ids_in(read_all(*hub->listen({}, "abc-3"))), (Ids{"abc-4", "abc-5"}))
        << "both events are still in the ring";
    EXPECT_EQ(hub->resets(), 5u);
}

TEST(EventHub, ASlowListenerIsToldThatItLostSome) {
    const auto hub = small_hub(4);
    const auto slow = hub->listen({.stations = {"KTLX"}});
    read_all(*slow);
    hub->publish(of_station("KTLX", 1));
    for (int i = 0; i < 9; ++i)
        hub->publish(of_station("KLOT", i));
    hub->publish(of_station("KTLX", 11));
    EXPECT_EQ(ids_in(read_all(*slow)), (Ids{"reset"}));
    EXPECT_EQ(hub->resets(), 1u);
    hub->publish(of_station("KTLX", 12));
    EXPECT_EQ(ids_in(read_all(*slow)), (Ids{"abc-12"}));
}

TEST(EventHub, AQuietListenerLosesNothingWhileOthersAreLoud) {
    const auto hub = small_hub(4);
    const auto quiet = hub->listen({.stations = {"KTLX"}});
    read_all(*quiet);
    for (int i = 0; i < 20; ++i)
        hub->publish(of_station("KLOT", i));
    hub->publish(of_station("KTLX", 21));
    EXPECT_EQ(ids_in(read_all(*quiet)), (Ids{"abc-21"}));
    EXPECT_EQ(hub->resets(), 0u);
}

TEST(EventHub, WakesOnceAndOnlyThoseWhoAreConcerned) {
    const auto hub = small_hub();
    const auto tulsa = hub->listen({.stations = {"KTLX"}});
    const auto nation = hub->listen({.domains = {"conus"}});
    const auto both = hub->listen({.stations = {"KTLX"}, .domains = {"KTLX", "conus"}});
    int tulsa_woken = 0, nation_woken = 0, both_woken = 0;
    tulsa->on_more([&] { ++tulsa_woken; });
    nation->on_more([&] { ++nation_woken; });
    both->on_more([&] { ++both_woken; });
    for (const auto& listener : {tulsa, nation, both})
        read_all(*listener);
    hub->publish(of_station("KTLX"));
    hub->publish(of_station("KTLX"));
    EXPECT_EQ(tulsa_woken, 1) << "the hub wakes a listener only once before the listener reads";
    EXPECT_EQ(nation_woken, 0);
    EXPECT_EQ(both_woken, 1);
    EXPECT_EQ(ids_in(read_all(*both)).size(), 2u) << "the listener gets each event once";
    hub->publish({EventType::mosaic, "", "conus", level2::Moment::ref, "{}"});
    EXPECT_EQ(tulsa_woken, 1);
    EXPECT_EQ(nation_woken, 1);
    EXPECT_EQ(both_woken, 2);
    hub->publish(reset_event("changes were missed"));
    EXPECT_EQ(ids_in(read_all(*tulsa)), (Ids{"abc-1", "abc-2", "reset"}));
}

TEST(EventHub, HeartbeatsCarryTheNewestId) {
    const auto hub = small_hub();
    const auto listener = hub->listen({.stations = {"KTLX"}});
    read_all(*listener);
    hub->publish(of_station("KLOT"));
    hub->tick();
    hub->tick();
    EXPECT_EQ(read_all(*listener), ": heartbeat\nid: abc-1\n\n");
    hub->tick();
    hub->publish(of_station("KTLX"));
    hub->tick();
    EXPECT_EQ(ids_in(read_all(*listener)), (Ids{"abc-2"})) << "an event is a sign of life";
}

TEST(EventHub, FramesComeInWhateverPiecesAClientTakes) {
    const auto hub = small_hub(64);
    const auto listener = hub->listen({});
    const auto whole = hub->listen({});
    std::string pieces;
    for (int i = 0; i < 20; ++i) {
        hub->publish(of_station("KTLX", i));
        pieces += listener->read(7);
    }
    pieces += read_all(*listener, 7);
    EXPECT_EQ(pieces, read_all(*whole));
}

TEST(EventHub, ListenersMayComeReadAndGoWhileEventsArePublished) {
    const auto hub = small_hub(64);
    std::atomic<bool> is_over = false;
    std::thread publisher([&] {
        for (int i = 0; i < 20'000; ++i)
            hub->publish(of_station(i % 3 == 0 ? "KTLX" : "KLOT", i));
        is_over = true;
    });
    std::vector<std::thread> readers;
    for (int r = 0; r < 3; ++r) {
        readers.emplace_back([&] {
            while (!is_over) {
                const auto listener = hub->listen({.stations = {"KTLX"}}, "abc-1");
                listener->on_more([] {});
                for (int i = 0; i < 10; ++i)
                    (void)listener->read(512);
                listener->on_more(nullptr);
            }
        });
    }
    publisher.join();
    for (std::thread& reader : readers)
        reader.join();
    EXPECT_EQ(hub->listeners(), 0u);
    EXPECT_EQ(hub->published(), 20'000u);
}

}  // namespace
}  // namespace stormcellar::web
