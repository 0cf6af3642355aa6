// pipeline/ingest/followed.h -- the files or volumes that are followed as they grow. Remembers
// which of them were given up.
//
// A GrowingSet gives up files or volumes to stay within its limits. This class remembers the keys
// of what was given up, so that nothing is followed again only to be given up again. When it
// remembers `most_remembered` keys, it forgets all keys; then everything may be followed once more.
// Inside the pipeline room only. Thread contract: one thread at a time; the owner locks.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "pipeline/ingest/growing_set.h"

namespace stormcellar::pipeline {

template <class Key, class Object>
class Followed {
  public:
    static constexpr std::size_t most_remembered = 4096;

    explicit Followed(GrowingLimits limits) : things_(limits) {}

    // Returns the object that is followed under this key, or null if there is none.
    [[nodiscard]] std::shared_ptr<Object> find(const Key& key) const { return things_.find(key); }
    // Makes a place for one more file or volume of the station. May give up other objects, by the
    // rules of GrowingSet::has_place(). Returns false if there is no place.
    [[nodiscard]] bool make_place(const std::string& station) {
        const bool has_place = things_.has_place(station, Clock::now());
        remember_given_up();
        return has_place;
    }
    void add(const Key& key, std::shared_ptr<Object> object, const std::string& station) {
        things_.add(key, std::move(object), station, Clock::now());
    }
    // Notes how much an object holds now. Returns false if the object was given up, or if another
    // object has its key.
    [[nodiscard]] bool grew(const Key& key, const Object* object, const std::string& station,
                            const Growth& growth) {
        const bool stands = things_.grew(key, object, station, growth, Clock::now());
        remember_given_up();
        return stands;
    }
    void give_up(const Key& key) {
        if (!things_.find(key)) return;
        things_.erase(key);
        remember(key);
    }
    // Forgets the key. It then counts as never followed and never given up.
    void forget(const Key& key) {
        things_.erase(key);
        given_up_.erase(key);
    }

    [[nodiscard]] bool was_given_up(const Key& key) const { return given_up_.contains(key); }
    // Returns true if the key was given up and has not had a second try. The second try is then
    // taken.
    [[nodiscard]] bool take_second_try(const Key& key) {
        const auto at = given_up_.find(key);
        return at != given_up_.end() && !std::exchange(at->second.had_second_try, true);
    }
    // Returns how many keys were given up since the last call.
    [[nodiscard]] std::uint64_t take_given_up() { return std::exchange(given_up_count_, 0); }

    [[nodiscard]] std::size_t count() const { return things_.count(); }
    [[nodiscard]] std::uint64_t held_bytes() const { return things_.held_bytes(); }
    [[nodiscard]] std::uint64_t shelf_bytes() const { return things_.shelf_bytes(); }

  private:
    using Clock = typename GrowingSet<Key, Object>::Clock;
    struct GivenUp {
        bool had_second_try = false;
    };

    void remember(const Key& key) {
        if (given_up_.size() >= most_remembered) given_up_.clear();
        given_up_.try_emplace(key);
        ++given_up_count_;
    }
    void remember_given_up() {
        for (const Key& key : things_.take_given_up())
            remember(key);
    }

    GrowingSet<Key, Object> things_;
    std::map<Key, GivenUp> given_up_;
    std::uint64_t given_up_count_ = 0;
};

}  // namespace stormcellar::pipeline
