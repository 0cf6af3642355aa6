// level2/record_queue.h -- LDM records decompressed ahead by threads, handed out in order.
//
// The caller of next() decompresses too, so `threads` counts it. At most two records a thread are
// held. What comes out does not depend on the number of threads.
// Thread contract: next() from one thread.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "level2/bzip2_stream.h"
#include "level2/ldm_framer.h"

namespace stormcellar::level2 {

class RecordQueue {
  public:
    // Records of more output are not held whole: status too_large, to be read block by block.
    static constexpr std::size_t held_record_bytes = std::size_t{4} << 20;
    // A compressed record of more bytes is not even tried.
    static constexpr std::size_t tried_record_bytes = std::size_t{2} << 20;

    RecordQueue(std::span<const std::byte> bytes, int threads);
    RecordQueue(const RecordQueue&) = delete;
    RecordQueue& operator=(const RecordQueue&) = delete;
    ~RecordQueue();

    struct Item {
        LdmPart part;
        BzipResult result;                  // of a record
        std::span<const std::byte> output;  // of a whole record; valid until the next call
        double cpu_s = 0;
    };
    [[nodiscard]] std::optional<Item> next();

  private:
    enum class State : std::uint8_t { empty, waiting, working, ready };
    struct Slot {
        State state = State::empty;
        LdmPart part;
        std::vector<std::byte> buffer;
        BzipResult result;
        double cpu_s = 0;
    };
    void fill();                          // under mutex_
    [[nodiscard]] Slot* first_waiting();  // under mutex_
    void work(Slot& slot, std::unique_lock<std::mutex>& lock);
    void run();

    std::mutex mutex_;  // guards all below
    std::condition_variable changed_;
    LdmFramer framer_;
    std::vector<Slot> slots_;  // a ring
    std::size_t head_ = 0;     // the slot that is handed out next
    std::size_t used_ = 0;
    bool handed_out_ = false;  // the head's contents are in the caller's hands
    bool all_framed_ = false;
    bool stopping_ = false;
    std::vector<std::thread> workers_;
};

// CPU time of the calling thread.
[[nodiscard]] double thread_cpu_s();

}  // namespace stormcellar::level2
