#include "retrieve/dealias/roughness.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "retrieve/dealias/unfolded_sheet.h"

namespace stormcellar::retrieve {
namespace {

constexpr int reach = 4;          // gates on each side
constexpr int radial_reach = 2;   // radials on each side
constexpr float least_pairs = 5;  // fewer pairs count as this many

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
    // Notes which runs have a rough difference in the radials about this radial.
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
    // Returns false if no difference about the gates of a run is rough, because then their mean is
    // not rough either.
    [[nodiscard]] bool may_be_rough(int run) const {
        const auto at = static_cast<std::size_t>(run);
        return near_[at] != 0 || (at > 0 && near_[at - 1] != 0) ||
               (at + 1 < near_.size() && near_[at + 1] != 0);
    }
    // Sums of differences, and numbers of pairs, that begin in each column of gates about a run.
    // The first column is `reach` gates before the run.
    static constexpr int columns = UnfoldedSheet::run_gates + 2 * reach;
    struct Columns {
        std::array<float, columns> differences{}, pairs{};
    };
    // The loops have no branches, so that the compiler handles several gates at once.
    void add_row(int radial, int run, Columns& sums) const {
        const int first = run * UnfoldedSheet::run_gates - reach;
        const int begin = std::max(0, -first);
        const int end = std::min(columns, unfolded_.runs() * UnfoldedSheet::run_gates - first);
        const float* row = unfolded_.row(radial) + first;
        for (int i = begin; i < end; ++i) {
            const float apart = std::abs(row[i] - row[i + 1]);
            const float pair = apart >= 0 ? 1.0F : 0.0F;  // 0 if a gate has no value
            sums.differences[static_cast<std::size_t>(i)] += apart < 1.0F ? apart : pair;
            sums.pairs[static_cast<std::size_t>(i)] += pair;
        }
    }
    void mark(int radial, int run, std::vector<std::uint8_t>& rough) const {
        Columns sums;
        for (int away = -radial_reach; away <= radial_reach; ++away)
            if (const int near = radial_at(radial + away); near >= 0) add_row(near, run, sums);
        std::array<float, UnfoldedSheet::run_gates> differences{}, pairs{};
        for (std::size_t column = 0; column <= 2 * reach; ++column) {
            for (std::size_t i = 0; i < differences.size(); ++i) {
                differences[i] += sums.differences[i + column];
                pairs[i] += sums.pairs[i + column];
            }
        }
        const int first = run * UnfoldedSheet::run_gates;
        const int end = std::min(first + UnfoldedSheet::run_gates, sheet_.gates);
        for (int gate = first; gate < end; ++gate) {
            const auto i = static_cast<std::size_t>(gate - first);
            const bool is_rough =
                differences[i] > UnfoldedSheet::rough_turns * std::max(pairs[i], least_pairs);
            if (is_rough && !std::isnan(unfolded_.row(radial)[gate]))
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
