#include "web/data/grids/kept_answers.h"

#include <exception>
#include <new>
#include <utility>

#include "web/data/grids/memory_file.h"

namespace stormcellar::web {
namespace {

constexpr std::uint64_t overhead_bytes = 256;

std::uint64_t size_in_budget(const std::string& key, const Kept& value) {
    return key.size() + size_of(value.bytes) + value.etag.size() + value.notes.size() +
           overhead_bytes;
}

// Calls `make`, and turns an exception into an error, because other threads wait for the result.
Result<Kept> made_in_file(const std::function<Result<Kept>()>& make) {
    try {
        Result<Kept> made = make();
        if (!made) return made;
        if (const auto* text = std::get_if<Text>(&made->bytes)) made->bytes = in_file(*text);
        return made;
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::exhausted, "there is no memory left for this answer");
    } catch (const std::exception& error) {
        return fail(ErrorCode::exhausted, "this answer cannot be made now: {}", error.what());
    }
}

}  // namespace

// A value that one thread makes while other threads wait for it. KeptAnswers::mutex_ guards it.
struct KeptAnswers::Making {
    ConditionVariable done;
    std::optional<Result<Kept>> result;
    bool is_over = false;  // ended without a result, because memory was short
};

std::optional<Kept> KeptAnswers::find(const std::string& key) {
    const MutexLock lock(mutex_);
    const Kept* found = kept_.find(key);
    return found == nullptr ? std::nullopt : std::optional(*found);
}

void KeptAnswers::keep(const std::string& key, const Kept& value) {
    const std::uint64_t size = size_in_budget(key, value);
    if (size > most_bytes_of_one_ || kept_.find(key) != nullptr) return;
    kept_.keep(key, value, size);
}

Result<Kept> KeptAnswers::find_or_make(const std::string& key,
                                       const std::function<Result<Kept>()>& make) {
    if (auto kept = find(key)) return *std::move(kept);
    const auto ours = std::make_shared<Making>();
    {
        const MutexLock lock(mutex_);
        // Another thread may have made the value since find() was called.
        if (const Kept* found = kept_.find(key)) return *found;
        if (const auto other = making_.find(key); other != making_.end()) {
            const std::shared_ptr<Making> theirs = other->second;
            while (!theirs->is_over)
                theirs->done.wait(mutex_);
            if (theirs->result) return *theirs->result;
            return fail(ErrorCode::exhausted, "there is no memory left for this answer");
        }
        making_[key] = ours;
    }
    Result<Kept> made = made_in_file(make);
    const MutexLock lock(mutex_);
    making_.erase(key);
    try {
        ours->result = made;
        if (made) keep(key, *made);
    } catch (const std::bad_alloc&) {
        // Send the answer without keeping it.
    }
    ours->is_over = true;
    ours->done.notify_all();
    return made;
}

void KeptAnswers::forget(std::string_view prefix) {
    const MutexLock lock(mutex_);
    kept_.drop_if([prefix](const std::string& key) { return key.starts_with(prefix); });
}

std::uint64_t KeptAnswers::bytes() const {
    const MutexLock lock(mutex_);
    return kept_.weight();
}

}  // namespace stormcellar::web
