#include "web/data/events/event_feed.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "base/steady_time.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/station_table.h"
#include "web/data/events/catalog_changes.h"
#include "web/data/events/grid_events.h"

namespace stormcellar::web {
namespace {

constexpr std::chrono::seconds tick_every{1};
// The database of a station is not queried if a grid of the station came this recently.
constexpr std::chrono::seconds grids_speak_for{30};
// Least time between two queries of one station's database.
constexpr std::chrono::seconds ask_every{5};
// Number of queries for each change. SQLite writes the log, waits for the disk, and then publishes
// the commit, so the file changes before readers see the commit. The second query sees the commit.
constexpr int asks_for_a_change = 2;
// If more changes than this wait, drop them all and let clients request everything again.
constexpr std::size_t most_changes_waiting = 20'000;

std::vector<std::string> areas_of_new_reflectivity(const std::vector<Event>& events) {
    std::vector<std::string> areas;
    for (const Event& event : events) {
        const bool is_finished =
            event.type == EventType::volume_complete || event.type == EventType::mosaic;
        if (is_finished && event.moment == level2::Moment::ref) areas.push_back(event.domain);
    }
    return areas;
}

}  // namespace

// The changes that the watch of the cache has reported and the feed has not read yet. The watch may
// outlive the feed.
struct WaitingChanges {
    void add(const CacheChange& change) {
        {
            const MutexLock lock(mutex);
            if (changes.size() < most_changes_waiting) {
                changes.push_back(change);
            } else {
                has_lost = true;
            }
        }
        more.notify_one();
    }
    // Waits until there are changes, the given time has come, or the feed stops. Returns the
    // changes.
    std::vector<CacheChange> take(SteadyTime until) {
        const MutexLock lock(mutex);
        while (!is_stopping && changes.empty() && steady_now() < until)
            more.wait_until(mutex, until);
        std::vector<CacheChange> taken = std::exchange(changes, {});
        if (std::exchange(has_lost, false)) taken = {{CacheEvent::everything, {}}};
        return taken;
    }
    void lose() {
        const MutexLock lock(mutex);
        has_lost = true;
    }
    [[nodiscard]] bool must_stop() {
        const MutexLock lock(mutex);
        return is_stopping;
    }
    void stop() {
        {
            const MutexLock lock(mutex);
            is_stopping = true;
        }
        more.notify_one();
    }

    Mutex mutex;
    ConditionVariable more;
    std::vector<CacheChange> changes STORMCELLAR_GUARDED_BY(mutex);
    bool has_lost STORMCELLAR_GUARDED_BY(mutex) = false;
    bool is_stopping STORMCELLAR_GUARDED_BY(mutex) = false;
};

struct EventFeed::Impl {
    explicit Impl(EventFeedOptions given)
        : options(std::move(given)),
          book(options.silent_after),
          grid_events(options.grids, book, file_clock_ns()),
          catalog_changes(options.catalog),
          reader(options.reader) {}

    void begin();
    void take_turn(SteadyTime& next_tick, SteadyTime& next_look);
    void run();
    void publish(std::vector<Event> events) {
        for (Event& event : events)
            options.hub->publish(std::move(event));
    }
    void take_grids(SteadyTime until);
    void look_at_catalog(SteadyTime now);
    void ask_about(const std::string& station, bool is_beginning);
    [[nodiscard]] bool has_grids(const std::string& station) const {
        return options.grids && !options.grids->moments(station).empty();
    }
    const catalog::CatalogReader* catalog();

    const EventFeedOptions options;
    StationNews book;
    GridEvents grid_events;
    CatalogChanges catalog_changes;
    std::shared_ptr<const catalog::CatalogReader> reader;
    struct Asked {
        SteadyTime spoke{};  // when the last grid of the station came
        SteadyTime asked{};
        int asks_due = 0;
        // Start of the volume whose end was last published from the catalog.
        std::optional<UtcTime> ended;
    };
    std::map<std::string, Asked> asked;
    std::atomic<std::uint64_t> unreadable{0};
    std::atomic<std::uint64_t> looks{0};  // how often the feed has looked at the catalog
    const std::shared_ptr<WaitingChanges> waiting = std::make_shared<WaitingChanges>();
    std::thread thread;
};

const catalog::CatalogReader* EventFeed::Impl::catalog() {
    if (reader) return reader.get();
    if (options.catalog.empty()) return nullptr;
    auto opened = catalog::CatalogReader::open(options.catalog);
    if (!opened) return nullptr;
    reader = std::make_shared<const catalog::CatalogReader>(std::move(*opened));
    return reader.get();
}

// Notes the newest grids and volumes that exist, but publishes nothing about them.
void EventFeed::Impl::begin() {
    const UtcTime now = now_utc();
    if (options.grids) {
        for (const std::string& domain : options.grids->domains()) {
            if (!is_icao(domain)) continue;
            for (const level2::Moment moment : options.grids->moments(domain))
                book.note(domain, options.grids->newest(domain, moment), std::nullopt, now);
        }
    }
    for (const std::string& station : catalog_changes.take())
        ask_about(station, true);
}

void EventFeed::Impl::ask_about(const std::string& station, bool is_beginning) {
    const catalog::CatalogReader* const catalog_reader = catalog();
    if (catalog_reader == nullptr) return;
    const auto latest = catalog_reader->latest(station);
    if (!latest || !*latest || !(*latest)->volume.start_time) return;
    const catalog::CatalogEntry& entry = **latest;
    const UtcTime start = *entry.volume.start_time;
    const UtcTime now = now_utc();
    Asked& of_station = asked[station];
    const bool has_ended = entry.state != catalog::FileState::seen;
    if (is_beginning) {
        book.note(station, start, entry.registered_time, now);
        if (has_ended) of_station.ended = start;
        return;
    }
    publish(book.hear(station, SeenVolume{start, entry.volume.vcp.value_or(0)},
                      entry.registered_time, now));
    if (!has_ended || of_station.ended == start || has_grids(station)) return;
    of_station.ended = start;
    options.hub->publish(
        volume_ended_event(station, {start, entry.volume.sweep_count, entry.volume.complete}, now));
}

void EventFeed::Impl::look_at_catalog(SteadyTime now) {
    for (const std::string& station : catalog_changes.take())
        asked[station].asks_due = asks_for_a_change;
    for (auto& [station, of_station] : asked) {
        if (of_station.asks_due == 0 || now < of_station.asked + ask_every ||
            now < of_station.spoke + grids_speak_for) {
            continue;
        }
        --of_station.asks_due;
        of_station.asked = now;
        ask_about(station, false);
    }
}

void EventFeed::Impl::take_grids(SteadyTime until) {
    const std::vector<CacheChange> changes = waiting->take(until);
    if (changes.empty()) return;
    std::vector<Event> events = grid_events.of(changes, now_utc());
    unreadable = grid_events.unreadable();
    const SteadyTime now = steady_now();
    for (const Event& event : events) {
        if (!event.station.empty() && event.type != EventType::grid_evicted)
            asked[event.station].spoke = now;
    }
    const std::vector<std::string> areas = areas_of_new_reflectivity(events);
    publish(std::move(events));
    if (!options.on_reflectivity) return;
    for (const std::string& area : areas)
        options.on_reflectivity(area);
}

void EventFeed::Impl::take_turn(SteadyTime& next_tick, SteadyTime& next_look) {
    take_grids(std::min(next_tick, next_look));
    const SteadyTime now = steady_now();
    if (now >= next_look) {
        next_look = now + options.look_every;
        look_at_catalog(now);
        publish(book.look(now_utc()));
        ++looks;
    }
    if (now >= next_tick) {
        next_tick = now + tick_every;
        options.hub->tick();
    }
}

void EventFeed::Impl::run() {
    SteadyTime next_tick = steady_now() + tick_every;
    SteadyTime next_look = steady_now() + options.look_every;
    while (!waiting->must_stop()) {
        try {
            take_turn(next_tick, next_look);
        } catch (const std::exception&) {
            // Memory is short. Changes that were taken already may be lost, so let clients request
            // everything again.
            waiting->lose();
        }
    }
}

EventFeed::EventFeed(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

std::unique_ptr<EventFeed> EventFeed::open(EventFeedOptions options) {
    auto impl = std::make_unique<Impl>(std::move(options));
    if (impl->options.grids) {
        impl->options.grids->listen(
            [weak = std::weak_ptr<WaitingChanges>(impl->waiting)](const CacheChange& change) {
                if (const auto waiting = weak.lock()) waiting->add(change);
            });
    }
    impl->begin();
    impl->thread = std::thread([running = impl.get()] { running->run(); });
    return std::unique_ptr<EventFeed>(new EventFeed(std::move(impl)));
}

EventFeed::~EventFeed() {
    impl_->waiting->stop();
    impl_->thread.join();
}

std::vector<StationNews::Page> EventFeed::stations() const {
    return impl_->book.pages();
}

std::uint64_t EventFeed::looks() const {
    return impl_->looks;
}

std::uint64_t EventFeed::unreadable() const {
    return impl_->unreadable;
}

}  // namespace stormcellar::web
