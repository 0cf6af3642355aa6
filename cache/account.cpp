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

// Whatever changes of an entry: its place in the orders and its share of the sums follow.
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
    Group& group = groups_[std::string(group_of(name.domain))];
    Entry entry;
    entry.facts = facts;
    entry.counted = believed(name.time) ? name.time : facts.written;
    Item& item = *group.grids.emplace(name, entry).first;
    count(group, item, true);
    enter(group, item);
    if (!believed(name.time)) future_.emplace(name.time, name);
}

void Account::erase(const GridName& name) {
    Item* const item = find_item(name);
    if (item == nullptr) return;
    Group& group = groups_.find(group_of(name.domain))->second;
    withdraw(group, *item);
    count(group, *item, false);
    future_.erase({name.time, name});
    group.grids.erase(name);
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
    groups_[std::string(group)].used += bytes;
    used_ += bytes;
}

void Account::release(std::string_view group, std::uint64_t bytes) {
    groups_[std::string(group)].used -= bytes;
    used_ -= bytes;
}

std::uint64_t Account::used(std::string_view group) const {
    const Group* const found = group_of_name(group);
    return found == nullptr ? 0 : found->used;
}

std::vector<std::string> Account::groups() const {
    std::vector<std::string> names;
    for (const auto& [name, group] : groups_)
        names.push_back(name);
    return names;
}

// The newest believed; where none is, the newest of all.
std::optional<UtcTime> Account::newest_of(const Group& group, const std::string& domain,
                                          level2::Moment moment) const {
    const auto of_these = [&](auto item) {
        return item->first.domain == domain && item->first.moment == moment;
    };
    for (const UtcTime limit : {now_ + tolerated_future, last_possible_time}) {
        const auto after = group.grids.upper_bound({domain, moment, limit});
        if (after != group.grids.begin() && of_these(std::prev(after))) {
            return std::prev(after)->first.time;
        }
    }
    return std::nullopt;
}

std::optional<UtcTime> Account::newest(std::string_view group) const {
    const Group* const found = group_of_name(group);
    std::optional<UtcTime> newest;
    if (found == nullptr) return newest;
    // From one domain and moment to the next: few, however many grids there are.
    for (auto item = found->grids.begin(); item != found->grids.end();) {
        const GridName& first = item->first;
        const auto time = newest_of(*found, first.domain, first.moment);
        if (time && believed(*time) && (!newest || *time > *newest)) newest = time;
        item = found->grids.upper_bound({first.domain, first.moment, UtcTime::max()});
    }
    return newest;
}

bool Account::is_newest(const GridName& name) const {
    const Group* const group = group_of_name(group_of(name.domain));
    if (group == nullptr) return true;
    const auto newest = newest_of(*group, name.domain, name.moment);
    if (!newest) return true;
    // One that is believed is newer than any that is not.
    if (believed(name.time) != believed(*newest)) return believed(name.time);
    return name.time >= *newest;
}

bool Account::is_to_stay(const GridName& name) const {
    const GridFacts* const facts = find(name);
    return (facts != nullptr && facts->pinned) || is_newest(name);
}

bool Account::is_protected(const Item& item) const {
    return is_newest(item.first);
}

bool Account::is_expired(const GridName& name, const Budgets& budgets) const {
    const std::string_view group = group_of(name.domain);
    const auto age = budgets.age_of(group);
    const auto last = newest(group);
    if (!age || !last) return false;
    const GridFacts* const facts = find(name);
    if (facts != nullptr && facts->pinned) return false;
    const UtcTime counted = believed(name.time) ? name.time
                            : facts == nullptr  ? now_
                                                : facts->written;
    return counted < *last - *age && (is_part(name.domain) || !is_newest(name));
}

bool Account::fits(std::string_view group, std::uint64_t bytes, const Budgets& budgets) const {
    const auto within = [bytes](std::uint64_t used, const Budget& budget) {
        return !budget.bytes || (bytes <= *budget.bytes && used <= *budget.bytes - bytes);
    };
    return within(used(group), budgets.of(group)) && within(used_, budgets.total);
}

Account::Order::const_iterator Account::end_for(const Order& order, const GridName& name) const {
    if (is_to_stay(name)) return order.end();
    const GridFacts* const facts = find(name);
    const UtcTime counted = believed(name.time) ? name.time
                            : facts == nullptr  ? now_
                                                : facts->written;
    return order.lower_bound(ByAge::Key{counted, &name});
}

std::optional<std::vector<GridName>> Account::room_for(const GridName& name, std::uint64_t bytes,
                                                       const Budgets& budgets) const {
    const std::string_view group_name = group_of(name.domain);
    const Group* const group = group_of_name(group_name);
    std::set<const Item*> chosen;
    std::vector<GridName> victims;
    std::uint64_t freed = 0;
    // Takes from `order` until `used` and `bytes` are within the limit.
    const auto choose = [&](const Order& order, std::uint64_t used,
                            const std::optional<std::uint64_t>& limit) {
        if (!limit) return true;
        if (bytes > *limit) return false;
        const auto end = end_for(order, name);
        for (auto item = order.begin(); used - freed > *limit - bytes; ++item) {
            if (item == end) return false;
            if ((*item)->first == name || is_protected(**item)) continue;
            if (!chosen.insert(*item).second) continue;
            freed += (*item)->second.facts.bytes;
            victims.push_back((*item)->first);
        }
        return true;
    };
    if (group != nullptr &&
        !choose(group->order, group->used - group->leaving, budgets.of(group_name).bytes)) {
        return std::nullopt;
    }
    if (group == nullptr && bytes > budgets.of(group_name).bytes.value_or(bytes)) {
        return std::nullopt;
    }
    if (!choose(order_, used_ - leaving_, budgets.total.bytes)) return std::nullopt;
    return victims;
}

std::vector<GridName> Account::oldest(const GridName& name, std::uint64_t bytes,
                                      const Budgets& budgets) const {
    std::vector<GridName> victims;
    const Group* const group = group_of_name(group_of(name.domain));
    const bool of_all = budgets.total.limits_space();
    if (!of_all && group == nullptr) return victims;
    const Order& order = of_all ? order_ : group->order;
    std::uint64_t freed = 0;
    const auto end = end_for(order, name);
    for (auto item = order.begin(); item != end && freed < bytes; ++item) {
        if ((*item)->first == name || is_protected(**item)) continue;
        freed += (*item)->second.facts.bytes;
        victims.push_back((*item)->first);
    }
    return victims;
}

std::vector<GridName> Account::down_to(std::string_view group, std::uint64_t bytes,
                                       std::size_t most) const {
    std::vector<GridName> victims;
    const Group* const found = group.empty() ? nullptr : group_of_name(group);
    if (!group.empty() && found == nullptr) return victims;
    const Order& order = found == nullptr ? order_ : found->order;
    std::uint64_t held = found == nullptr ? used_ - leaving_ : found->used - found->leaving;
    for (const Item* item : order) {
        if (held <= bytes || victims.size() == most) break;
        if (is_protected(*item)) continue;
        held -= item->second.facts.bytes;
        victims.push_back(item->first);
    }
    return victims;
}

std::vector<GridName> Account::expired(std::string_view group, const Budgets& budgets,
                                       std::size_t most) const {
    std::vector<GridName> victims;
    const Group* const found = group_of_name(group);
    const auto age = budgets.age_of(group);
    const auto last = newest(group);
    if (found == nullptr || !age || !last) return victims;
    for (const Item* item : found->order) {
        if (item->second.counted >= *last - *age || victims.size() == most) break;
        if (is_part(item->first.domain) || !is_protected(*item)) victims.push_back(item->first);
    }
    return victims;
}

}  // namespace stormcellar::cache
