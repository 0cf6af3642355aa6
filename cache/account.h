// cache/account.h -- what the cache holds, and which grids to evict. Inside the cache room only.
//
// Pure bookkeeping: it reads no file and no clock. Grids are ordered by their time. If a grid's
// time is more than 10 minutes in the future, the time at which its file was written counts
// instead, so that a radar with a wrong clock cannot fill the cache with grids that never grow old.
// All grids of others (stormcellar/cache/budget.h) come before those of known groups. A grid is
// never a victim while it is pinned, being written or evicted (busy), stuck, or protected. Thread
// contract: one thread at a time.
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

// Which grids may be evicted.
enum class Reach {
    others,       // those of unknown groups
    unprotected,  // also those of known groups that are not protected
    all,          // also the protected ones
};

// Which grids are protected from a limit.
struct Protection {
    std::chrono::milliseconds age{};     // written less than this ago; 0: at any age
    std::optional<std::uint64_t> space;  // at most half of this is protected; none: no bound
};

class Account {
  public:
    using IsKnown = std::function<bool(std::string_view group)>;

    explicit Account(IsKnown is_known = is_known_group) : is_known_(std::move(is_known)) {}

    // Sets the current time. From now on, grids whose time has come are ordered by it.
    void set_now(UtcTime now);
    // Sets the size of the file system, for limits in percent; 0: unknown.
    void set_capacity(std::uint64_t bytes) { capacity_ = bytes; }
    // Whether a group is known is determined when its first grid comes, and again here.
    void ask_who_is_known();
    void ask_who_is_known(std::string_view group);
    [[nodiscard]] bool is_known(std::string_view group) const;

    // Adds the grid or replaces what is known of it; afterwards it is neither busy nor stuck.
    void put(const GridName& name, const GridFacts& facts);
    void erase(const GridName& name);
    [[nodiscard]] const GridFacts* find(const GridName& name) const;
    [[nodiscard]] bool is_busy(const GridName& name) const;
    void set_pinned(const GridName& name);
    void set_busy(const GridName& name);     // no victim until put() or erase()
    void set_leaving(const GridName& name);  // busy, and its bytes will soon be free
    void set_stuck(const GridName& name);    // could not be removed: no victim until put()
    // The names for one domain and moment within these times.
    [[nodiscard]] std::vector<GridName> names(const std::string& domain, level2::Moment moment,
                                              UtcTime from, UtcTime to) const;

    // Bytes in addition to those of the grids: files that are being written or were left over.
    void reserve(std::string_view group, std::uint64_t bytes);
    void release(std::string_view group, std::uint64_t bytes);

    [[nodiscard]] std::uint64_t used() const { return used_; }
    [[nodiscard]] std::uint64_t used(std::string_view group) const;
    [[nodiscard]] std::uint64_t used_by_others() const;
    [[nodiscard]] std::size_t grid_count() const { return grids_; }
    [[nodiscard]] std::size_t pinned_count() const { return pinned_; }
    [[nodiscard]] std::vector<std::string> groups() const;

    // The newest time of a group that counts; none if it has no grid.
    [[nodiscard]] std::optional<UtcTime> newest(std::string_view group) const;
    // Returns true if a grid of this name is or would be the newest of its domain and moment.
    [[nodiscard]] bool is_newest(const GridName& name) const;
    // Returns true if a grid of this name, written now, must be stored whatever is evicted for it:
    // its group is known, and it is the newest grid or pinned already.
    [[nodiscard]] bool is_to_stay(const GridName& name) const;
    // Returns true if a grid of this name, written now, is older than the group's age limit and not
    // protected from it.
    [[nodiscard]] bool is_expired(const GridName& name, const Budgets& budgets) const;

    // The limit as stormcellar/cache/budget.h defines it; none: no limit.
    [[nodiscard]] std::optional<std::uint64_t> space_of(const Budget& budget) const;
    [[nodiscard]] std::optional<std::uint64_t> others_limit(const Budgets& budgets) const;

    // Returns true if this many more bytes fit now.
    [[nodiscard]] bool fits(std::string_view group, std::uint64_t bytes,
                            const Budgets& budgets) const;
    // Which grids must be evicted so that `bytes` of this grid fit, oldest first, beside those that
    // are leaving already; none if that is impossible. Only grids that come before this grid are
    // evicted, unless it must be stored.
    [[nodiscard]] std::optional<std::vector<GridName>> room_for(
        const GridName& name, std::uint64_t bytes, const Budgets& budgets,
        Reach reach = Reach::unprotected) const;
    // The oldest grids that hold this many bytes on disk: among all grids if the limit of the whole
    // cache is a limit of space, otherwise in the grid's group. By the same rule; fewer if there
    // are no more.
    [[nodiscard]] std::vector<GridName> oldest(const GridName& name, std::uint64_t bytes,
                                               const Budgets& budgets) const;

    // At most `most` of the oldest, so that the group (empty: all) holds `bytes` or less.
    [[nodiscard]] std::vector<GridName> down_to(std::string_view group, std::uint64_t bytes,
                                                std::size_t most, const Protection& protection = {},
                                                Reach reach = Reach::unprotected) const;
    // The same, so that the others together hold `bytes` or less.
    [[nodiscard]] std::vector<GridName> others_down_to(std::uint64_t bytes, std::size_t most) const;
    [[nodiscard]] std::vector<GridName> expired(std::string_view group, const Budgets& budgets,
                                                std::size_t most) const;
    // Grids of others that were written before the period of protection.
    [[nodiscard]] std::vector<GridName> outlived(const Budgets& budgets, std::size_t most) const;

  private:
    struct Entry {
        GridFacts facts;
        UtcTime counted;
        bool known = true;  // as its group
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
    using Order = std::set<const Item*, ByAge>;  // those that may be evicted
    struct Group {
        bool known = true;
        std::map<GridName, Entry> grids;
        Order order;
        std::uint64_t used = 0, leaving = 0;
    };
    using Groups = std::map<std::string, Group, std::less<>>;

    [[nodiscard]] const Group* group_of_name(std::string_view group) const;
    [[nodiscard]] bool believed(UtcTime time) const { return is_believed(time, now_); }
    // The newest grid whose time is believed; if there is none, the newest of all.
    [[nodiscard]] const Item* newest_of(const Group& group, const std::string& domain,
                                        level2::Moment moment) const;
    // Calls the function for the newest grid of each domain and moment of the group.
    template <class Visit>
    void for_each_newest(const Group& group, Visit visit) const;
    [[nodiscard]] UtcTime counted_if_written_now(const GridName& name) const;
    [[nodiscard]] bool is_younger(const Item& item, std::chrono::milliseconds age) const;
    [[nodiscard]] bool is_protected(const Item& item, std::chrono::milliseconds age) const;
    [[nodiscard]] std::set<const Item*> lapsed(const Group* group,
                                               const Protection& protection) const;
    class Shield;
    [[nodiscard]] std::uint64_t staying_of_others()
        const;  // used by others, without what is leaving
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
