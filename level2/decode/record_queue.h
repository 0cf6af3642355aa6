// level2/decode/record_queue.h -- LDM records decoded ahead by threads, handed out in order.
//
// The caller of next() decodes too, so `threads` counts it. At most two fragments a thread are
// held, and each is small: one that outgrows its share waits until it is the next to be handed out,
// or, with more than a few threads, is decoded anew by the caller then, since the C library keeps
// for each thread what it has freed.
// What comes out does not depend on the number of threads: where less is left than a share, nothing
// is decoded ahead any more, and what was is thrown away.
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

#include "level2/containers/ldm_framer.h"
#include "level2/decode/part_decoder.h"
#include "stormcellar/level2/fragment.h"

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

    // None after the last. `limit_bytes`: what the fragment may take; it never grows.
    [[nodiscard]] std::optional<Fragment> next(std::uint64_t limit_bytes);

    // A volume has some sixty records.
    static constexpr int most_threads = 32;
    static constexpr int most_waiting_threads = 4;
    // Of each fragment that is decoded ahead. Records of a live volume take 1 MB, the largest seen,
    // of whole sweeps, 5.
    static constexpr std::uint64_t most_share_bytes = std::uint64_t{8} << 20;
    static constexpr std::uint64_t all_shares_bytes = std::uint64_t{128} << 20;

  private:
    enum class State : std::uint8_t { empty, waiting, working, ready };
    enum class Who : std::uint8_t { caller, worker };
    struct Slot {
        State state = State::empty;
        bool large = false;  // outgrew its share: it is decoded again, when its turn has come
        LdmPart part;
        Fragment fragment;
    };
    // All but run() and wait_for_turn() under mutex_.
    void fill();
    [[nodiscard]] Slot* first_waiting(Who who);
    [[nodiscard]] bool has_turn(const Slot& slot) const;
    void work(Slot& slot, PartDecoder& decoder, Who who, std::unique_lock<std::mutex>& lock);
    [[nodiscard]] ArrayRoom room_for(Slot& slot, Who who);
    [[nodiscard]] std::uint64_t wait_for_turn(const Slot& slot);
    void decode_alone(Slot& head, std::unique_lock<std::mutex>& lock);
    void run();

    std::uint64_t limit_bytes_;
    const Selection& selection_;
    PartDecoder own_decoder_;
    std::mutex mutex_;  // guards all below
    std::condition_variable changed_;
    Source source_;
    std::vector<Slot> slots_;  // a ring
    std::uint64_t share_bytes_;
    bool may_wait_;         // workers with what outgrows its share
    bool alone_ = false;    // the caller decodes all
    std::size_t head_ = 0;  // the slot that is handed out next
    std::size_t used_ = 0;
    bool source_ended_ = false;
    // The caller waits for the head slot, which may take so much. Before, it holds the last one.
    std::optional<std::uint64_t> turn_bytes_;
    bool stopping_ = false;
    std::vector<std::thread> workers_;
};

}  // namespace stormcellar::level2
