#include "cache/evict.h"

#include <algorithm>
#include <map>
#include <set>

#include "cache/account.h"
#include "cache/pins.h"

namespace stormcellar::cache {
namespace {

bool is_meant(const std::string& domain, const std::string& wanted) {
    return wanted.empty() || domain == wanted || group_of(domain) == wanted;
}

}  // namespace

Result<EvictionPlan> plan_eviction(const StoreReader& store, const EvictionOrder& order,
                                   UtcTime now) {
    EvictionPlan plan;
    Account account;
    account.set_now(now);
    std::map<GridName, StoreEntry> entries;
    std::set<GridName> chosen;
    const auto domains = store.domains();
    if (!domains) return pass_on(domains);
    for (const std::string& domain : *domains) {
        if (!is_meant(domain, order.domain)) continue;
        for (const level2::Moment moment : level2::all_moments) {
            const auto list = store.list(domain, moment, std::nullopt, std::nullopt);
            if (!list) return pass_on(list);
            for (const StoreEntry& entry : *list) {
                const GridName name{domain, moment, entry.time};
                entries.emplace(name, entry);
                account.put(name, {entry.bytes_on_disk, now, entry.pinned});
                if (!entry.pinned && order.to && entry.time <= *order.to) chosen.insert(name);
            }
        }
    }
    plan.looked_at = account.grid_count();
    plan.pinned = account.pinned_count();
    if (order.older_than) {
        Budgets budgets;
        budgets.total.age = order.older_than;
        for (const std::string& group : account.groups()) {
            for (GridName& name : account.expired(group, budgets, account.grid_count()))
                chosen.insert(std::move(name));
        }
    }
    for (const GridName& name : chosen)
        account.erase(name);
    if (order.bytes) {
        for (GridName& name : account.down_to("", *order.bytes, account.grid_count())) {
            account.erase(name);
            chosen.insert(std::move(name));
        }
    }
    plan.bytes_left = account.used();
    for (const GridName& name : chosen)
        plan.victims.push_back(entries.at(name));
    std::stable_sort(plan.victims.begin(), plan.victims.end(),
                     [](const StoreEntry& a, const StoreEntry& b) { return a.time < b.time; });
    return plan;
}

EvictionReport evict(FileSystem& file_system, const std::vector<StoreEntry>& victims) {
    EvictionReport report;
    std::set<std::filesystem::path> days;
    for (const StoreEntry& victim : victims) {
        const auto outcome = evict_grid(file_system, victim.path);
        if (!outcome) report.problems.push_back(outcome.error().message);
        if (!outcome || *outcome != Evicted::gone) continue;
        report.evicted.push_back(victim);
        days.insert(victim.path.parent_path());
    }
    for (const auto& day : days) {
        const Status synced = file_system.sync_directory(day);
        if (!synced && synced.error().code != ErrorCode::not_found) {
            report.problems.push_back(synced.error().message);
        }
        remove_empty_directories(day);
    }
    return report;
}

}  // namespace stormcellar::cache
