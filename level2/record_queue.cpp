#include "level2/record_queue.h"

#include <algorithm>
#include <ctime>
#include <new>
#include <system_error>

namespace stormcellar::level2 {

double thread_cpu_s() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

RecordQueue::RecordQueue(std::span<const std::byte> bytes, int threads)
    : framer_(bytes), slots_(threads > 1 ? 2 * static_cast<std::size_t>(threads) : 1) {
    {
        const std::lock_guard lock{mutex_};
        fill();
    }
    for (int i = 1; i < threads; ++i) {
        try {
            workers_.emplace_back(&RecordQueue::run, this);
        } catch (const std::system_error&) {
            break;  // the system has no more threads: those there are do the work
        }
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
    while (used_ < slots_.size() && !all_framed_) {
        std::optional<LdmPart> part = framer_.next();
        if (!part) {
            all_framed_ = true;
            break;
        }
        Slot& slot = slots_[(head_ + used_) % slots_.size()];
        slot.part = std::move(*part);
        slot.result = {};
        slot.cpu_s = 0;
        slot.state = slot.part.kind == LdmPart::Kind::record ? State::waiting : State::ready;
        ++used_;
    }
}

RecordQueue::Slot* RecordQueue::first_waiting() {
    for (std::size_t i = 0; i < used_; ++i) {
        Slot& slot = slots_[(head_ + i) % slots_.size()];
        if (slot.state == State::waiting) return &slot;
    }
    return nullptr;
}

void RecordQueue::work(Slot& slot, std::unique_lock<std::mutex>& lock) {
    slot.state = State::working;
    lock.unlock();
    const double begin_s = thread_cpu_s();
    BzipResult result{BzipStatus::too_large, 0, 0};
    if (slot.part.bytes.size() <= tried_record_bytes) {
        try {
            result = bunzip(slot.part.bytes, slot.buffer, held_record_bytes);
        } catch (const std::bad_alloc&) {
            result.status = BzipStatus::no_memory;
        }
    }
    const double cpu_s = thread_cpu_s() - begin_s;
    lock.lock();
    slot.result = result;
    slot.cpu_s = cpu_s;
    slot.state = State::ready;
    changed_.notify_all();
}

void RecordQueue::run() {
    std::unique_lock lock{mutex_};
    while (!stopping_) {
        if (Slot* slot = first_waiting()) {
            work(*slot, lock);
        } else {
            changed_.wait(lock);
        }
    }
}

std::optional<RecordQueue::Item> RecordQueue::next() {
    std::unique_lock lock{mutex_};
    if (handed_out_) {
        slots_[head_].state = State::empty;
        head_ = (head_ + 1) % slots_.size();
        --used_;
        handed_out_ = false;
        fill();
        changed_.notify_all();
    }
    if (used_ == 0) return std::nullopt;
    Slot& head = slots_[head_];
    while (head.state != State::ready) {
        if (Slot* slot = first_waiting()) {
            work(*slot, lock);
        } else {
            changed_.wait(lock);
        }
    }
    handed_out_ = true;
    Item item{head.part, head.result, {}, head.cpu_s};
    if (head.result.status == BzipStatus::whole) {
        item.output = std::span{head.buffer}.first(head.result.output_bytes);
    }
    return item;
}

}  // namespace stormcellar::level2
