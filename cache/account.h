// cache/account.h -- records the contents of the cache, and chooses the grids to evict. Used only
// inside the cache room.
//
// An account reads no file and no clock. Grids are evicted in the order of their times. If the time
// of a grid is more than 10 minutes in the future, the time at which its file was written counts
// instead, so that a radar with a wrong clock cannot fill the cache with grids that never grow old.
// "Grids of others" are grids whose group is not known (stormcellar/cache/budget.h). They are all
// evicted before any grid of a known group. A grid is not chosen while it is pinned, busy (being
// written or evicted), stuck (it could not be removed), or protected.
//
// Threads   One thread at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "stormcellar/cache/budget.h"
#include "stormcellar/cache/grid_name.h"

namespace stormcellar::cache {

struct GridFacts {
    std::uint64_t bytes = 0;  // on disk
    UtcTime written;
    bool pinned = false;
};

// The grids from which to choose.
enum class Reach {
    others,       // grids of groups that are not known
    unprotected,  // also unprotected grids of known groups
    all,          // also protected grids
};

// The conditions under which a limit spares the newest grids.
struct Protection {
    // Spares grids written less than this ago; 0: spares them whenever they were written.
    std::chrono::milliseconds age{};
    std::optional<std::uint64_t> space;  // spares at most half of this space; none: no limit
};

class Account {
  public:
    using IsKnown = std::function<bool(std::string_view group)>;

    explicit Account(IsKnown is_known = is_known_group) : is_known_(std::move(is_known)) {}

    // Sets the current time. This may make the times of more grids believable (is_believed()).
    void set_now(UtcTime now);
    // Sets the size of the file system, for budgets in percent; 0: unknown.
    void set_capacity(std::uint64_t bytes) { capacity_ = bytes; }
    // Asks `is_known` again about one group, or about all groups. Otherwise the account asks once
    // for each group, when the group's first grid comes.
    void ask_who_is_known();
    void ask_who_is_known(std::string_view group);
    [[nodiscard]] bool is_known(std::string_view group) const;

    // Adds the grid, or replaces its facts. Afterward the grid is neither busy nor stuck.
    void put(const GridName& name, const GridFacts& facts);
    void erase(const GridName& name);
    [[nodiscard]] const GridFacts* find(const GridName& name) const;
    [[nodiscard]] bool is_busy(const GridName& name) const;
    void set_pinned(const GridName& name);
    void set_busy(const GridName& name);     // not chosen until put() or erase()
    void set_leaving(const GridName& name);  // busy, and its bytes will soon be free
    void set_stuck(const GridName& name);    // could not be removed: not chosen until put()
    // Returns the names of the grids of one domain and moment from `from` to `to`.
    [[nodiscard]] std::vector<GridName> names(const std::string& domain, level2::Moment moment,
                                              UtcTime from, UtcTime to) const;

    // Counts bytes that are not in grids: files being written, and leftovers.
    void reserve(std::string_view group, std::uint64_t bytes);
    void release(std::string_view group, std::uint64_t bytes);

    [[nodiscard]] std::uint64_t used() const { return used_; }
    [[nodiscard]] std::uint64_t used(std::string_view group) const;
    [[nodiscard]] std::uint64_t used_by_others() const;
    [[nodiscard]] std::size_t grid_count() const { return grids_; }
    [[nodiscard]] std::size_t pinned_count() const { return pinned_; }
    [[nodiscard]] std::vector<std::string> groups() const;

    // Returns the newest believable time of the group's grids, or none.
    [[nodiscard]] std::optional<UtcTime> newest(std::string_view group) const;
    // Returns true if a grid of this name is, or would be, the newest of its domain and moment.
    [[nodiscard]] bool is_newest(const GridName& name) const;
    // Returns true if a grid of this name must be kept, even if protected grids must be evicted to
    // make room. This is so if the grid's group is known, and if the grid is pinned or is_newest().
    [[nodiscard]] bool is_to_stay(const GridName& name) const;
    // Returns true if a grid of this name that is written now would exceed its group's limit of
    // age. Returns false for a pinned grid. Returns false for the newest grid of a domain and
    // moment in a known group, unless the grid is a part of a mosaic.
    [[nodiscard]] bool is_expired(const GridName& name, const Budgets& budgets) const;

    // Returns the space that a budget allows, as stormcellar/cache/budget.h defines it; none: no
    // limit.
    [[nodiscard]] std::optional<std::uint64_t> space_of(const Budget& budget) const;
    [[nodiscard]] std::optional<std::uint64_t> others_limit(const Budgets& budgets) const;

    // Returns true if this many more bytes of the group fit into the budgets now.
    [[nodiscard]] bool fits(std::string_view group, std::uint64_t bytes,
                            const Budgets& budgets) const;
    // Returns the grids that must be evicted so that `bytes` of this grid fit, in addition to the
    // grids that are being evicted already. Returns none if that is impossible. Chooses only grids
    // that come before this grid in the order of eviction, unless this grid is_to_stay().
    [[nodiscard]] std::optional<std::vector<GridName>> room_for(
        const GridName& name, std::uint64_t bytes, const Budgets& budgets,
        Reach reach = Reach::unprotected) const;
    // Returns the oldest grids that together hold `bytes` on disk, or fewer grids if there are no
    // more. Chooses from all groups if the total budget limits space, else from the grid's group.
    // Chooses only grids that room_for() may choose.
    [[nodiscard]] std::vector<GridName> oldest(const GridName& name, std::uint64_t bytes,
                                               const Budgets& budgets) const;

    // Returns the oldest grids that must be evicted so that the group (empty: all groups together)
    // holds at most `bytes`. Returns at most `most` grids.
    [[nodiscard]] std::vector<GridName> down_to(std::string_view group, std::uint64_t bytes,
                                                std::size_t most, const Protection& protection = {},
                                                Reach reach = Reach::unprotected) const;
    // Returns the oldest grids of others that must be evicted so that all grids of others together
    // hold at most `bytes`. Returns at most `most` grids.
    [[nodiscard]] std::vector<GridName> others_down_to(std::uint64_t bytes, std::size_t most) const;
    // Returns at most `most` grids of the group that are older than its limit of age. Leaves out
    // protected grids that are not parts.
    [[nodiscard]] std::vector<GridName> expired(std::string_view group, const Budgets& budgets,
                                                std::size_t most) const;
    // Returns at most `most` grids of others that were written longer ago than `protected_for`.
    [[nodiscard]] std::vector<GridName> outlived(const Budgets& budgets, std::size_t most) const;

  private:
    struct Entry {
        GridFacts facts;
        UtcTime counted;
        bool known = true;  // the group of the grid is known
        bool busy = false, leaving = false, stuck = false;
        [[nodiscard]] bool may_go() const { return !facts.pinned && !busy && !stuck; }
    };
    using Item = std::pair<const GridName, Entry>;
    struct ByAge {
        using is_transparent = void;
        struct Key {
            bool known;  // false sorts first
            UtcTime counted;
            const GridName* name;
        };
        static Key key(const Item* item) {
            return {item->second.known, item->second.counted, &item->first};
        }
        static Key key(const Key& key) { return key; }
        bool operator()(const auto& a, const auto& b) const {
            const Key first = key(a), second = key(b);
            return std::tie(first.known, first.counted, *first.name) <
                   std::tie(second.known, second.counted, *second.name);
        }
    };
    using Order = std::set<const Item*, ByAge>;  // grids that may be evicted (may_go())
    struct Group {
        bool known = true;
        std::map<GridName, Entry> grids;
        Order order;
        std::uint64_t used = 0, leaving = 0;
    };
    using Groups = std::map<std::string, Group, std::less<>>;

    [[nodiscard]] const Group* group_of_name(std::string_view group) const;
    [[nodiscard]] bool believed(UtcTime time) const { return is_believed(time, now_); }
    // Returns the newest grid of the domain and moment that has a believable time (is_believed()).
    // If no grid has such a time, returns the newest grid of all. Returns null if there is no grid.
    [[nodiscard]] const Item* newest_of(const Group& group, const std::string& domain,
                                        level2::Moment moment) const;
    // Visits the newest grid of each domain and moment of the group.
    template <class Visit>
    void for_each_newest(const Group& group, Visit visit) const;
    [[nodiscard]] UtcTime counted_if_written_now(const GridName& name) const;
    [[nodiscard]] bool is_younger(const Item& item, std::chrono::milliseconds age) const;
    [[nodiscard]] bool is_protected(const Item& item, std::chrono::milliseconds age) const;
    [[nodiscard]] std::set<const Item*> lapsed(const Group* group,
                                               const Protection& protection) const;
    class Shield;
    // Returns the size of all grids of others, without those that are being evicted.
    [[nodiscard]] std::uint64_t staying_of_others() const;
    [[nodiscard]] Order::const_iterator end_for(const Order& order, const GridName& name) const;
    Item* find_item(const GridName& name);
    Group& group_to_fill(std::string_view name);
    void drop_if_empty(Groups::iterator group);
    void set_known(Group& group, bool known);
    void enter(Group& group, Item& item);
    void withdraw(Group& group, Item& item);
    void count(Group& group, const Item& item, bool add);
    template <class Change>
    void change(const GridName& name, Change what);

    IsKnown is_known_;
    UtcTime now_{};
    std::uint64_t capacity_ = 0;
    Groups groups_;
    Order order_;
    std::set<std::pair<UtcTime, GridName>> future_;
    std::uint64_t used_ = 0, leaving_ = 0;
    std::size_t grids_ = 0, pinned_ = 0;
};

}  // namespace stormcellar::cache
