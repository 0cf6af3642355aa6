// daemon/queue/work_shares.h -- limits how many of the workers one station may use.
//
// A file determines how long its job takes, and a job is not interrupted. So one worker is reserved
// for light stations. A station is light if something good came from it within the last hour (one
// of its files was gridded or showed a sweep) and it has not used too much time. The time of its
// jobs is added to its debt, which decreases by a fifth of a second each second; a station that
// owes more than two seconds is not light. All stations that are not light share all workers but
// one. Each single station may also use at most all workers but one. If there is only one worker,
// it serves every station. So slow files can never keep the last worker from other stations. A site
// of a real feed takes half a second every five minutes. All unknown stations count as one station,
// which is never light. This class only keeps books.
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
    // Returns true if a job of the station (empty: no known station) may begin now.
    [[nodiscard]] bool may_begin(const std::string& station, Time now) const;
    void begun(const std::string& station, Time now);
    // Notes that a job of the station has ended after `took`. `is_good`: something was gridded or
    // shown.
    void ended(const std::string& station, Time::duration took, bool is_good, Time now);

  private:
    struct Account {
        double owed_s = 0;  // at `since`
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
