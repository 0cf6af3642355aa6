// web/data/grids/kept_answers.h -- keeps answers in memory within a budget.
//
// Units     The budget is in bytes. Each value counts as its own size plus 256.
// Threads   Many threads may use it. If several want the same value at the same time, one makes it
//           and the others wait.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "base/recently_used.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/result.h"
#include "web/http/answer.h"

namespace stormcellar::web {

struct Kept {
    Piece bytes;
    std::string etag;   // with quotes
    std::string notes;  // more text for the caller, for example the content type
};

class KeptAnswers {
  public:
    explicit KeptAnswers(std::uint64_t budget_bytes)
        : most_bytes_of_one_(budget_bytes / 4), kept_({.weight = budget_bytes}) {}

    // Returns the value if it is kept, else none. Takes microseconds.
    [[nodiscard]] std::optional<Kept> find(const std::string& key);
    // Returns the value. If it is not kept, makes it with `make` and keeps it, in a memory file if
    // it has 256 KiB or more. Does not keep errors; an exception becomes an error. Does not keep a
    // value that is larger than a quarter of the budget.
    [[nodiscard]] Result<Kept> find_or_make(const std::string& key,
                                            const std::function<Result<Kept>()>& make);
    // Drops all values whose keys begin with this text.
    void forget(std::string_view prefix);
    [[nodiscard]] std::uint64_t bytes() const;

  private:
    struct Making;
    void keep(const std::string& key, const Kept& value) STORMCELLAR_REQUIRES(mutex_);

    const std::uint64_t most_bytes_of_one_;
    mutable Mutex mutex_;
    RecentlyUsed<std::string, Kept> kept_ STORMCELLAR_GUARDED_BY(mutex_);
    std::unordered_map<std::string, std::shared_ptr<Making>> making_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::web
