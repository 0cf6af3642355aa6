// pipeline/ingest/growing_set.h -- a set of files or volumes that are followed as they grow. The
// set is limited for each station and in total. Used only inside the pipeline room.
//
// Each member holds a descriptor, memory and disk space. Its size is updated after each stretch
// that is read, because what a file claims cannot be trusted. If a limit is exceeded, members are
// given up (no longer followed):
//   a station's own limit   among the members of the station
//   the total limit         first among members of unknown stations, then among all
//   the limit of beginnings among members without a complete sweep. A real volume has no complete
//                           sweep for a fifteenth of its time; a forged volume may never have a
//                           complete sweep.
// If there is too little memory or disk space, the member with the largest product of its size and
// (1 + its minutes without progress) is given up. If there are too many members, the least active
// member of the station with the most members is given up.
//
// There is no place for a new member if all members are active: if active members were given up for
// new members, everything would be read again and again. A member is active for a minute after it
// has grown. But a member is active for only five seconds as long as it has no complete sweep, or
// got no data after the first look. At the total limit, however, a station with fewer members takes
// a place from the station with the most.
//
// Threads   One thread at a time; the owner locks.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace stormcellar::pipeline {

struct GrowingLimits {
    std::size_t count = 320;  // each holds a descriptor
    std::uint64_t held_bytes = std::uint64_t{192} << 20;
    std::uint64_t beginnings_held_bytes = std::uint64_t{192} << 20;
    std::uint64_t shelf_bytes = std::uint64_t{4} << 30;
    // Limits of one station. All unknown stations count as one. A site's volume holds some 3 MB for
    // one moment, and two of its volumes may grow at the same time.
    std::size_t station_count = 16;
    std::uint64_t station_held_bytes = std::uint64_t{16} << 20;
    std::uint64_t station_shelf_bytes = std::uint64_t{512} << 20;

    // Returns the limits for this many moments. Each of 160 sites holds about a megabyte for each
    // moment.
    [[nodiscard]] static GrowingLimits of(std::size_t moments) {
        GrowingLimits limits;
        limits.held_bytes = (128 + 64 * moments) << 20;
        limits.beginnings_held_bytes = limits.held_bytes / 4;
        limits.station_held_bytes = (8 + 8 * moments) << 20;
        return limits;
    }
};

// Memory and disk space that a member holds, and its progress.
struct Growth {
    std::uint64_t held_bytes = 0, shelf_bytes = 0;
    bool has_sweeps = false;  // some sweeps are complete
};

template <class Key, class Object>
class GrowingSet {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds most_idle{60}, most_idle_at_first{5};
    // A stretch that is read this soon still counts as part of the first look.
    static constexpr std::chrono::seconds first_look{1};

    explicit GrowingSet(GrowingLimits limits) : limits_(limits) {}

    [[nodiscard]] std::shared_ptr<Object> find(const Key& key) const {
        const auto at = things_.find(key);
        return at == things_.end() ? nullptr : at->second.object;
    }

    // Makes a place for a new member, by giving up other members if necessary. Returns false if
    // there is no place. A member that is added nevertheless is given up when it next grows.
    [[nodiscard]] bool has_place(const std::string& station, Clock::time_point now) {
        while (count_of(station) >= limits_.station_count) {
            if (!give_up_idle(&station, now)) return false;
        }
        while (things_.size() >= limits_.count) {
            if (!give_up_idle(nullptr, now) && !give_up_of_largest(count_of(station))) return false;
        }
        return true;
    }

    void add(const Key& key, std::shared_ptr<Object> object, const std::string& station,
             Clock::time_point now) {
        things_.insert_or_assign(key, Thing{std::move(object), station, now, now, {}});
    }

    // Notes how much a member holds now. Returns false if the member was given up, or if another
    // object has its key.
    [[nodiscard]] bool grew(const Key& key, const Object* object, const std::string& station,
                            const Growth& growth, Clock::time_point now) {
        const auto at = things_.find(key);
        if (at == things_.end() || at->second.object.get() != object) return false;
        Thing& thing = at->second;
        thing.station = station;
        thing.grew_at = now;
        thing.growth = growth;
        if (things_.size() > limits_.count || count_of(station) > limits_.station_count) {
            give_up(at);
        } else {
            keep_within(station, now);
        }
        return find(key).get() == object;
    }

    void erase(const Key& key) { things_.erase(key); }
    [[nodiscard]] std::size_t count() const { return things_.size(); }
    [[nodiscard]] std::uint64_t held_bytes() const { return sum_of(any).held; }
    [[nodiscard]] std::uint64_t shelf_bytes() const { return sum_of(any).shelf; }
    // Returns the members that were given up since the last call.
    [[nodiscard]] std::vector<Key> take_given_up() { return std::exchange(given_up_, {}); }

  private:
    struct Thing {
        std::shared_ptr<Object> object;
        std::string station;  // empty: no known station
        Clock::time_point began_at, grew_at;
        Growth growth;
    };
    using Things = std::map<Key, Thing>;
    using Place = typename Things::iterator;
    struct Sum {
        std::uint64_t held = 0, shelf = 0;
    };

    static bool any(const Thing& /*thing*/) { return true; }
    static bool has_no_sweep(const Thing& thing) { return !thing.growth.has_sweeps; }

    template <class Which>
    [[nodiscard]] Sum sum_of(const Which& which) const {
        Sum sum;
        for (const auto& [key, thing] : things_) {
            if (!which(thing)) continue;
            sum.held += thing.growth.held_bytes;
            sum.shelf += thing.growth.shelf_bytes;
        }
        return sum;
    }
    [[nodiscard]] std::size_t count_of(const std::string& station) const {
        std::size_t count = 0;
        for (const auto& [key, thing] : things_)
            count += thing.station == station ? 1 : 0;
        return count;
    }

    void give_up(Place place) {
        given_up_.push_back(place->first);
        things_.erase(place);
    }

    [[nodiscard]] static bool goes_on(const Thing& thing) {
        return thing.growth.has_sweeps && thing.grew_at - thing.began_at >= first_look;
    }
    [[nodiscard]] static bool is_idle(const Thing& thing, Clock::time_point now) {
        return now - thing.grew_at >= (goes_on(thing) ? most_idle : most_idle_at_first);
    }

    // Gives up the idle member that grew longest ago: of this station, or if null, of the station
    // with the most members. Returns false if no member is idle.
    bool give_up_idle(const std::string* station, Clock::time_point now) {
        std::map<std::string, std::size_t> counts;
        if (station == nullptr) {
            for (const auto& [key, thing] : things_)
                ++counts[thing.station];
        }
        const auto count = [&](const Thing& thing) {
            return station == nullptr ? counts.at(thing.station) : std::size_t{0};
        };
        Place chosen = things_.end();
        for (Place at = things_.begin(); at != things_.end(); ++at) {
            const Thing& thing = at->second;
            if (station != nullptr && thing.station != *station) continue;
            if (!is_idle(thing, now)) continue;
            if (chosen == things_.end() || count(thing) > count(chosen->second) ||
                (count(thing) == count(chosen->second) && thing.grew_at < chosen->second.grew_at)) {
                chosen = at;
            }
        }
        if (chosen == things_.end()) return false;
        give_up(chosen);
        return true;
    }

    // Gives up the least active member of the station with the most members, if the station has
    // more than `count` + 1 members.
    bool give_up_of_largest(std::size_t count) {
        std::map<std::string, std::size_t> counts;
        for (const auto& [key, thing] : things_)
            ++counts[thing.station];
        const auto largest =
            std::max_element(counts.begin(), counts.end(),
                             [](const auto& a, const auto& b) { return a.second < b.second; });
        if (largest == counts.end() || largest->second <= count + 1) return false;
        Place chosen = things_.end();
        const auto rank = [](const Thing& thing) {
            return std::pair(goes_on(thing), thing.grew_at);
        };
        for (Place at = things_.begin(); at != things_.end(); ++at) {
            if (at->second.station != largest->first) continue;
            if (chosen == things_.end() || rank(at->second) < rank(chosen->second)) chosen = at;
        }
        give_up(chosen);
        return true;
    }

    enum class What { memory, disk };
    // Gives up one of the members for which `which` is true. Returns false if none of these holds
    // anything.
    template <class Which>
    bool give_up_largest(const Which& which, What what, Clock::time_point now) {
        Place chosen = things_.end();
        double most = 0;
        bool chosen_is_known = true;
        for (Place at = things_.begin(); at != things_.end(); ++at) {
            const Thing& thing = at->second;
            if (!which(thing)) continue;
            const auto bytes = static_cast<double>(what == What::memory ? thing.growth.held_bytes
                                                                        : thing.growth.shelf_bytes);
            const double idle_min = std::chrono::duration<double>(now - thing.grew_at).count() / 60;
            const double weight = bytes * (1 + idle_min);
            const bool is_known = !thing.station.empty();
            if (weight <= 0 || (is_known && !chosen_is_known)) continue;
            if (weight > most || (chosen_is_known && !is_known)) {
                chosen = at;
                most = weight;
                chosen_is_known = is_known;
            }
        }
        if (chosen == things_.end()) return false;
        give_up(chosen);
        return true;
    }

    void keep_within(const std::string& station, Clock::time_point now) {
        const auto of_station = [&](const Thing& thing) { return thing.station == station; };
        while (sum_of(of_station).held > limits_.station_held_bytes)
            if (!give_up_largest(of_station, What::memory, now)) break;
        while (sum_of(of_station).shelf > limits_.station_shelf_bytes)
            if (!give_up_largest(of_station, What::disk, now)) break;
        while (sum_of(has_no_sweep).held > limits_.beginnings_held_bytes)
            if (!give_up_largest(has_no_sweep, What::memory, now)) break;
        while (sum_of(any).held > limits_.held_bytes)
            if (!give_up_largest(any, What::memory, now)) break;
        while (sum_of(any).shelf > limits_.shelf_bytes)
            if (!give_up_largest(any, What::disk, now)) break;
    }

    GrowingLimits limits_;
    Things things_;
    std::vector<Key> given_up_;
};

}  // namespace stormcellar::pipeline
