#include "level2/record_queue.h"

#include <algorithm>
#include <new>
#include <system_error>
#include <utility>

namespace stormcellar::level2 {

RecordQueue::RecordQueue(Source source, int threads, std::uint64_t output_limit_bytes,
                         const Selection& selection)
    : limit_bytes_(output_limit_bytes),
      selection_(selection),
      own_decoder_(output_limit_bytes, selection),
      source_(std::move(source)),
      slots_(threads > 1 ? 2 * static_cast<std::size_t>(threads) : 1) {
    {
        const std::lock_guard lock{mutex_};
        fill();
    }
    try {
        workers_.reserve(slots_.size());
        for (int i = 1; i < threads; ++i)
            workers_.emplace_back(&RecordQueue::run, this);
    } catch (const std::system_error&) {
        // The system has no more threads: those there are do the work.
    } catch (const std::bad_alloc&) {
        // The same.
    }
}

RecordQueue::~RecordQueue() {
    {
        const std::lock_guard lock{mutex_};
        stopping_ = true;
    }
    changed_.notify_all();
    for (std::thread& worker : workers_)
        worker.join();
}

void RecordQueue::fill() {
    while (used_ < slots_.size() && !source_ended_) {
        std::optional<LdmPart> part = source_();
        if (!part) {
            source_ended_ = true;
            break;
        }
        Slot& slot = slots_[(head_ + used_) % slots_.size()];
        slot.part = std::move(*part);
        slot.state = State::waiting;
        slot.large = false;
        ++used_;
    }
}

bool RecordQueue::has_turn(const Slot& slot) const {
    return turn_bytes_ && &slot == &slots_[head_];
}

RecordQueue::Slot* RecordQueue::first_waiting(Who who) {
    for (std::size_t i = 0; i < used_; ++i) {
        Slot& slot = slots_[(head_ + i) % slots_.size()];
        const bool may = !slot.large || (who == Who::caller && has_turn(slot));
        if (slot.state == State::waiting && may) return &slot;
    }
    return nullptr;
}

// A worker waits for the slot's turn; the caller cannot, since it is the one who takes the head.
std::uint64_t RecordQueue::more_for(Slot& slot, Who who) {
    std::unique_lock lock{mutex_};
    if (who == Who::worker) {
        changed_.wait(lock, [&] { return stopping_ || has_turn(slot); });
        if (!stopping_) return std::max<std::uint64_t>(*turn_bytes_, 1);
    }
    slot.large = true;
    return 0;
}

void RecordQueue::work(Slot& slot, PartDecoder& decoder, Who who,
                       std::unique_lock<std::mutex>& lock) {
    slot.state = State::working;
    slot.large = false;
    ArrayRoom room = has_turn(slot)
                         ? ArrayRoom{*turn_bytes_}
                         : ArrayRoom{share_bytes, [&, who] { return more_for(slot, who); }};
    lock.unlock();
    Fragment fragment = decoder.decode(slot.part, std::move(room));
    if (slot.large) fragment = {};
    lock.lock();
    slot.fragment = std::move(fragment);
    slot.state = slot.large ? State::waiting : State::ready;
    changed_.notify_all();
}

void RecordQueue::run() {
    PartDecoder decoder{limit_bytes_, selection_};
    std::unique_lock lock{mutex_};
    while (!stopping_) {
        if (Slot* slot = first_waiting(Who::worker)) {
            work(*slot, decoder, Who::worker, lock);
        } else {
            changed_.wait(lock);
        }
    }
}

std::optional<Fragment> RecordQueue::next(std::uint64_t limit_bytes) {
    std::unique_lock lock{mutex_};
    if (used_ == 0) return std::nullopt;
    turn_bytes_ = limit_bytes;
    changed_.notify_all();
    Slot& head = slots_[head_];
    while (head.state != State::ready) {
        if (Slot* slot = first_waiting(Who::caller)) {
            work(*slot, own_decoder_, Who::caller, lock);
        } else {
            changed_.wait(lock);
        }
    }
    Fragment fragment = std::exchange(head.fragment, {});
    turn_bytes_.reset();
    head.state = State::empty;
    head_ = (head_ + 1) % slots_.size();
    --used_;
    fill();
    changed_.notify_all();
    return fragment;
}

}  // namespace stormcellar::level2
