#include "cache/account.h"

#include <algorithm>

namespace stormcellar::cache {

void Account::set_now(UtcTime now) {
    now_ = now;
    while (!future_.empty() && believed(future_.begin()->first)) {
        const GridName name = future_.begin()->second;
        future_.erase(future_.begin());
        change(name, [&](Entry& entry) { entry.counted = name.time; });
    }
}

void Account::ask_who_is_known() {
    for (auto& [name, group] : groups_)
        set_known(group, is_known_(name));
}

void Account::ask_who_is_known(std::string_view group) {
    const auto found = groups_.find(group);
    if (found != groups_.end()) set_known(found->second, is_known_(group));
}

// Marks the group as known or not, and moves its grids to their new places in the orders of
// eviction.
void Account::set_known(Group& group, bool known) {
    if (group.known == known) return;
    group.known = known;
    for (Item& item : group.grids) {
        withdraw(group, item);
        item.second.known = known;
        enter(group, item);
    }
}

bool Account::is_known(std::string_view group) const {
    const Group* const found = group_of_name(group);
    return found != nullptr ? found->known : is_known_(group);
}

const Account::Group* Account::group_of_name(std::string_view group) const {
    const auto found = groups_.find(group);
    return found == groups_.end() ? nullptr : &found->second;
}

Account::Item* Account::find_item(const GridName& name) {
    const auto group = groups_.find(group_of(name.domain));
    if (group == groups_.end()) return nullptr;
    const auto item = group->second.grids.find(name);
    return item == group->second.grids.end() ? nullptr : &*item;
}

Account::Group& Account::group_to_fill(std::string_view name) {
    const auto [group, is_new] = groups_.try_emplace(std::string(name));
    if (is_new) group->second.known = is_known_(name);
    return group->second;
}

void Account::drop_if_empty(Groups::iterator group) {
    if (group->second.grids.empty() && group->second.used == 0) groups_.erase(group);
}

void Account::enter(Group& group, Item& item) {
    if (!item.second.may_go()) return;
    group.order.insert(&item);
    order_.insert(&item);
}

void Account::withdraw(Group& group, Item& item) {
    group.order.erase(&item);
    order_.erase(&item);
}

void Account::count(Group& group, const Item& item, bool add) {
    const auto apply = [add](auto& total, auto amount) {
        total = add ? total + amount : total - amount;
    };
    const Entry& entry = item.second;
    apply(group.used, entry.facts.bytes);
    apply(used_, entry.facts.bytes);
    apply(grids_, std::size_t{1});
    if (entry.facts.pinned) apply(pinned_, std::size_t{1});
    if (!entry.leaving) return;
    apply(group.leaving, entry.facts.bytes);
    apply(leaving_, entry.facts.bytes);
}

// Changes an entry, and updates its place in the orders of eviction and its share of the sums.
template <class Change>
void Account::change(const GridName& name, Change what) {
    Item* const item = find_item(name);
    if (item == nullptr) return;
    Group& group = groups_.find(group_of(name.domain))->second;
    withdraw(group, *item);
    count(group, *item, false);
    what(item->second);
    count(group, *item, true);
    enter(group, *item);
}

void Account::put(const GridName& name, const GridFacts& facts) {
    erase(name);
    Group& group = group_to_fill(group_of(name.domain));
    Entry entry;
    entry.facts = facts;
    entry.known = group.known;
    entry.counted = believed(name.time) ? name.time : facts.written;
    Item& item = *group.grids.emplace(name, entry).first;
    count(group, item, true);
    enter(group, item);
    if (!believed(name.time)) future_.emplace(name.time, name);
}

void Account::erase(const GridName& name) {
    Item* const item = find_item(name);
    if (item == nullptr) return;
    const auto found = groups_.find(group_of(name.domain));
    Group& group = found->second;
    withdraw(group, *item);
    count(group, *item, false);
    future_.erase({name.time, name});
    group.grids.erase(name);
    drop_if_empty(found);
}

const GridFacts* Account::find(const GridName& name) const {
    const Group* const group = group_of_name(group_of(name.domain));
    if (group == nullptr) return nullptr;
    const auto item = group->grids.find(name);
    return item == group->grids.end() ? nullptr : &item->second.facts;
}

bool Account::is_busy(const GridName& name) const {
    const Group* const group = group_of_name(group_of(name.domain));
    if (group == nullptr) return false;
    const auto item = group->grids.find(name);
    return item != group->grids.end() && item->second.busy;
}

void Account::set_pinned(const GridName& name) {
    change(name, [](Entry& entry) {
        entry.facts.pinned = true;
        entry.busy = entry.leaving = false;
    });
}

void Account::set_busy(const GridName& name) {
    change(name, [](Entry& entry) { entry.busy = true; });
}

void Account::set_leaving(const GridName& name) {
    change(name, [](Entry& entry) { entry.busy = entry.leaving = true; });
}

void Account::set_stuck(const GridName& name) {
    change(name, [](Entry& entry) {
        entry.stuck = true;
        entry.busy = entry.leaving = false;
    });
}

std::vector<GridName> Account::names(const std::string& domain, level2::Moment moment, UtcTime from,
                                     UtcTime to) const {
    std::vector<GridName> found;
    const Group* const group = group_of_name(group_of(domain));
    if (group == nullptr) return found;
    const auto end = group->grids.upper_bound({domain, moment, to});
    for (auto item = group->grids.lower_bound({domain, moment, from}); item != end; ++item)
        found.push_back(item->first);
    return found;
}

void Account::reserve(std::string_view group, std::uint64_t bytes) {
    if (bytes == 0) return;
    group_to_fill(group).used += bytes;
    used_ += bytes;
}

void Account::release(std::string_view group, std::uint64_t bytes) {
    if (bytes == 0) return;
    const auto found = groups_.find(group);
    found->second.used -= bytes;
    used_ -= bytes;
    drop_if_empty(found);
}

std::uint64_t Account::used(std::string_view group) const {
    const Group* const found = group_of_name(group);
    return found == nullptr ? 0 : found->used;
}

std::uint64_t Account::used_by_others() const {
    std::uint64_t used = 0;
    for (const auto& [name, group] : groups_)
        if (!group.known) used += group.used;
    return used;
}

std::vector<std::string> Account::groups() const {
    std::vector<std::string> names;
    for (const auto& [name, group] : groups_)
        names.push_back(name);
    return names;
}

}  // namespace stormcellar::cache
