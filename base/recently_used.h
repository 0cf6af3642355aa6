// base/recently_used.h -- keeps values by key within a budget, and drops the least recently used
// values first.
//
// A search takes logarithmic time if keys have an order; otherwise it compares one key after
// another.
//
// Units     A value has a weight, for example its bytes; by default, 1.
// Threads   One thread at a time: the mutex of the owner guards the object.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <list>
#include <map>
#include <utility>

namespace stormcellar {

struct KeptBudget {
    std::uint64_t weight = std::numeric_limits<std::uint64_t>::max();
    std::size_t values = std::numeric_limits<std::size_t>::max();
};

template <class Key, class Value>
class RecentlyUsed {
  public:
    explicit RecentlyUsed(KeptBudget budget) : budget_(budget) {}

    // Returns the value, which becomes the most recently used value; null if it is not kept.
    [[nodiscard]] Value* find(const Key& key) {
        const auto entry = place_of(key);
        if (entry == entries_.end()) return nullptr;
        entries_.splice(entries_.begin(), entries_, entry);
        return &entry->value;
    }
    // Keeps a value, which replaces any value with the same key, and drops old values beyond the
    // budget. The new value stays even if it alone exceeds the budget. Returns the kept value.
    Value& keep(const Key& key, Value value, std::uint64_t weight = 1) {
        drop(key);
        entries_.push_front({key, std::move(value), weight});
        if constexpr (is_ordered) {
            try {
                places_.emplace(key, entries_.begin());
            } catch (...) {
                entries_.pop_front();
                throw;
            }
        }
        weight_ += weight;
        while (entries_.size() > 1 &&
               (weight_ > budget_.weight || entries_.size() > budget_.values))
            drop(std::prev(entries_.end()));
        return entries_.front().value;
    }
    void drop(const Key& key) {
        if (const auto entry = place_of(key); entry != entries_.end()) drop(entry);
    }
    // Drops every value for whose key `predicate` returns true.
    template <class Predicate>
    void drop_if(Predicate predicate) {
        for (auto entry = entries_.begin(); entry != entries_.end();) {
            const auto next = std::next(entry);
            if (predicate(entry->key)) drop(entry);
            entry = next;
        }
    }

    [[nodiscard]] std::size_t size() const { return entries_.size(); }
    [[nodiscard]] std::uint64_t weight() const { return weight_; }

  private:
    static constexpr bool is_ordered = std::totally_ordered<Key>;
    struct Entry {
        Key key;
        Value value;
        std::uint64_t weight;
    };
    using Place = typename std::list<Entry>::iterator;

    Place place_of(const Key& key) {
        if constexpr (is_ordered) {
            const auto found = places_.find(key);
            return found == places_.end() ? entries_.end() : found->second;
        } else {
            auto entry = entries_.begin();
            while (entry != entries_.end() && !(entry->key == key))
                ++entry;
            return entry;
        }
    }
    void drop(Place entry) {
        weight_ -= entry->weight;
        if constexpr (is_ordered) places_.erase(entry->key);
        entries_.erase(entry);
    }

    // The empty type of `places_` for keys without an order.
    struct NoPlaces {};
    template <class K>
    struct PlacesOf {
        using type = NoPlaces;
    };
    template <std::totally_ordered K>
    struct PlacesOf<K> {
        using type = std::map<K, Place>;
    };

    KeptBudget budget_;
    std::uint64_t weight_ = 0;
    std::list<Entry> entries_;  // the most recently used first
    typename PlacesOf<Key>::type places_;
};

}  // namespace stormcellar
