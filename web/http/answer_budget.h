// web/http/answer_budget.h -- limits the memory of answers that are on their way to clients.
//
// The budget counts texts in memory and nameless files. It counts each object once, however many
// answers share it. Answers below 64 KiB are not counted, so they are sent even if the budget is
// used up. One client may hold at most half of the room that other clients leave, or one larger
// answer. An answer that is larger than the whole budget is allowed if nothing else is held. When
// the budget has had no room, clients that hold something get nothing more for 10 s. Otherwise a
// client whose slow answer was cut off could ask again and share an object that another client
// holds, and then no object would ever become free.
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
    // Takes room for the pieces. Returns false, and takes nothing, if the budget or the client's
    // share of it has no room.
    [[nodiscard]] bool take(const std::string& client, const Pieces& pieces);
    // Gives the room back. Call it once for each take() that succeeded, with the same pieces.
    void give_back(const std::string& client, const Pieces& pieces);
    [[nodiscard]] std::uint64_t bytes() const;

    struct HeldObject {
        const void* object = nullptr;
        std::uint64_t bytes = 0;
    };

  private:
    using Objects = std::vector<HeldObject>;
    static Objects objects_of(const Pieces& pieces);
    // The objects that one client holds, or that all clients hold, with the number of answers that
    // use each object.
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
