// retrieve/dealias/offset_sets.h -- keeps disjoint sets whose members have known differences.
//
// Threads  One thread; find() shortens paths.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace stormcellar::retrieve {

class OffsetSets {
  public:
    explicit OffsetSets(std::int32_t members)
        : parent_(static_cast<std::size_t>(members)),
          offset_(parent_.size(), 0),
          size_(parent_.size(), 1) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }
    struct Found {
        std::int32_t root;
        std::int32_t offset;  // value(member) - value(root)
    };
    [[nodiscard]] Found find(std::int32_t member) {
        std::int32_t root = member, sum = 0;
        while (parent_[at(root)] != root) {
            sum += offset_[at(root)];
            root = parent_[at(root)];
        }
        // Hang every member on the way directly below the root.
        for (std::int32_t left = sum; parent_[at(member)] != root && member != root;) {
            const std::int32_t next = parent_[at(member)];
            parent_[at(member)] = root;
            left -= std::exchange(offset_[at(member)], left);
            member = next;
        }
        return {root, sum};
    }
    // Sets value(b) - value(a) to `difference`. Returns false, and changes nothing, if a and b are
    // already in one set.
    bool join(std::int32_t a, std::int32_t b, std::int32_t difference) {
        const Found of_a = find(a), of_b = find(b);
        if (of_a.root == of_b.root) return false;
        // value(root b) - value(root a)
        const std::int32_t between = of_a.offset + difference - of_b.offset;
        const bool b_below_a = size_[at(of_a.root)] >= size_[at(of_b.root)];
        const std::int32_t below = b_below_a ? of_b.root : of_a.root;
        const std::int32_t above = b_below_a ? of_a.root : of_b.root;
        parent_[at(below)] = above;
        offset_[at(below)] = b_below_a ? between : -between;
        size_[at(above)] += size_[at(below)];
        return true;
    }

  private:
    static std::size_t at(std::int32_t member) { return static_cast<std::size_t>(member); }
    std::vector<std::int32_t> parent_, offset_, size_;
};

}  // namespace stormcellar::retrieve
