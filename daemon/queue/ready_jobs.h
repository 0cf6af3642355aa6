// daemon/queue/ready_jobs.h -- which of the jobs that may run is the next.
//
// LIVE is what changed while we watched, or less than ten minutes ago; BACKLOG is all else. Of the
// live jobs there are four classes; in a round each has so many turns as stand behind it:
//   going on   of a known station, of a volume of which sweeps have closed   8
//   fresh      all else of a known station of which an event told            4
//   found      all else of a known station, found by a look: a scan, a poll  1
//   others     of no station that is known                                   1
// The backlog of known stations, then that of others, each newest first, has its turn when nothing
// live waits, and that of known stations one turn in seventeen else. So a flood of beginnings
// delays no volume that goes on, one of names that nobody knows delays no known station, and none
// of them stands still. In a class stations take turns, the one that was served longest ago (or has
// waited longest) first, so that no station can hold up another, however much it sends. Of one
// station what goes on is served oldest first (the end of a volume before the next volume's sweeps:
// it is little, and would else wait as long as new chunks come), all else newest first. Pure
// bookkeeping. Thread contract: one thread.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <unordered_map>

namespace stormcellar::daemon {

enum class Urgency : std::uint8_t { backlog, live };

class ReadyJobs {
  public:
    struct Key {
        Urgency urgency = Urgency::backlog;
        bool is_begun = false;       // of a volume that goes on; live jobs alone
        std::int64_t newest_ns = 0;  // since the epoch
        std::uint64_t sequence = 0;  // tells all jobs apart; equal ones go by it
        std::string station;         // whose turn it takes; empty: that of all unknown ones
        bool is_told = true;         // an event told of it; live jobs alone
    };

    void add(const Key& key, void* job);
    // As one step, so that a station whose only job is merged keeps its turn.
    void replace(const Key& old, const Key& key, void* job);
    void remove(const Key& key);
    // Of the stations of which `may_begin` is true (null: of all); null when there is none. Of the
    // backlog only so many are looked at as most_looked_at says.
    using MayBegin = std::function<bool(const std::string& station)>;
    static constexpr int most_looked_at = 64;
    void* take_next(const MayBegin& may_begin = {});
    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] std::size_t count() const { return count_; }

  private:
    // By its order: what is to come first is less.
    struct Rank {
        std::int64_t order = 0;
        std::uint64_t sequence = 0;
        // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes a defaulted <=> for a null.
        auto operator<=>(const Rank&) const = default;
    };
    struct Station {
        std::uint64_t turn = 0;
        std::map<Rank, void*> jobs;
    };
    // The live jobs of a class.
    struct Turns {
        std::unordered_map<std::string, Station> stations;  // those with jobs
        std::map<std::uint64_t, std::string> turns;
        int left = 0;  // in this round
    };
    enum class Class : std::size_t { going_on, fresh, found, others };
    static constexpr std::array<int, 4> turns_a_round = {8, 4, 1, 1};
    struct OldJob {
        void* job = nullptr;
        std::string station;
    };
    using Backlog = std::map<Rank, OldJob>;

    static Class class_of(const Key& key);
    static Rank rank_of(const Key& key);
    [[nodiscard]] Turns& turns_for(const Key& key) {
        return live_.at(static_cast<std::size_t>(class_of(key)));
    }
    [[nodiscard]] Backlog& backlog_of(const Key& key) {
        return key.station.empty() ? others_backlog_ : backlog_;
    }
    void give_turn(Turns& turns, const std::string& name, Station& station);
    void* take_live(Turns& turns, const MayBegin& may_begin);
    void* take_old(Backlog& backlog, const MayBegin& may_begin);
    void* take_of_round(const MayBegin& may_begin);
    void* take_any_live(const MayBegin& may_begin);

    static constexpr int live_between_old = 16;
    std::size_t count_ = 0;
    int live_since_old_ = 0;  // taken while a backlog waited
    std::uint64_t next_turn_ = 0;
    std::array<Turns, 4> live_;
    Backlog backlog_, others_backlog_;  // of known stations, and of all else
};

}  // namespace stormcellar::daemon
