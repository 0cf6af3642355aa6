#include "daemon/work_shares.h"

#include <algorithm>

namespace stormcellar::daemon {

double WorkShares::owed(const Account& account, Time now) {
    const double passed_s = std::chrono::duration<double>(now - account.since).count();
    return std::max(0.0, account.owed_s - paid_back_each_second * std::max(0.0, passed_s));
}

bool WorkShares::may_begin(const std::string& station, Time now) const {
    const auto own = accounts_.find(station);
    if (own == accounts_.end() || !is_heavy(own->second, now)) return true;
    int heavy_running = 0;
    for (const auto& [name, account] : accounts_)
        heavy_running += is_heavy(account, now) ? account.running : 0;
    return heavy_running < std::max(1, workers_ - 1);
}

void WorkShares::begun(const std::string& station, Time now) {
    // What has paid back all and runs nothing needs no account.
    if (!accounts_.contains(station)) {
        std::erase_if(accounts_, [&](const auto& entry) {
            return entry.second.running == 0 && owed(entry.second, now) == 0;
        });
    }
    ++accounts_[station].running;
}

void WorkShares::ended(const std::string& station, Time::duration took, Time now) {
    const auto own = accounts_.find(station);
    if (own == accounts_.end()) return;
    Account& account = own->second;
    account.owed_s = owed(account, now) + std::chrono::duration<double>(took).count();
    account.since = now;
    account.running = std::max(0, account.running - 1);
}

}  // namespace stormcellar::daemon
