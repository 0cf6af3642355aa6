#include "retrieve/dealias/roughness.h"

#include <algorithm>
#include <cmath>

namespace stormcellar::retrieve {
namespace {

constexpr int reach = 2;        // gates on each side
constexpr int least_pairs = 6;  // fewer pairs count as this many
constexpr int steps = 1000;     // of a turn; whole numbers keep running sums exact
constexpr int roughest = steps / 8;

// Sums over the pairs that begin at a gate, or at several gates.
struct PairSum {
    int difference = 0, pairs = 0;
    void add(const PairSum& other, int sign) {
        difference += sign * other.difference;
        pairs += sign * other.pairs;
    }
};

class RoughGates {
  public:
    RoughGates(const VelocitySheet& sheet, const std::vector<std::int8_t>& folds)
        : sheet_(sheet),
          folds_(folds),
          by_gate_(static_cast<std::size_t>(sheet.radials) * static_cast<std::size_t>(sheet.gates)),
          column_(static_cast<std::size_t>(sheet.gates)) {}

    std::vector<std::uint8_t> find() {
        for (int radial = 0; radial < sheet_.radials; ++radial)
            sum_pairs(radial);
        std::vector<std::uint8_t> rough(folds_.size(), 0);
        for (int away = -reach; away < reach; ++away)
            add_to_columns(away, 1);
        for (int radial = 0; radial < sheet_.radials; ++radial) {
            add_to_columns(radial + reach, 1);
            mark(radial, rough);
            add_to_columns(radial - reach, -1);
        }
        return rough;
    }

  private:
    // Returns the radial with this number, which may lie beyond the ends of a circle, or -1.
    [[nodiscard]] int radial_at(int number) const {
        if (number >= 0 && number < sheet_.radials) return number;
        if (!sheet_.is_circle || sheet_.radials <= 2 * reach) return -1;
        return (number + sheet_.radials) % sheet_.radials;
    }
    void add_pair(std::size_t a, std::size_t b) {
        const float apart = std::abs(sheet_.turns[a] + static_cast<float>(folds_[a]) -
                                     sheet_.turns[b] - static_cast<float>(folds_[b]));
        if (std::isnan(apart)) return;
        by_gate_[a].add({static_cast<int>(std::min(apart, 1.0F) * steps), 1}, 1);
    }
    void sum_pairs(int radial) {
        const int next = radial_at(radial + 1);
        for (int gate = 0; gate < sheet_.gates; ++gate) {
            const std::size_t here = sheet_.at(radial, gate);
            if (std::isnan(sheet_.turns[here])) continue;
            if (gate + 1 < sheet_.gates) add_pair(here, here + 1);
            if (next >= 0) add_pair(here, sheet_.at(next, gate));
        }
    }
    void add_to_columns(int number, int sign) {
        const int radial = radial_at(number);
        if (radial < 0) return;
        for (int gate = 0; gate < sheet_.gates; ++gate)
            column_[static_cast<std::size_t>(gate)].add(by_gate_[sheet_.at(radial, gate)], sign);
    }
    void mark(int radial, std::vector<std::uint8_t>& rough) const {
        PairSum sum;
        for (int gate = -reach; gate < sheet_.gates; ++gate) {
            if (gate + reach < sheet_.gates)
                sum.add(column_[static_cast<std::size_t>(gate + reach)], 1);
            if (gate > reach) sum.add(column_[static_cast<std::size_t>(gate - reach - 1)], -1);
            if (gate < 0 || sum.difference <= roughest * std::max(sum.pairs, least_pairs)) continue;
            const std::size_t here = sheet_.at(radial, gate);
            if (!std::isnan(sheet_.turns[here])) rough[here] = 1;
        }
    }

    const VelocitySheet& sheet_;
    const std::vector<std::int8_t>& folds_;
    std::vector<PairSum> by_gate_, column_;
};

}  // namespace

std::vector<std::uint8_t> rough_gates(const VelocitySheet& sheet,
                                      const std::vector<std::int8_t>& folds) {
    return RoughGates(sheet, folds).find();
}

}  // namespace stormcellar::retrieve
