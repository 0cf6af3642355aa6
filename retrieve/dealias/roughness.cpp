#include "retrieve/dealias/roughness.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "retrieve/dealias/unfolded_sheet.h"

namespace stormcellar::retrieve {
namespace {

constexpr int reach = 4;         // gates on each side
constexpr int radial_reach = 2;  // radials on each side
constexpr int least_pairs = 5;   // fewer pairs count as this many

struct PairSum {
    float difference = 0;
    int pairs = 0;
    void add(float a, float b) {
        const float apart = std::abs(a - b);
        if (std::isnan(apart)) return;
        difference += std::min(apart, 1.0F);
        ++pairs;
    }
    void add(const PairSum& other) {
        difference += other.difference;
        pairs += other.pairs;
    }
};

class RoughGates {
  public:
    RoughGates(const VelocitySheet& sheet, const UnfoldedSheet& unfolded)
        : sheet_(sheet), unfolded_(unfolded) {}

    std::vector<std::uint8_t> find() {
        std::vector<std::uint8_t> rough(sheet_.turns.size(), 0);
        for (int radial = 0; radial < sheet_.radials; ++radial) {
            gather_rough_runs(radial);
            for (int run = 0; run < unfolded_.runs(); ++run)
                if (may_be_rough(run)) mark(radial, run, rough);
        }
        return rough;
    }

  private:
    // Returns the radial with this number, which may lie beyond the ends of a circle, or -1.
    [[nodiscard]] int radial_at(int number) const {
        if (number >= 0 && number < sheet_.radials) return number;
        if (!sheet_.is_circle || sheet_.radials <= 2 * radial_reach) return -1;
        return (number + sheet_.radials) % sheet_.radials;
    }
    // Notes which runs have a rough difference in the radials about this one.
    void gather_rough_runs(int radial) {
        near_.assign(static_cast<std::size_t>(unfolded_.runs()), 0);
        for (int away = -radial_reach; away <= radial_reach; ++away) {
            const int number = radial_at(radial + away);
            if (number < 0) continue;
            const std::uint8_t* marks = unfolded_.marks(number);
            for (std::size_t run = 0; run < near_.size(); ++run)
                near_[run] |= marks[run];
        }
    }
    // Returns false if no difference about the gates of a run is rough, because then their mean
    // is not.
    [[nodiscard]] bool may_be_rough(int run) const {
        const auto at = static_cast<std::size_t>(run);
        return near_[at] != 0 || (at > 0 && near_[at - 1] != 0) ||
               (at + 1 < near_.size() && near_[at + 1] != 0);
    }
    // Sums the pairs that begin in the column of gates about a gate.
    [[nodiscard]] PairSum column(int radial, int gate) const {
        PairSum sum;
        if (gate < 0 || gate >= sheet_.gates) return sum;
        for (int away = -radial_reach; away <= radial_reach; ++away) {
            const int near = radial_at(radial + away);
            if (near < 0) continue;
            const float* row = unfolded_.row(near);
            sum.add(row[gate], row[gate + 1]);
        }
        return sum;
    }
    void mark(int radial, int run, std::vector<std::uint8_t>& rough) const {
        constexpr int columns = UnfoldedSheet::run_gates + 2 * reach;
        const int first = run * UnfoldedSheet::run_gates;
        std::array<PairSum, columns> sums;
        for (int i = 0; i < columns; ++i)
            sums[static_cast<std::size_t>(i)] = column(radial, first - reach + i);
        const int end = std::min(first + UnfoldedSheet::run_gates, sheet_.gates);
        for (int gate = first; gate < end; ++gate) {
            if (std::isnan(unfolded_.row(radial)[gate])) continue;
            PairSum about;
            for (int i = 0; i <= 2 * reach; ++i)
                about.add(sums[static_cast<std::size_t>(gate - first + i)]);
            const auto pairs = static_cast<float>(std::max(about.pairs, least_pairs));
            if (about.difference > UnfoldedSheet::rough_turns * pairs)
                rough[sheet_.at(radial, gate)] = 1;
        }
    }

    const VelocitySheet& sheet_;
    const UnfoldedSheet& unfolded_;
    std::vector<std::uint8_t> near_;  // of each run of gates
};

}  // namespace

std::vector<std::uint8_t> rough_gates(const VelocitySheet& sheet,
                                      const std::vector<std::int8_t>& folds) {
    const UnfoldedSheet unfolded(sheet, folds);
    return RoughGates(sheet, unfolded).find();
}

}  // namespace stormcellar::retrieve
