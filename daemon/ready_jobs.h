// daemon/ready_jobs.h -- which of the jobs that may run is the next.
//
// Two classes. LIVE is what changed while we watched, or less than ten minutes ago; BACKLOG is all
// else, and has its turn when nothing live waits: that of known stations first, newest first.
// Live jobs take turns by station, the one that was served longest ago (or has waited longest)
// first, so that no station can hold up another, however much it sends. Of one station the first is
// what goes on with volumes that were begun, oldest first (the end of a volume before the next
// volume's beginning: it is little, and would else wait as long as new chunks come), then the
// newest.
// Pure bookkeeping. Thread contract: one thread.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>

namespace stormcellar::daemon {

enum class Urgency : std::uint8_t { backlog, live };

class ReadyJobs {
  public:
    struct Key {
        Urgency urgency = Urgency::backlog;
        bool is_begun = false;       // goes on with a volume; live jobs alone
        std::int64_t newest_ns = 0;  // since the epoch
        std::uint64_t sequence = 0;  // tells all jobs apart; equal ones go by it
        std::string station;         // whose turn it takes; empty: that of all unknown ones
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
        bool is_new = false;
        std::int64_t order = 0;
        std::uint64_t sequence = 0;
        // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes a defaulted <=> for a null.
        auto operator<=>(const Rank&) const = default;
    };
    struct Station {
        std::uint64_t turn = 0;
        std::map<Rank, void*> jobs;
    };
    static Rank rank_of(const Key& key);
    void give_turn(const std::string& name, Station& station);

    std::size_t count_ = 0;
    std::uint64_t next_turn_ = 0;
    std::unordered_map<std::string, Station> stations_;  // those with live jobs
    std::map<std::uint64_t, std::string> turns_;
    struct OldJob {
        void* job = nullptr;
        std::string station;
    };
    using Backlog = std::map<Rank, OldJob>;
    [[nodiscard]] Backlog& backlog_of(const Key& key) {
        return key.station.empty() ? others_backlog_ : backlog_;
    }
    void* take_old(Backlog& backlog, const MayBegin& may_begin);
    Backlog backlog_, others_backlog_;  // of known stations, and of all else
};

}  // namespace stormcellar::daemon
