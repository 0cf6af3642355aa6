// level2/record_queue.h -- LDM records decoded ahead by threads, handed out in order.
//
// The caller of next() decodes too, so `threads` counts it. At most two fragments a thread are
// held. What comes out does not depend on the number of threads.
// Thread contract: next() from one thread.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "level2/fragment.h"
#include "level2/ldm_framer.h"
#include "level2/part_decoder.h"

namespace stormcellar::level2 {

class RecordQueue {
  public:
    // Gives the parts, in their order, none after the last. Called by one thread at a time.
    using Source = std::function<std::optional<LdmPart>()>;

    // What the parts point to and the selection must outlive the queue.
    RecordQueue(Source source, int threads, std::uint64_t output_limit_bytes,
                const Selection& selection);
    RecordQueue(const RecordQueue&) = delete;
    RecordQueue& operator=(const RecordQueue&) = delete;
    ~RecordQueue();

    // None after the last.
    [[nodiscard]] std::optional<Fragment> next();

  private:
    enum class State : std::uint8_t { empty, waiting, working, ready };
    struct Slot {
        State state = State::empty;
        LdmPart part;
        Fragment fragment;
    };
    void fill();                          // under mutex_
    [[nodiscard]] Slot* first_waiting();  // under mutex_
    void work(Slot& slot, PartDecoder& decoder, std::unique_lock<std::mutex>& lock);
    void run();

    std::uint64_t limit_bytes_;
    const Selection& selection_;
    PartDecoder own_decoder_;
    std::mutex mutex_;  // guards all below
    std::condition_variable changed_;
    Source source_;
    std::vector<Slot> slots_;  // a ring
    std::size_t head_ = 0;     // the slot that is handed out next
    std::size_t used_ = 0;
    bool source_ended_ = false;
    bool stopping_ = false;
    std::vector<std::thread> workers_;
};

}  // namespace stormcellar::level2
