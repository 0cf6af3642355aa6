// web/http/answer_budget.h -- limits the memory of answers that are on their way to clients.
//
// The budget counts bytes in memory and nameless files, each once however many answers share it.
// Answers below 64 KiB are not counted, so they pass even when the budget is spent. One client may
// hold at most half of what the others leave. A larger answer passes if it is the only one. For 10
// s after a refusal, clients that hold something get nothing more. Otherwise clients whose slow
// answers were cut off would ask again and share what others hold, and nothing would become free.
//
// Threads   Many threads may use it.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/steady_time.h"
#include "stormcellar/base/mutex.h"
#include "web/http/answer.h"

namespace stormcellar::web {

inline constexpr std::uint64_t least_counted_bytes = std::uint64_t{64} << 10;

class AnswerBudget {
  public:
    explicit AnswerBudget(std::uint64_t most_bytes) : most_bytes_(most_bytes) {}

    [[nodiscard]] static bool is_counted(const Pieces& pieces);
    // Returns false, and takes nothing, if the budget or the client's share of it has no room.
    [[nodiscard]] bool take(const std::string& client, const Pieces& pieces);
    // Call once for each take() that succeeded, with the same pieces.
    void give_back(const std::string& client, const Pieces& pieces);
    [[nodiscard]] std::uint64_t bytes() const;

    struct HeldObject {
        const void* object = nullptr;
        std::uint64_t bytes = 0;
    };

  private:
    using Objects = std::vector<HeldObject>;
    static Objects objects_of(const Pieces& pieces);
    // Objects that one client, or all together, hold, with the number of answers that use each.
    struct Holder {
        std::map<const void*, std::uint64_t> uses;
        std::uint64_t bytes = 0;

        [[nodiscard]] std::uint64_t bytes_with(const Objects& objects) const;
        [[nodiscard]] bool has_room(const Objects& objects, std::uint64_t most) const;
        void add(const Objects& objects);
        void remove(const Objects& objects);
    };

    const std::uint64_t most_bytes_;
    mutable Mutex mutex_;
    Holder all_ STORMCELLAR_GUARDED_BY(mutex_);
    std::map<std::string, Holder> by_client_ STORMCELLAR_GUARDED_BY(mutex_);
    SteadyTime given_to_new_until_ STORMCELLAR_GUARDED_BY(mutex_){};
};

}  // namespace stormcellar::web
