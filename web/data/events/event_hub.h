// web/data/events/event_hub.h -- numbers events, keeps the newest ones, and passes them to
// listeners.
//
// Each event is formatted once, and all listeners share the text. The newest events are in a ring.
// A listener keeps only the number of the next event that it has not read, so a slow listener takes
// no memory. If that event has left the ring, the listener gets a reset instead. The hub has an
// index of listeners by station and domain. So an event touches only listeners that asked for its
// station or domain, or for all events.
//
// Threads   Many threads may use the hub and listeners; one thread at a time reads a listener. The
//           hub calls a listener's `wake` without holding a lock, and calls it again only after the
//           listener has been read to the end.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "stormcellar/base/mutex.h"
#include "web/data/events/event.h"

namespace stormcellar::web {

struct EventHubOptions {
    std::size_t kept = 4096;         // number of events in the ring
    unsigned heartbeat_ticks = 15;   // from one heartbeat of an idle listener to the next
    std::optional<std::string> run;  // for tests; none: random
};

class EventHub : public std::enable_shared_from_this<EventHub> {
  public:
    class Listener;

    static std::shared_ptr<EventHub> make(EventHubOptions options = {});

    // Numbers the event, and wakes the listeners whose filter fits it.
    void publish(Event event);
    // Call it once a second. The listeners form `heartbeat_ticks` groups. Each call takes the next
    // group and sends a heartbeat to its idle listeners.
    void tick();

    // Starts to listen after the event with this id, or after the newest event if `id` is none or
    // empty. The first event heard is a reset if events after the id were lost, or if the id is of
    // another run of the server. A text that is no id counts as an id of another run.
    [[nodiscard]] std::shared_ptr<Listener> listen(EventFilter filter,
                                                   std::optional<std::string> id = {});

    [[nodiscard]] std::size_t listeners() const;
    [[nodiscard]] std::uint64_t published() const;
    [[nodiscard]] std::uint64_t resets() const { return resets_; }  // sent to single listeners
    [[nodiscard]] std::string newest_id() const;

  private:
    struct Numbered {
        Event event;
        Text frame;
    };
    using Group = std::vector<Listener*>;
    explicit EventHub(EventHubOptions options);
    void leave(Listener& listener);
    // Returns the keys of a listener in the index: its stations and domains, or "" if it has none.
    static std::vector<std::string> keys_of(const EventFilter& filter);
    void mark_group(const std::string& key, const Event& event, std::uint64_t number,
                    std::vector<std::shared_ptr<Listener>>& woken) STORMCELLAR_REQUIRES(mutex_);
    [[nodiscard]] std::uint64_t first_number() const STORMCELLAR_REQUIRES(mutex_) {
        return next_ - ring_.size();
    }

    const std::size_t kept_;
    const std::string run_;
    mutable Mutex mutex_;
    // The events from first_number() to next_ - 1.
    std::deque<Numbered> ring_ STORMCELLAR_GUARDED_BY(mutex_);
    std::uint64_t next_ STORMCELLAR_GUARDED_BY(mutex_) = 1;
    std::unordered_map<std::string, Group> groups_ STORMCELLAR_GUARDED_BY(mutex_);
    // The listeners that get a heartbeat, by tick.
    std::vector<std::vector<Listener*>> beats_ STORMCELLAR_GUARDED_BY(mutex_);
    std::size_t next_beat_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    std::size_t next_place_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    std::size_t listeners_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    std::atomic<std::uint64_t> resets_{0};
};

class EventHub::Listener : public std::enable_shared_from_this<EventHub::Listener> {
  public:
    ~Listener();
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    // Returns up to `most` bytes of frames, or an empty text if nothing is pending. The first bytes
    // are the opening: the reconnection delay, and the id after which the listener starts.
    [[nodiscard]] std::string read(std::size_t most);
    // Sets the function that the hub calls when there is something to read; null removes it.
    void on_more(std::function<void()> wake);

  private:
    friend class EventHub;
    Listener(std::shared_ptr<EventHub> hub, EventFilter filter);
    // Appends frames to `unsent_` until it has `most` bytes.
    void gather(std::size_t most) STORMCELLAR_REQUIRES(hub_->mutex_);
    void wake();
    // Tells clang's analysis that the caller, the hub, holds `hub_->mutex_`.
    void assume_locked() const STORMCELLAR_ASSERT_HELD(hub_->mutex_) {}

    const std::shared_ptr<EventHub> hub_;
    const EventFilter filter_;
    Mutex wake_mutex_;
    std::function<void()> wake_ STORMCELLAR_GUARDED_BY(wake_mutex_);

    // Number of the first event that the listener may not have read. Meaningless while nothing is
    // pending.
    std::uint64_t next_ STORMCELLAR_GUARDED_BY(hub_->mutex_) = 0;
    bool is_pending_ STORMCELLAR_GUARDED_BY(hub_->mutex_) = true;
    bool beat_due_ STORMCELLAR_GUARDED_BY(hub_->mutex_) = false;
    std::size_t beat_ STORMCELLAR_GUARDED_BY(hub_->mutex_) = 0;
    std::string unsent_ STORMCELLAR_GUARDED_BY(hub_->mutex_);
};

}  // namespace stormcellar::web
