// level2/decode/record_queue.h -- decodes LDM records ahead with several threads, and returns the
// fragments in order.
//
// The thread that calls next() decodes too, so `threads` includes this thread. The queue holds at
// most two fragments for each thread, and each fragment is small. A fragment that outgrows its
// share waits until it is the next to be returned. With more than most_waiting_threads threads, the
// queue discards such a fragment, and the caller decodes its record again when its turn comes,
// because the C library keeps freed memory for each thread.
//
// The output does not depend on the number of threads. When less room is left than a share, the
// caller alone decodes, and discards fragments that were decoded ahead.
//
// Threads   One thread may call next().
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <thread>
#include <vector>

#include "level2/containers/ldm_framer.h"
#include "level2/decode/part_decoder.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/level2/fragment.h"

namespace stormcellar::level2 {

class RecordQueue {
  public:
    // Returns the parts in order, and none after the last one. The queue calls it from one thread
    // at a time.
    using Source = std::function<std::optional<LdmPart>()>;

    // The bytes of the parts and `selection` must outlive the queue.
    RecordQueue(Source source, int threads, std::uint64_t output_limit_bytes,
                const Selection& selection);
    RecordQueue(const RecordQueue&) = delete;
    RecordQueue& operator=(const RecordQueue&) = delete;
    ~RecordQueue();

    // Returns the next fragment, or none after the last one. The arrays of the fragment may take
    // `limit_bytes`, which must not grow from call to call.
    [[nodiscard]] std::optional<Fragment> next(std::uint64_t limit_bytes);

    // More threads would help little, because a volume has some sixty records.
    static constexpr int most_threads = 32;
    static constexpr int most_waiting_threads = 4;
    // Largest share of memory for a fragment that is decoded ahead. Records of a live volume take 1
    // MB; the largest known records, which hold whole sweeps, take 5 MB.
    static constexpr std::uint64_t most_share_bytes = std::uint64_t{8} << 20;
    static constexpr std::uint64_t all_shares_bytes = std::uint64_t{128} << 20;

  private:
    enum class State : std::uint8_t { empty, waiting, working, ready };
    enum class Who : std::uint8_t { caller, worker };
    struct Slot {
        State state = State::empty;
        bool large = false;  // outgrew its share; the caller decodes it again at its turn
        LdmPart part;
        Fragment fragment;
    };
    void fill() STORMCELLAR_REQUIRES(mutex_);
    [[nodiscard]] Slot* first_waiting(Who who) STORMCELLAR_REQUIRES(mutex_);
    [[nodiscard]] bool has_turn(const Slot& slot) const STORMCELLAR_REQUIRES(mutex_);
    void work(Slot& slot, PartDecoder& decoder, Who who) STORMCELLAR_REQUIRES(mutex_);
    [[nodiscard]] ArrayRoom room_for(Slot& slot, Who who) STORMCELLAR_REQUIRES(mutex_);
    [[nodiscard]] std::uint64_t wait_for_turn(const Slot& slot) STORMCELLAR_EXCLUDES(mutex_);
    void decode_alone(Slot& head) STORMCELLAR_REQUIRES(mutex_);
    void run() STORMCELLAR_EXCLUDES(mutex_);

    std::uint64_t limit_bytes_;
    const Selection& selection_;
    PartDecoder own_decoder_;
    Mutex mutex_;
    ConditionVariable changed_;
    Source source_ STORMCELLAR_GUARDED_BY(mutex_);
    std::vector<Slot> slots_ STORMCELLAR_GUARDED_BY(mutex_);  // a ring
    std::uint64_t share_bytes_ STORMCELLAR_GUARDED_BY(mutex_);
    // True if a worker whose fragment outgrows its share waits; false if it discards the fragment.
    bool may_wait_ STORMCELLAR_GUARDED_BY(mutex_);
    bool alone_ STORMCELLAR_GUARDED_BY(mutex_) = false;    // the caller decodes everything
    std::size_t head_ STORMCELLAR_GUARDED_BY(mutex_) = 0;  // the slot that next() returns next
    std::size_t used_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    bool source_ended_ STORMCELLAR_GUARDED_BY(mutex_) = false;
    // Set while the caller is in next(): the bytes that the fragment of the head may take. At other
    // times the caller may still hold the last fragment.
    std::optional<std::uint64_t> turn_bytes_ STORMCELLAR_GUARDED_BY(mutex_);
    bool stopping_ STORMCELLAR_GUARDED_BY(mutex_) = false;
    std::vector<std::thread> workers_;
};

}  // namespace stormcellar::level2
