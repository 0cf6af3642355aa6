#include "retrieve/dealias/shear_repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "retrieve/dealias/fold_graph.h"

namespace stormcellar::retrieve {
namespace {

// Gates within this many radials and gates of a jump are unfolded again, because a tornado's core
// is some radials and gates wide.
constexpr int reach = 4;

// A block of radials and gates in which a larger share of the pairs jumps holds noise, not shear.
constexpr double most_jumps = 0.15;
constexpr int block_radials = 8, block_gates = 16;

// A gate votes for the fold number of its region with this weight, so that neighbors that
// contradict each other do not change the number.
constexpr float weight_of_staying = 0.06F;

class ShearRepair {
  public:
    ShearRepair(const VelocitySheet& sheet, std::vector<std::int8_t>& folds)
        : sheet_(sheet), folds_(folds), node_(folds.size(), -1) {}

    void run() {
        mark_about_jumps();
        if (marked_.empty()) return;
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
    [[nodiscard]] float unfolded(std::size_t gate) const {
        return sheet_.turns[gate] + static_cast<float>(folds_[gate]);
    }
    // Returns the radial after this radial, or -1 if there is none.
    [[nodiscard]] int after(int radial) const {
        if (radial + 1 < sheet_.radials) return radial + 1;
        return sheet_.is_circle ? 0 : -1;
    }
    // Calls use(a, b) for each pair of adjacent gates with values.
    template <class Use>
    void for_each_pair(Use use) const {
        for (int radial = 0; radial < sheet_.radials; ++radial) {
            const int next = after(radial);
            for (int gate = 0; gate < sheet_.gates; ++gate) {
                const std::size_t here = sheet_.at(radial, gate);
                if (!has_value(here)) continue;
                if (gate + 1 < sheet_.gates && has_value(here + 1)) use(here, here + 1);
                if (next >= 0 && has_value(sheet_.at(next, gate))) use(here, sheet_.at(next, gate));
            }
        }
    }

    void mark_about_jumps() {
        struct Block {
            int pairs = 0, jumps = 0;
        };
        const int across = sheet_.gates / block_gates + 1;
        std::vector<Block> blocks(
            static_cast<std::size_t>(across * (sheet_.radials / block_radials + 1)));
        const auto block_of = [&](std::size_t at) -> Block& {
            const int radial = radial_of(at) / block_radials, gate = gate_of(at) / block_gates;
            return blocks[static_cast<std::size_t>(radial * across + gate)];
        };
        std::vector<std::pair<std::size_t, std::size_t>> jumps;
        for_each_pair([&](std::size_t a, std::size_t b) {
            Block& block = block_of(a);
            ++block.pairs;
            if (std::abs(unfolded(a) - unfolded(b)) <= 0.5F) return;
            ++block.jumps;
            jumps.emplace_back(a, b);
        });
        std::vector<std::uint8_t> is_marked(folds_.size(), 0);
        for (const auto& [a, b] : jumps) {
            const Block& block = block_of(a);
            if (block.jumps > most_jumps * block.pairs) continue;
            mark_about(a, is_marked);
            mark_about(b, is_marked);
        }
        for (std::size_t gate = 0; gate < folds_.size(); ++gate)
            if (is_marked[gate] != 0 && has_value(gate)) marked_.push_back(gate);
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
        for_each_pair([&](std::size_t a, std::size_t b) {
            const std::int32_t of_a = node_[a], of_b = node_[b];
            if (of_a < 0 && of_b < 0) return;
            const float turns = sheet_.turns[a] - sheet_.turns[b];
            const float whole = std::nearbyint(turns);
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
        });
        for (const Votes& votes : anchors_)
            bound_.push_back(votes.total());
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
