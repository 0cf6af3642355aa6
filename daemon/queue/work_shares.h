// daemon/queue/work_shares.h -- limits how many workers a station may use.
//
// A job cannot be interrupted, and its file determines how long it takes. To keep slow files from
// occupying all workers, one worker is reserved for light stations. A station is light if one of
// its files was gridded or showed a sweep within the last hour, and if its debt is at most two
// seconds. Each job adds the time that it took to the debt of its station. The debt decreases by a
// fifth of a second each second. (A site of a real feed takes half a second every five minutes.)
// All other stations together use at most all workers but one. A single light station also uses at
// most all workers but one. If there is only one worker, it serves every station. All unknown
// stations count as one station, which is never light. This class only counts; it runs nothing.
//
// Threads   One thread at a time.
#pragma once

#include <chrono>
#include <string>
#include <unordered_map>

namespace stormcellar::daemon {

class WorkShares {
  public:
    using Time = std::chrono::steady_clock::time_point;
    static constexpr double paid_back_each_second = 0.2;
    static constexpr double most_owed_s = 2;
    static constexpr std::chrono::hours good_for{1};

    void set_workers(int workers) { workers_ = workers; }
    // Returns true if a job of the station (empty: an unknown station) may begin now.
    [[nodiscard]] bool may_begin(const std::string& station, Time now) const;
    void begun(const std::string& station, Time now);
    // Notes that a job of the station has ended and took the time `took`. `is_good` is true if the
    // job gridded or showed data.
    void ended(const std::string& station, Time::duration took, bool is_good, Time now);

  private:
    struct Account {
        double owed_s = 0;  // debt at the time `since`
        Time since{};
    };
    [[nodiscard]] static double owed(const Account& account, Time now);
    [[nodiscard]] static bool is_heavy(const Account& account, Time now) {
        return owed(account, now) > most_owed_s;
    }

    // Returns true if the reserved worker may serve the station.
    [[nodiscard]] bool is_light(const std::string& station, Time now) const;

    int workers_ = 1;
    std::unordered_map<std::string, Account> accounts_;
    std::unordered_map<std::string, int> running_;   // stations with running jobs
    std::unordered_map<std::string, Time> good_at_;  // of known stations
};

}  // namespace stormcellar::daemon
