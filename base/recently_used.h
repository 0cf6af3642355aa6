// base/recently_used.h -- keeps values by key for reuse, and drops the least recently used ones
// first.
//
// Threads   Many threads may use it. If two threads want a value at the same time, it may be made
//           twice, and one of the two is kept.
#pragma once

#include <cstddef>
#include <list>
#include <mutex>
#include <optional>
#include <utility>

namespace stormcellar {

template <class Key, class Value>
class RecentlyUsed {
  public:
    explicit RecentlyUsed(std::size_t capacity) : capacity_(capacity) {}

    // Returns the value, or none if there is none.
    std::optional<Value> find(const Key& key) {
        const std::scoped_lock lock(mutex_);
        for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
            if (!(entry->first == key)) continue;
            entries_.splice(entries_.begin(), entries_, entry);
            return entry->second;
        }
        return std::nullopt;
    }
    // Keeps a value and returns the one that stays, which another thread may have made meanwhile.
    Value keep(const Key& key, Value value) {
        if (auto found = find(key)) return *std::move(found);
        const std::scoped_lock lock(mutex_);
        entries_.emplace_front(key, value);
        if (entries_.size() > capacity_) entries_.pop_back();
        return value;
    }

  private:
    std::size_t capacity_;
    std::mutex mutex_;                          // guards entries_
    std::list<std::pair<Key, Value>> entries_;  // the most recently used first
};

}  // namespace stormcellar
