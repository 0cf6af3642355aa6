#include "level2/decode/record_queue.h"

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
      slots_(threads > 1 ? 2 * static_cast<std::size_t>(std::min(threads, most_threads)) : 1),
      share_bytes_(std::min(most_share_bytes, all_shares_bytes / slots_.size())),
      may_wait_(threads <= most_waiting_threads) {
    threads = std::min(threads, most_threads);
    {
        const MutexLock lock(mutex_);
        fill();
    }
    try {
        workers_.reserve(slots_.size());
        for (int i = 1; i < threads; ++i)
            workers_.emplace_back(&RecordQueue::run, this);
    } catch (const std::system_error&) {
        // The system has no more threads, so the present threads do the work.
    } catch (const std::bad_alloc&) {
        // There is no memory for more threads, so the present threads do the work.
    }
}

RecordQueue::~RecordQueue() {
    {
        const MutexLock lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    for (std::thread& worker : workers_)
        worker.join();
}

// Fills all free slots of the ring with the next parts.
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

// Returns the first slot that waits for work. Only the caller takes a slot that outgrew its share,
// and only when the slot is the head. If alone_ is set, the caller takes every slot, and only as
// the head.
RecordQueue::Slot* RecordQueue::first_waiting(Who who) {
    for (std::size_t i = 0; i < used_; ++i) {
        Slot& slot = slots_[(head_ + i) % slots_.size()];
        // a working thread may set `large` without the mutex, so read the state first
        if (slot.state != State::waiting) continue;
        const bool is_head = who == Who::caller && has_turn(slot);
        if (is_head || !(slot.large || alone_)) return &slot;
    }
    return nullptr;
}

std::uint64_t RecordQueue::wait_for_turn(const Slot& slot) {
    const MutexLock lock(mutex_);
    while (!stopping_ && !has_turn(slot))
        changed_.wait(mutex_);
    return stopping_ ? 0 : std::max<std::uint64_t>(*turn_bytes_, 1);
}

// Returns the room for decoding a slot. Each function in the room holds at most two pointers, so
// std::function allocates no memory.
ArrayRoom RecordQueue::room_for(Slot& slot, Who who) {
    if (has_turn(slot)) return ArrayRoom{*turn_bytes_};
    if (who == Who::worker && may_wait_) {
        return ArrayRoom{share_bytes_, [this, &slot] { return wait_for_turn(slot); }};
    }
    // The caller must not wait for its own turn, so a slot that outgrows its share becomes large.
    return ArrayRoom{share_bytes_, [&slot] {
                         slot.large = true;
                         return std::uint64_t{0};
                     }};
}

// Decodes the part of a slot without holding the mutex. A slot that outgrew its share goes back to
// waiting, without its fragment.
void RecordQueue::work(Slot& slot, PartDecoder& decoder, Who who) {
    slot.state = State::working;
    slot.large = false;
    ArrayRoom room = room_for(slot, who);
    Fragment fragment;
    {
        const MutexUnlock unlocked(mutex_);
        fragment = decoder.decode(slot.part, std::move(room));
        if (slot.large) fragment = {};
    }
    slot.fragment = std::move(fragment);
    slot.state = slot.large ? State::waiting : State::ready;
    changed_.notify_all();
}

void RecordQueue::run() {
    PartDecoder decoder{limit_bytes_, selection_};
    const MutexLock lock(mutex_);
    while (!stopping_) {
        if (Slot* slot = first_waiting(Who::worker)) {
            work(*slot, decoder, Who::worker);
        } else {
            changed_.wait(mutex_);
        }
    }
}

// Decodes the head again with all the room that is left, and not with the share of a record decoded
// ahead.
void RecordQueue::decode_alone(Slot& head) {
    while (head.state == State::working)
        changed_.wait(mutex_);
    head.fragment = {};
    work(head, own_decoder_, Who::caller);
}

// Returns the fragment of the head slot. While that fragment is not ready, the caller decodes the
// head or another waiting slot. When less room is left than a share, parts that were decoded ahead
// might not fit, so from then on the caller decodes everything alone.
std::optional<Fragment> RecordQueue::next(std::uint64_t limit_bytes) {
    const MutexLock lock(mutex_);
    if (used_ == 0) return std::nullopt;
    turn_bytes_ = limit_bytes;
    changed_.notify_all();
    Slot& head = slots_[head_];
    alone_ = alone_ || limit_bytes < share_bytes_;
    if (alone_) decode_alone(head);
    while (head.state != State::ready) {
        if (Slot* slot = first_waiting(Who::caller)) {
            work(*slot, own_decoder_, Who::caller);
        } else {
            changed_.wait(mutex_);
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
