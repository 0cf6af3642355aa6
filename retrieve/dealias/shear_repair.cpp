#include "retrieve/dealias/shear_repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "retrieve/dealias/fold_graph.h"
#include "retrieve/dealias/unfolded_sheet.h"

namespace stormcellar::retrieve {
namespace {

// Gates within this many radials and gates of a jump are unfolded again, because a tornado's core
// is some radials and gates wide.
constexpr int reach = 4;

// A block of radials and of a run of gates in which a larger share of the pairs jumps holds noise,
// not shear.
constexpr double most_jumps = 0.15;
constexpr int block_radials = 8;

// A gate votes for the fold number of its region with this weight, so that neighbors that
// contradict each other do not change the number. An island of marked gates has no other anchors.
constexpr float weight_of_staying = 0.06F;

class ShearRepair {
  public:
    ShearRepair(const VelocitySheet& sheet, std::vector<std::int8_t>& folds)
        : sheet_(sheet), folds_(folds) {}

    void run() {
        mark_about_jumps();
        if (marked_.empty()) return;
        node_.assign(folds_.size(), -1);
        for (std::size_t i = 0; i < marked_.size(); ++i)
            node_[marked_[i]] = static_cast<std::int32_t>(i);
        gather_votes();
        const auto count = static_cast<std::int32_t>(marked_.size());
        const FoldGraph graph = fold_graph(std::move(edges_), count, bound_);
        std::vector<Votes> anchors(static_cast<std::size_t>(graph.nodes));
        for (std::size_t i = 0; i < marked_.size(); ++i) {
            const auto to = static_cast<std::size_t>(graph.node_of_region[i]);
            anchors[to].add_shifted(anchors_[i], -graph.fold_in_node[i]);
        }
        std::vector<std::int32_t> found = likely_folds(graph);
        minimize_cost(graph, anchors, found);
        for (std::size_t i = 0; i < marked_.size(); ++i) {
            const std::int32_t fold =
                found[static_cast<std::size_t>(graph.node_of_region[i])] + graph.fold_in_node[i];
            folds_[marked_[i]] = static_cast<std::int8_t>(std::clamp(fold, -100, 100));
        }
    }

  private:
    [[nodiscard]] int radial_of(std::size_t at) const {
        return static_cast<int>(at / static_cast<std::size_t>(sheet_.gates));
    }
    [[nodiscard]] int gate_of(std::size_t at) const {
        return static_cast<int>(at % static_cast<std::size_t>(sheet_.gates));
    }
    [[nodiscard]] bool has_value(std::size_t gate) const { return !std::isnan(sheet_.turns[gate]); }
    // Returns the radial after this radial, or -1 if there is none.
    [[nodiscard]] int after(int radial) const {
        if (radial + 1 < sheet_.radials) return radial + 1;
        return sheet_.is_circle ? 0 : -1;
    }
    [[nodiscard]] int before(int radial) const {
        if (radial > 0) return radial - 1;
        return sheet_.is_circle ? sheet_.radials - 1 : -1;
    }
    // Counts the pairs, and the pairs that jump, that begin in a block of gates.
    struct Block {
        int pairs = 0, jumps = 0;
    };
    [[nodiscard]] Block count_block(const UnfoldedSheet& unfolded, int first_radial,
                                    int run) const {
        Block block;
        const int first = run * UnfoldedSheet::run_gates;
        const int end = std::min(first_radial + block_radials, sheet_.radials);
        for (int radial = first_radial; radial < end; ++radial) {
            const float* here = unfolded.row(radial);
            const float* beside = unfolded.row_after(radial);
            for (int gate = first; gate < first + UnfoldedSheet::run_gates; ++gate) {
                for (const float other : {here[gate + 1], beside[gate]}) {
                    block.pairs += std::isnan(here[gate] - other) ? 0 : 1;
                    const bool is_jump = turns_apart(here[gate], other) > UnfoldedSheet::jump_turns;
                    block.jumps += is_jump ? 1 : 0;
                }
            }
        }
        return block;
    }

    void mark_about_jumps() {
        const UnfoldedSheet unfolded(sheet_, folds_);
        std::vector<std::uint8_t> is_marked(folds_.size(), 0);
        for (int first = 0; first < sheet_.radials; first += block_radials) {
            const int end = std::min(first + block_radials, sheet_.radials);
            for (int run = 0; run < unfolded.runs(); ++run) {
                bool any = false;
                for (int radial = first; radial < end; ++radial)
                    any = any || unfolded.jumps(radial, run);
                if (!any) continue;
                const Block block = count_block(unfolded, first, run);
                if (block.jumps > most_jumps * block.pairs) continue;
                for (int radial = first; radial < end; ++radial)
                    mark_about_jumps(unfolded, radial, run, is_marked);
            }
        }
        for (std::size_t gate = 0; gate < folds_.size(); ++gate)
            if (is_marked[gate] != 0 && has_value(gate)) marked_.push_back(gate);
    }
    void mark_about_jumps(const UnfoldedSheet& unfolded, int radial, int run,
                          std::vector<std::uint8_t>& is_marked) const {
        if (!unfolded.jumps(radial, run)) return;
        const float* here = unfolded.row(radial);
        const float* beside = unfolded.row_after(radial);
        const int first = run * UnfoldedSheet::run_gates;
        for (int gate = first; gate < first + UnfoldedSheet::run_gates; ++gate) {
            const auto mark_both = [&](int other_radial, int other_gate, float value) {
                if (turns_apart(here[gate], value) <= UnfoldedSheet::jump_turns) return;
                mark_about(sheet_.at(radial, gate), is_marked);
                mark_about(sheet_.at(other_radial, other_gate), is_marked);
            };
            mark_both(radial, gate + 1, here[gate + 1]);
            mark_both(unfolded.after(radial), gate, beside[gate]);
        }
    }
    void mark_about(std::size_t at, std::vector<std::uint8_t>& is_marked) const {
        const int radial = radial_of(at), gate = gate_of(at);
        const int first = std::max(0, gate - reach),
                  last = std::min(sheet_.gates - 1, gate + reach);
        for (int away = -reach; away <= reach; ++away) {
            int row = radial + away;
            if (sheet_.is_circle) row = (row + sheet_.radials) % sheet_.radials;
            if (row < 0 || row >= sheet_.radials) continue;
            std::fill_n(is_marked.begin() + static_cast<std::ptrdiff_t>(sheet_.at(row, first)),
                        last - first + 1, std::uint8_t{1});
        }
    }

    // Makes an edge from each pair of marked gates, and an anchor from each pair of which one gate
    // is marked.
    void gather_votes() {
        anchors_.resize(marked_.size());
        for (std::size_t i = 0; i < marked_.size(); ++i)
            anchors_[i].add(folds_[marked_[i]], weight_of_staying);
        for (const std::size_t here : marked_) {
            const int radial = radial_of(here), gate = gate_of(here);
            const int before = this->before(radial), after = this->after(radial);
            if (gate + 1 < sheet_.gates) meet(here, here + 1);
            if (after >= 0) meet(here, sheet_.at(after, gate));
            // If the gate before this gate is marked too, the loop meets this pair at that gate.
            if (gate > 0 && node_[here - 1] < 0) meet(here - 1, here);
            if (before >= 0 && node_[sheet_.at(before, gate)] < 0)
                meet(sheet_.at(before, gate), here);
        }
        for (const Votes& votes : anchors_)
            bound_.push_back(votes.total());
    }

    // Adds the votes of two adjacent gates, one of which is marked.
    void meet(std::size_t a, std::size_t b) {
        const float turns = sheet_.turns[a] - sheet_.turns[b];
        if (std::isnan(turns)) return;
        const std::int32_t of_a = node_[a], of_b = node_[b];
        const float whole = nearest_whole(turns);
        const float weight = vote_weight(turns - whole);
        const int number = static_cast<int>(whole);
        if (of_a >= 0 && of_b >= 0) {
            FoldEdge edge{of_a, of_b, {}};
            edge.votes.add(number, weight);
            edges_.push_back(edge);
        } else if (of_b >= 0) {
            anchors_[static_cast<std::size_t>(of_b)].add(folds_[a] + number, weight);
        } else {
            anchors_[static_cast<std::size_t>(of_a)].add(folds_[b] - number, weight);
        }
    }

    const VelocitySheet& sheet_;
    std::vector<std::int8_t>& folds_;
    std::vector<std::int32_t> node_;   // index in marked_ of each gate, or -1
    std::vector<std::size_t> marked_;  // gates to unfold again
    std::vector<FoldEdge> edges_;
    std::vector<Votes> anchors_;
    std::vector<float> bound_;
};

}  // namespace

void repair_shear(const VelocitySheet& sheet, std::vector<std::int8_t>& folds) {
    ShearRepair(sheet, folds).run();
}

}  // namespace stormcellar::retrieve
