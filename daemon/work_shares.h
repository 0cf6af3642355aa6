// daemon/work_shares.h -- how many of the workers one station may have.
//
// A file decides how long its job takes, and a job is not interrupted. So the time that jobs of a
// station take is counted, and its debt goes down by a fifth of a second each second. A station
// that owes more than two seconds is heavy. Heavy stations together have all workers but one, and
// one at least: whoever sends files that take long never holds the last worker against others.
// A site of a real feed takes half a second every five minutes. All that no known station sends
// counts as one station.
// Pure bookkeeping. Thread contract: one thread.
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

    void set_workers(int workers) { workers_ = workers; }
    // Whether a job of the station (empty: of none that is known) may begin now.
    [[nodiscard]] bool may_begin(const std::string& station, Time now) const;
    void begun(const std::string& station, Time now);
    // One that has begun has ended after `took`.
    void ended(const std::string& station, Time::duration took, Time now);

  private:
    struct Account {
        double owed_s = 0;  // at `since`
        Time since{};
        int running = 0;
    };
    [[nodiscard]] static double owed(const Account& account, Time now);
    [[nodiscard]] static bool is_heavy(const Account& account, Time now) {
        return owed(account, now) > most_owed_s;
    }

    int workers_ = 1;
    std::unordered_map<std::string, Account> accounts_;
};

}  // namespace stormcellar::daemon
