// daemon/queue/ready_jobs.h -- chooses the job that runs next among the jobs that are ready.
//
// A job is LIVE if its file changed while we watched, or less than ten minutes ago. All other jobs
// are the BACKLOG. There are four classes of live jobs. In each round, a class gets this many
// turns:
//   going on   known station; sweeps of the volume have closed           8
//   fresh      other files of known stations, reported by an event       4
//   found      other files of known stations, found by a scan or a poll  1
//   others     no known station                                          1
// A job of the backlog runs if no live job may begin: first files of known stations, then other
// files, each newest first. While live jobs wait, the backlog of known stations gets one turn in
// seventeen. So a flood of new volumes does not delay a volume that is going on, unknown names do
// not delay known stations, and every class of live jobs makes progress.
//
// Within a class of live jobs, stations take turns: after its turn, a station goes to the end of
// the line. So no station can hold up another, however much it sends. In the class "going on", the
// jobs of a station run oldest first, so that the end of a volume comes before sweeps of the next
// volume. Ingesting the end is little work. If the newest jobs ran first, the end would wait as
// long as new chunks arrive. All other jobs run newest first. ReadyJobs only keeps the order; it
// runs nothing.
//
// Threads   One thread at a time.
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
        bool is_begun = false;       // class "going on"; only for live jobs
        std::int64_t newest_ns = 0;  // since the epoch
        std::uint64_t sequence = 0;  // different for all jobs; breaks ties
        // The station whose turn the job takes; empty for all unknown stations.
        std::string station;
        bool is_told = true;  // an event reported the file; only for live jobs
    };

    void add(const Key& key, void* job);
    // Replaces the key of a job in one step. So a station keeps its place in line even if this is
    // its only job.
    void replace(const Key& old, const Key& key, void* job);
    void remove(const Key& key);
    // Removes and returns the next job whose station passes `may_begin` (null: every station).
    // Returns null if there is no such job. Looks at no more than most_looked_at jobs of each
    // backlog.
    using MayBegin = std::function<bool(const std::string& station)>;
    static constexpr int most_looked_at = 64;
    void* take_next(const MayBegin& may_begin = {});
    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] std::size_t count() const { return count_; }

  private:
    // Sort key; smaller ranks come first.
    struct Rank {
        std::int64_t order = 0;
        std::uint64_t sequence = 0;
        // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 mistakes a defaulted <=> for a null.
        auto operator<=>(const Rank&) const = default;
    };
    struct Station {
        std::uint64_t turn = 0;
        std::map<Rank, void*> jobs;
    };
    // The live jobs of one class.
    struct Turns {
        std::unordered_map<std::string, Station> stations;  // only stations that have jobs
        std::map<std::uint64_t, std::string> turns;
        int left = 0;  // turns left in this round
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
    int live_since_old_ = 0;  // live jobs taken in a row while the backlog waited
    std::uint64_t next_turn_ = 0;
    std::array<Turns, 4> live_;
    Backlog backlog_, others_backlog_;  // of known stations, and of all other stations
};

}  // namespace stormcellar::daemon
