// Finds the account's newest and protected grids, and chooses the grids to evict.
#include <algorithm>

#include "cache/account.h"

namespace stormcellar::cache {
namespace {

constexpr std::uint64_t others_part = 10;    // others hold at most a tenth of the space
constexpr std::uint64_t protected_part = 2;  // protected grids hold at most half of the space

}  // namespace

const Account::Item* Account::newest_of(const Group& group, const std::string& domain,
                                        level2::Moment moment) const {
    for (const UtcTime limit : {now_ + tolerated_future, last_possible_time}) {
        const auto after = group.grids.upper_bound({domain, moment, limit});
        if (after == group.grids.begin()) continue;
        const Item& last = *std::prev(after);
        if (last.first.domain == domain && last.first.moment == moment) return &last;
    }
    return nullptr;
}

// Jumps from one domain and moment to the next, because there are few of these, but many grids.
template <class Visit>
void Account::for_each_newest(const Group& group, Visit visit) const {
    for (auto item = group.grids.begin(); item != group.grids.end();) {
        const GridName& first = item->first;
        if (const Item* const newest = newest_of(group, first.domain, first.moment)) visit(*newest);
        item = group.grids.upper_bound({first.domain, first.moment, UtcTime::max()});
    }
}

std::optional<UtcTime> Account::newest(std::string_view group) const {
    const Group* const found = group_of_name(group);
    std::optional<UtcTime> newest;
    if (found == nullptr) return newest;
    for_each_newest(*found, [&](const Item& item) {
        const UtcTime time = item.first.time;
        if (believed(time) && (!newest || time > *newest)) newest = time;
    });
    return newest;
}

bool Account::is_newest(const GridName& name) const {
    const Group* const group = group_of_name(group_of(name.domain));
    if (group == nullptr) return true;
    const Item* const item = newest_of(*group, name.domain, name.moment);
    if (item == nullptr) return true;
    const UtcTime newest = item->first.time;
    // A grid with a believable time counts as newer than every grid without a believable time.
    if (believed(name.time) != believed(newest)) return believed(name.time);
    return name.time >= newest;
}

bool Account::is_to_stay(const GridName& name) const {
    if (!is_known(group_of(name.domain))) return false;
    const GridFacts* const facts = find(name);
    return (facts != nullptr && facts->pinned) || is_newest(name);
}

bool Account::is_younger(const Item& item, std::chrono::milliseconds age) const {
    return age == age.zero() || item.second.facts.written > now_ - age;
}

bool Account::is_protected(const Item& item, std::chrono::milliseconds age) const {
    return item.second.known && is_younger(item, age) && is_newest(item.first);
}

// Returns the grids that lose their protection because protected grids would hold too much space.
// The smallest grids keep their protection, so that as many grids as possible have it. A pinned
// grid needs no protection.
std::set<const Account::Item*> Account::lapsed(const Group* group,
                                               const Protection& protection) const {
    std::vector<const Item*> items;
    const auto add = [&](const Item& item) {
        if (!item.second.facts.pinned && is_younger(item, protection.age)) items.push_back(&item);
    };
    if (group != nullptr) {
        for_each_newest(*group, add);
    } else {
        for (const auto& [name, one] : groups_)
            if (one.known) for_each_newest(one, add);
    }
    std::sort(items.begin(), items.end(), [](const Item* a, const Item* b) {
        const std::uint64_t first = a->second.facts.bytes, second = b->second.facts.bytes;
        return first != second ? first < second : ByAge{}(b, a);
    });
    const std::uint64_t most = *protection.space / protected_part;
    std::uint64_t held = 0;
    const auto first = std::find_if(items.begin(), items.end(), [&](const Item* item) {
        held += item->second.facts.bytes;
        return held > most;
    });
    return {first, items.end()};
}

// Tells which grids are protected from one limit: the limit of a group, or the total limit. It is
// rare that a protected grid comes up for eviction. Only then does this class find the grids that
// lose their protection.
class Account::Shield {
  public:
    Shield(const Account& account, const Group* group, const Protection& protection)
        : account_(account), group_(group), protection_(protection) {}
    bool covers(const Item& item) {
        if (!account_.is_protected(item, protection_.age)) return false;
        if (!protection_.space) return true;
        if (!lapsed_) lapsed_ = account_.lapsed(group_, protection_);
        return !lapsed_->contains(&item);
    }

  private:
    const Account& account_;
    const Group* group_;  // null: all groups
    const Protection protection_;
    std::optional<std::set<const Item*>> lapsed_;
};

UtcTime Account::counted_if_written_now(const GridName& name) const {
    if (believed(name.time)) return name.time;
    const GridFacts* const facts = find(name);
    return facts == nullptr ? now_ : facts->written;
}

bool Account::is_expired(const GridName& name, const Budgets& budgets) const {
    const std::string_view group = group_of(name.domain);
    const auto age = budgets.age_of(group);
    const auto last = newest(group);
    if (!age || !last) return false;
    const GridFacts* const facts = find(name);
    if (facts != nullptr && facts->pinned) return false;
    if (counted_if_written_now(name) >= *last - *age) return false;
    return is_part(name.domain) || !is_known(group) || !is_newest(name);
}

std::optional<std::uint64_t> Account::space_of(const Budget& budget) const {
    std::optional<std::uint64_t> space = budget.bytes;
    if (budget.file_system_percent && capacity_ > 0) {
        const auto allowed = static_cast<std::uint64_t>(static_cast<double>(capacity_) *
                                                        *budget.file_system_percent / 100);
        space = std::min(space.value_or(allowed), allowed);
    }
    return space;
}

std::optional<std::uint64_t> Account::others_limit(const Budgets& budgets) const {
    auto limit = space_of(budgets.total);
    if (limit) *limit /= others_part;
    return limit;
}

bool Account::fits(std::string_view group, std::uint64_t bytes, const Budgets& budgets) const {
    const auto within = [bytes](std::uint64_t used, const std::optional<std::uint64_t>& limit) {
        return !limit || (bytes <= *limit && used <= *limit - bytes);
    };
    return within(used(group), budgets.of(group).bytes) && within(used_, budgets.total.bytes) &&
           (is_known(group) || within(used_by_others(), others_limit(budgets)));
}

// Returns the end of the grids in `order` that may be evicted for a grid of this name. A grid of
// others may only replace grids of others.
Account::Order::const_iterator Account::end_for(const Order& order, const GridName& name) const {
    if (is_to_stay(name)) return order.end();
    const bool known = is_known(group_of(name.domain));
    return order.lower_bound(ByAge::Key{known, counted_if_written_now(name), &name});
}

std::optional<std::vector<GridName>> Account::room_for(const GridName& name, std::uint64_t bytes,
                                                       const Budgets& budgets, Reach reach) const {
    const std::string_view group_name = group_of(name.domain);
    const Budget& own = budgets.of(group_name);
    const Group* const group = group_of_name(group_name);
    std::set<const Item*> chosen;
    std::vector<GridName> victims;
    std::uint64_t freed = 0;
    // Chooses grids from `order` until `used` plus `bytes` is within the limit.
    const auto choose = [&](const Order& order, std::uint64_t used,
                            const std::optional<std::uint64_t>& limit, Shield shield) {
        if (!limit) return true;
        if (bytes > *limit) return false;
        const auto end = end_for(order, name);
        for (auto item = order.begin(); used - freed > *limit - bytes; ++item) {
            if (item == end) return false;
            if ((*item)->first == name) continue;
            if (reach != Reach::all && shield.covers(**item)) continue;
            if (!chosen.insert(*item).second) continue;
            freed += (*item)->second.facts.bytes;
            victims.push_back((*item)->first);
        }
        return true;
    };
    const Shield of_group(*this, group, {budgets.protected_for, space_of(own)});
    const Shield of_all(*this, nullptr, {budgets.protected_for, space_of(budgets.total)});
    if (group == nullptr && bytes > own.bytes.value_or(bytes)) return std::nullopt;
    if (group != nullptr &&
        !choose(group->order, group->used - group->leaving, own.bytes, of_group)) {
        return std::nullopt;
    }
    if (!is_known(group_name) &&
        !choose(order_, staying_of_others(), others_limit(budgets), of_all)) {
        return std::nullopt;
    }
    if (!choose(order_, used_ - leaving_, budgets.total.bytes, of_all)) return std::nullopt;
    return victims;
}

std::vector<GridName> Account::oldest(const GridName& name, std::uint64_t bytes,
                                      const Budgets& budgets) const {
    std::vector<GridName> victims;
    const std::string_view group_name = group_of(name.domain);
    const Group* const group = group_of_name(group_name);
    const bool of_all = budgets.total.limits_space();
    if (!of_all && group == nullptr) return victims;
    const Order& order = of_all ? order_ : group->order;
    Shield shield(
        *this, of_all ? nullptr : group,
        {budgets.protected_for, space_of(of_all ? budgets.total : budgets.of(group_name))});
    std::uint64_t freed = 0;
    const auto end = end_for(order, name);
    for (auto item = order.begin(); item != end && freed < bytes; ++item) {
        if ((*item)->first == name || shield.covers(**item)) continue;
        freed += (*item)->second.facts.bytes;
        victims.push_back((*item)->first);
    }
    return victims;
}

std::vector<GridName> Account::down_to(std::string_view group, std::uint64_t bytes,
                                       std::size_t most, const Protection& protection,
                                       Reach reach) const {
    std::vector<GridName> victims;
    const Group* const found = group.empty() ? nullptr : group_of_name(group);
    if (!group.empty() && found == nullptr) return victims;
    const Order& order = found == nullptr ? order_ : found->order;
    Shield shield(*this, found, protection);
    std::uint64_t held = found == nullptr ? used_ - leaving_ : found->used - found->leaving;
    for (const Item* item : order) {
        if (held <= bytes || victims.size() == most) break;
        if (reach == Reach::others && item->second.known) break;
        if (reach != Reach::all && shield.covers(*item)) continue;
        held -= item->second.facts.bytes;
        victims.push_back(item->first);
    }
    return victims;
}

std::uint64_t Account::staying_of_others() const {
    std::uint64_t staying = 0;
    for (const auto& [name, group] : groups_)
        if (!group.known) staying += group.used - group.leaving;
    return staying;
}

std::vector<GridName> Account::others_down_to(std::uint64_t bytes, std::size_t most) const {
    std::vector<GridName> victims;
    std::uint64_t held = staying_of_others();
    for (const Item* item : order_) {
        if (held <= bytes || victims.size() == most || item->second.known) break;
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
        if (is_part(item->first.domain) || !is_protected(*item, budgets.protected_for))
            victims.push_back(item->first);
    }
    return victims;
}

// If a wrong clock wrote a file far in the future, the file counts as written long ago.
std::vector<GridName> Account::outlived(const Budgets& budgets, std::size_t most) const {
    std::vector<GridName> victims;
    const auto age = budgets.protected_for;
    if (age == age.zero()) return victims;
    for (const Item* item : order_) {
        if (victims.size() == most || item->second.known) break;
        const UtcTime written = item->second.facts.written;
        if (written <= now_ - age || written > now_ + age) victims.push_back(item->first);
    }
    return victims;
}

}  // namespace stormcellar::cache
