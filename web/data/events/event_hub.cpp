#include "web/data/events/event_hub.h"

#include <algorithm>
#include <random>
#include <utility>

#include <fmt/format.h>

namespace stormcellar::web {
namespace {

constexpr std::string_view retry_line = "retry: 3000\n";

std::string random_run() {
    std::random_device device;
    return fmt::format("{:08x}", device() & 0xffffffffU);
}

}  // namespace

std::shared_ptr<EventHub> EventHub::make(EventHubOptions options) {
    return std::shared_ptr<EventHub>(new EventHub(std::move(options)));
}

EventHub::EventHub(EventHubOptions options)
    : kept_(std::max<std::size_t>(options.kept, 1)),
      run_(options.run ? *options.run : random_run()),
      beats_(std::max(options.heartbeat_ticks, 1U)) {}

std::vector<std::string> EventHub::keys_of(const EventFilter& filter) {
    std::vector<std::string> keys = filter.stations;
    keys.insert(keys.end(), filter.domains.begin(), filter.domains.end());
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    if (keys.empty()) keys.emplace_back();
    return keys;
}

// Marks the listeners of a group that have read everything as pending, and adds them to `woken`. A
// listener that is pending already need not be woken.
void EventHub::mark_group(const std::string& key, const Event& event, std::uint64_t number,
                          std::vector<std::shared_ptr<Listener>>& woken) {
    const auto group = groups_.find(key);
    if (group == groups_.end()) return;
    for (Listener* listener : group->second) {
        listener->assume_locked();
        if (listener->is_pending_ || !listener->filter_.fits(event)) continue;
        // A listener that is being destroyed is not woken; it waits for our mutex.
        auto held = listener->weak_from_this().lock();
        if (!held) continue;
        listener->is_pending_ = true;
        listener->next_ = number;
        woken.push_back(std::move(held));
    }
}

void EventHub::publish(Event event) {
    std::vector<std::shared_ptr<Listener>> woken;
    {
        const MutexLock lock(mutex_);
        const std::uint64_t number = next_++;
        Text frame = text_of(event_frame(event, run_, number));
        event.json = {};
        if (ring_.size() == kept_) ring_.pop_front();
        ring_.push_back({std::move(event), std::move(frame)});
        const Event& kept = ring_.back().event;
        if (kept.type == EventType::reset) {
            for (const auto& [key, group] : groups_)
                mark_group(key, kept, number, woken);
        } else {
            mark_group("", kept, number, woken);
            if (!kept.station.empty()) mark_group(kept.station, kept, number, woken);
            if (!kept.domain.empty() && kept.domain != kept.station)
                mark_group(kept.domain, kept, number, woken);
        }
    }
    for (const auto& listener : woken)
        listener->wake();
}

void EventHub::tick() {
    std::vector<std::shared_ptr<Listener>> woken;
    {
        const MutexLock lock(mutex_);
        for (Listener* listener : beats_[next_beat_]) {
            listener->assume_locked();
            if (listener->is_pending_) continue;
            auto held = listener->weak_from_this().lock();
            if (!held) continue;
            listener->is_pending_ = listener->beat_due_ = true;
            listener->next_ = next_;
            woken.push_back(std::move(held));
        }
        next_beat_ = (next_beat_ + 1) % beats_.size();
    }
    for (const auto& listener : woken)
        listener->wake();
}

std::shared_ptr<EventHub::Listener> EventHub::listen(EventFilter filter,
                                                     std::optional<std::string> id) {
    std::shared_ptr<Listener> listener(new Listener(shared_from_this(), std::move(filter)));
    const MutexLock lock(mutex_);
    listener->assume_locked();
    listener->next_ = next_;
    listener->unsent_ = retry_line;
    if (!id || id->empty()) {
        listener->unsent_ += fmt::format("id: {}\n\n", event_id_text(run_, next_ - 1));
    } else {
        const auto last = parse_event_id(*id);
        if (!last || last->run != run_ || last->number >= next_) {
            ++resets_;
            listener->unsent_ +=
                event_frame(reset_event("the server was started anew"), run_, next_ - 1);
        } else if (last->number + 1 < first_number()) {
            ++resets_;
            listener->unsent_ +=
                event_frame(reset_event("events since then are no longer kept"), run_, next_ - 1);
        } else {
            listener->next_ = last->number + 1;
            listener->unsent_ += fmt::format(": events since {}\n\n", last->number);
        }
    }
    for (const std::string& key : keys_of(listener->filter_))
        groups_[key].push_back(listener.get());
    listener->beat_ = next_place_++ % beats_.size();
    beats_[listener->beat_].push_back(listener.get());
    ++listeners_;
    return listener;
}

void EventHub::leave(Listener& listener) {
    const MutexLock lock(mutex_);
    listener.assume_locked();
    for (const std::string& key : keys_of(listener.filter_)) {
        const auto group = groups_.find(key);
        std::erase(group->second, &listener);
        if (group->second.empty()) groups_.erase(group);
    }
    std::erase(beats_[listener.beat_], &listener);
    --listeners_;
}

std::size_t EventHub::listeners() const {
    const MutexLock lock(mutex_);
    return listeners_;
}

std::uint64_t EventHub::published() const {
    const MutexLock lock(mutex_);
    return next_ - 1;
}

std::string EventHub::newest_id() const {
    const MutexLock lock(mutex_);
    return event_id_text(run_, next_ - 1);
}

EventHub::Listener::Listener(std::shared_ptr<EventHub> hub, EventFilter filter)
    : hub_(std::move(hub)), filter_(std::move(filter)) {}

EventHub::Listener::~Listener() {
    hub_->leave(*this);
}

void EventHub::Listener::on_more(std::function<void()> wake) {
    const MutexLock lock(wake_mutex_);
    wake_ = std::move(wake);
}

void EventHub::Listener::wake() {
    const MutexLock lock(wake_mutex_);
    if (wake_) wake_();
}

void EventHub::Listener::gather(std::size_t most) {
    const std::uint64_t first = hub_->first_number();
    if (next_ < first) {
        ++hub_->resets_;
        next_ = hub_->next_;
        unsent_ +=
            event_frame(reset_event("the events were not read in time"), hub_->run_, next_ - 1);
    }
    for (; next_ < hub_->next_ && unsent_.size() < most; ++next_) {
        const Numbered& numbered = hub_->ring_[next_ - first];
        if (filter_.fits(numbered.event)) unsent_ += *numbered.frame;
    }
    if (next_ < hub_->next_) return;
    // The heartbeat carries the newest id. Otherwise a client that heard nothing for long would be
    // told, when it reconnects, that events were lost.
    if (unsent_.empty() && beat_due_) {
        unsent_ =
            fmt::format(": heartbeat\nid: {}\n\n", event_id_text(hub_->run_, hub_->next_ - 1));
    }
}

std::string EventHub::Listener::read(std::size_t most) {
    if (most == 0) return {};
    const MutexLock lock(hub_->mutex_);
    if (is_pending_ && unsent_.size() < most) gather(most);
    beat_due_ = false;
    std::string bytes = unsent_.substr(0, most);
    unsent_.erase(0, bytes.size());
    // If no bytes were returned, nothing is pending. Otherwise a frame may have been cut, or events
    // may be left; if neither is true, the next call clears the flag.
    if (bytes.empty()) is_pending_ = false;
    // Release the buffer. Otherwise each of a thousand idle listeners would keep room for the
    // longest event that it has read.
    if (unsent_.empty()) unsent_.shrink_to_fit();
    return bytes;
}

}  // namespace stormcellar::web
