// web/data/events/event_hub.h -- numbers events, keeps the newest, and passes them to listeners.
//
// Each event is formatted once; all listeners share the text. A listener keeps only the number of
// the next event that it has not read, so a slow listener takes no memory. Once this event has left
// the ring, the listener gets a reset. The hub has an index of listeners by station and domain, so
// an event touches only listeners that asked for its station or domain, or for all.
//
// Threads   Many threads may use hub and listeners; each listener is read by one thread at a time.
//           The hub calls a listener's `wake` without holding a lock, and not again until the
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
    std::size_t kept = 4096;         // events in the ring
    unsigned heartbeat_ticks = 15;   // from one heartbeat of an idle listener to the next
    std::optional<std::string> run;  // for tests; none: random
};

class EventHub : public std::enable_shared_from_this<EventHub> {
  public:
    class Listener;

    static std::shared_ptr<EventHub> make(EventHubOptions options = {});

    // Numbers the event and wakes the listeners whose filter it fits.
    void publish(Event event);
    // Call once a second. The listeners form `heartbeat_ticks` groups; each call takes the next
    // group and sends a heartbeat to the idle listeners in it.
    void tick();

    // Starts listening after the event with this id, or after the newest event if `id` is none or
    // empty. If events after the id were lost, or if the id is of another run, the first event
    // heard is a reset. A text that is no id counts as an id of another run.
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
    // Returns the keys under which a listener is indexed: its stations and domains, or "" if it has
    // none.
    static std::vector<std::string> keys_of(const EventFilter& filter);
    void mark_group(const std::string& key, const Event& event, std::uint64_t number,
                    std::vector<std::shared_ptr<Listener>>& woken) STORMCELLAR_REQUIRES(mutex_);
    [[nodiscard]] std::uint64_t first_number() const STORMCELLAR_REQUIRES(mutex_) {
        return next_ - ring_.size();
    }

    const std::size_t kept_;
    const std::string run_;
    mutable Mutex mutex_;
    // The events with the numbers first_number() to next_ - 1.
    std::deque<Numbered> ring_ STORMCELLAR_GUARDED_BY(mutex_);
    std::uint64_t next_ STORMCELLAR_GUARDED_BY(mutex_) = 1;
    std::unordered_map<std::string, Group> groups_ STORMCELLAR_GUARDED_BY(mutex_);
    // Listeners by the tick in which they get a heartbeat.
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

    // Returns up to `most` bytes of frames; empty if nothing is pending. The first bytes are the
    // opening: the reconnection delay, and the id after which the listener starts.
    [[nodiscard]] std::string read(std::size_t most);
    // Sets the function that the hub calls when there is something to read; null removes it.
    void on_more(std::function<void()> wake);

  private:
    friend class EventHub;
    Listener(std::shared_ptr<EventHub> hub, EventFilter filter);
    // Appends frames to `unsent_` until it has `most` bytes.
    void gather(std::size_t most) STORMCELLAR_REQUIRES(hub_->mutex_);
    void wake();
    // Tells clang that the hub, which calls this, holds `hub_->mutex_`.
    void assume_locked() const STORMCELLAR_ASSERT_HELD(hub_->mutex_) {}

    const std::shared_ptr<EventHub> hub_;
    const EventFilter filter_;
    Mutex wake_mutex_;
    std::function<void()> wake_ STORMCELLAR_GUARDED_BY(wake_mutex_);

    // Number of the first event that the listener may not have read. The number has no meaning
    // while nothing is pending.
    std::uint64_t next_ STORMCELLAR_GUARDED_BY(hub_->mutex_) = 0;
    bool is_pending_ STORMCELLAR_GUARDED_BY(hub_->mutex_) = true;
    bool beat_due_ STORMCELLAR_GUARDED_BY(hub_->mutex_) = false;
    std::size_t beat_ STORMCELLAR_GUARDED_BY(hub_->mutex_) = 0;
    std::string unsent_ STORMCELLAR_GUARDED_BY(hub_->mutex_);
};

}  // namespace stormcellar::web
