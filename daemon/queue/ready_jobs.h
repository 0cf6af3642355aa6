// daemon/queue/ready_jobs.h -- which of the jobs that may run is the next.
//
// A job is LIVE if its file changed while the service watched, or less than ten minutes ago; all
// others are BACKLOG. There are four classes of live jobs; in a round each class has as many turns
// as the number behind it:
//   going on   of a known station, of a volume with closed sweeps          8
//   fresh      other jobs of a known station that an event reported        4
//   found      other jobs of a known station that a scan or a poll found   1
//   others     of no known station                                         1
// The backlog of known stations, and then that of others, each newest first, runs when no live job
// waits. While live jobs wait, the backlog of known stations has one turn in seventeen. So a flood
// of beginnings delays no volume that goes on, a flood of unknown names delays no known station,
// and no class stands still. Within a class stations take turns. The station comes first that was
// served longest ago, or has waited longest, so that no station can delay another, however much it
// sends. Within a station, jobs that go on run oldest first: the end of a volume comes before the
// next volume's sweeps, takes little time, and would otherwise wait as long as new chunks come. All
// other jobs run newest first. Pure bookkeeping. Thread contract: one thread.
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
        bool is_begun = false;       // of a volume that goes on; only for live jobs
        std::int64_t newest_ns = 0;  // since the epoch
        std::uint64_t sequence = 0;  // differs for all jobs; breaks ties
        std::string station;  // whose turn the job takes; empty: that of all unknown stations
        bool is_told = true;  // an event reported it; only for live jobs
    };

    void add(const Key& key, void* job);
    // Replaces a job in one step, so that a station whose only job is merged keeps its turn.
    void replace(const Key& old, const Key& key, void* job);
    void remove(const Key& key);
    // The next job, among stations for which `may_begin` is true (null: all); null if there is
    // none. It looks at no more of the backlog than most_looked_at.
    using MayBegin = std::function<bool(const std::string& station)>;
    static constexpr int most_looked_at = 64;
    void* take_next(const MayBegin& may_begin = {});
    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] std::size_t count() const { return count_; }

  private:
    // In order: the job that comes first is less.
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
    // The live jobs of one class.
    struct Turns {
        std::unordered_map<std::string, Station> stations;  // those with jobs
        std::map<std::uint64_t, std::string> turns;
        int left = 0;  // turns in this round
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
    int live_since_old_ = 0;  // live jobs that were taken while a backlog waited
    std::uint64_t next_turn_ = 0;
    std::array<Turns, 4> live_;
    Backlog backlog_, others_backlog_;  // of known stations, and of all others
};

}  // namespace stormcellar::daemon
