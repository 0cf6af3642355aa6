// daemon/queue/work_shares.h -- how many workers one station may use.
//
// A file determines how long its job takes, and a job is not interrupted. So one worker is reserved
// for good stations: those of which a file was gridded, or showed a sweep, within the last hour.
// The time that a station's jobs take is counted as a debt, which falls by a fifth of a second each
// second; a station that owes more than two seconds is heavy. All heavy stations and all that are
// not good may together use all workers except one, and so may each station alone, but always at
// least one worker. So a sender of files that take long never holds the last worker against others.
// A site of a real feed takes half a second every five minutes. All files of no known station count
// as one station, which is never good. Pure bookkeeping. Thread contract: one thread.
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
    // Tells that a job ended after `took`. `is_good`: see above.
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

    // Returns true if the station may use the reserved worker.
    [[nodiscard]] bool is_light(const std::string& station, Time now) const;

    int workers_ = 1;
    std::unordered_map<std::string, Account> accounts_;
    std::unordered_map<std::string, int> running_;   // of stations that have any
    std::unordered_map<std::string, Time> good_at_;  // of known stations
};

}  // namespace stormcellar::daemon
