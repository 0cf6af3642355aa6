// daemon/queue/work_shares.h -- how many of the workers one station may have.
//
// A file decides how long its job takes, and a job is not interrupted. So one worker is kept for
// stations of which something good has come: within the last hour one of their files was gridded,
// or showed a sweep. And the time that jobs of a station take is counted; its debt goes down by a
// fifth of a second each second, and a station that owes more than two seconds is heavy. Heavy
// stations and those of which nothing good has come have together all workers but one, and so has
// each station alone, but one worker at least: whoever sends files that take long never holds the
// last worker against others. A site of a real feed takes half a second every five minutes. All
// that no known station sends counts as one station, of which nothing is good. Pure bookkeeping.
// Thread contract: one thread.
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
    // Whether a job of the station (empty: of none that is known) may begin now.
    [[nodiscard]] bool may_begin(const std::string& station, Time now) const;
    void begun(const std::string& station, Time now);
    // One that has begun has ended after `took`. `is_good`: see above.
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

    // Has a worker of its own to hope for.
    [[nodiscard]] bool is_light(const std::string& station, Time now) const;

    int workers_ = 1;
    std::unordered_map<std::string, Account> accounts_;
    std::unordered_map<std::string, int> running_;   // of those that have any
    std::unordered_map<std::string, Time> good_at_;  // of known stations
};

}  // namespace stormcellar::daemon
