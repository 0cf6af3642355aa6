#include "daemon/queue/work_shares.h"

#include <algorithm>

namespace stormcellar::daemon {

double WorkShares::owed(const Account& account, Time now) {
    const double passed_s = std::chrono::duration<double>(now - account.since).count();
    return std::max(0.0, account.owed_s - paid_back_each_second * std::max(0.0, passed_s));
}

bool WorkShares::is_light(const std::string& station, Time now) const {
    const auto good = good_at_.find(station);
    if (good == good_at_.end() || now - good->second > good_for) return false;
    const auto own = accounts_.find(station);
    return own == accounts_.end() || !is_heavy(own->second, now);
}

bool WorkShares::may_begin(const std::string& station, Time now) const {
    if (workers_ <= 1) return true;
    const int most = workers_ - 1;
    const auto own = running_.find(station);
    if (own != running_.end() && own->second >= most) return false;
    if (is_light(station, now)) return true;
    int others = 0;
    for (const auto& [name, running] : running_)
        others += is_light(name, now) ? 0 : running;
    return others < most;
}

void WorkShares::begun(const std::string& station, Time now) {
    // Drop accounts without debt, because they have no effect.
    if (!accounts_.contains(station))
        std::erase_if(accounts_, [&](const auto& entry) { return owed(entry.second, now) == 0; });
    ++running_[station];
}

void WorkShares::ended(const std::string& station, Time::duration took, bool is_good, Time now) {
    if (is_good && !station.empty()) good_at_[station] = now;
    Account& account = accounts_[station];
    account.owed_s = owed(account, now) + std::chrono::duration<double>(took).count();
    account.since = now;
    const auto own = running_.find(station);
    if (own != running_.end() && --own->second <= 0) running_.erase(own);
}

}  // namespace stormcellar::daemon
