#include "retrieve/dealias/minimum_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stormcellar::retrieve {
namespace {

constexpr float least_capacity = 1e-5F;  // smaller capacities are rounding errors

}  // namespace

void MinimumCut::prefer_source(std::int32_t node, float cost) {
    at(node).rest += cost;
}

void MinimumCut::connect(std::int32_t from, std::int32_t to, float cost, float reverse_cost) {
    if (!(cost > 0 || reverse_cost > 0) || from == to) return;
    const auto next = static_cast<std::int32_t>(arcs_.size());
    arcs_.push_back({to, at(from).first, cost});
    at(from).first = next;
    arcs_.push_back({from, at(to).first, reverse_cost});
    at(to).first = next + 1;
}

void MinimumCut::activate(std::int32_t node) {
    if (at(node).is_active) return;
    at(node).is_active = true;
    active_.push_back(node);
}

// Adds the free neighbors of a node to its tree. Returns the arc, from the source's tree to the
// sink's, over which the node meets the other tree; none if there is no such arc.
std::int32_t MinimumCut::grow(std::int32_t node) {
    const Tree tree = at(node).tree;
    for (std::int32_t a = at(node).first; a != none; a = arc(a).next) {
        ++looks_;
        if (outward(tree, a) <= least_capacity) continue;
        const std::int32_t there = arc(a).to;
        Node& other = at(there);
        if (other.tree == Tree::free) {
            other.tree = tree;
            other.parent = a ^ 1;
            other.checked = at(node).checked;
            other.distance = at(node).distance + 1;
            activate(there);
        } else if (other.tree != tree) {
            return tree == Tree::source ? a : a ^ 1;
        } else if (other.checked <= at(node).checked && other.distance > at(node).distance) {
            // This path to the root is shorter.
            other.parent = a ^ 1;
            other.checked = at(node).checked;
            other.distance = at(node).distance + 1;
        }
    }
    return none;
}

float MinimumCut::least_along(std::int32_t node, float least) {
    const Tree tree = at(node).tree;
    while (at(node).parent != terminal) {
        const std::int32_t up = at(node).parent;  // from the node to its parent
        least = std::min(least, outward(tree, up ^ 1));
        node = arc(up).to;
    }
    return std::min(least, std::abs(at(node).rest));
}

void MinimumCut::fill_along(std::int32_t node, float flow) {
    const Tree tree = at(node).tree;
    while (at(node).parent != terminal) {
        const std::int32_t up = at(node).parent;
        const std::int32_t along = tree == Tree::source ? up ^ 1 : up;
        arc(along).capacity -= flow;
        arc(along ^ 1).capacity += flow;
        const std::int32_t parent = arc(up).to;
        if (arc(along).capacity <= least_capacity) make_orphan(node);
        node = parent;
    }
    at(node).rest += tree == Tree::source ? -flow : flow;
    if (std::abs(at(node).rest) <= least_capacity) make_orphan(node);
}

void MinimumCut::make_orphan(std::int32_t node) {
    at(node).parent = orphan;
    orphans_.push_back(node);
}

void MinimumCut::fill(std::int32_t bridge) {
    const std::int32_t in_source = arc(bridge ^ 1).to, in_sink = arc(bridge).to;
    const float flow = least_along(in_sink, least_along(in_source, arc(bridge).capacity));
    arc(bridge).capacity -= flow;
    arc(bridge ^ 1).capacity += flow;
    fill_along(in_source, flow);
    fill_along(in_sink, flow);
}

// Returns true if the path up from a node ends at a root. `distance` is then the length of the
// path. Marks the nodes on the path, so that the next search can end at them.
bool MinimumCut::is_rooted(std::int32_t node, std::int32_t& distance) {
    distance = 0;
    std::int32_t top = node;
    while (true) {
        if (at(top).checked == time_) {
            distance += at(top).distance;
            break;
        }
        const std::int32_t up = at(top).parent;
        ++looks_;
        ++distance;
        if (up == terminal) {
            at(top).checked = time_;
            at(top).distance = 1;
            break;
        }
        if (up == orphan || up == none) return false;
        top = arc(up).to;
    }
    std::int32_t left = distance;
    for (std::int32_t i = node; at(i).checked != time_; i = arc(at(i).parent).to) {
        at(i).checked = time_;
        at(i).distance = left--;
    }
    return true;
}

// Hangs an orphan below the neighbor of its tree that is nearest to the root. If there is none, the
// orphan leaves the tree, and its children become orphans.
void MinimumCut::adopt(std::int32_t node) {
    const Tree tree = at(node).tree;
    std::int32_t best = none, nearest = std::numeric_limits<std::int32_t>::max();
    for (std::int32_t a = at(node).first; a != none; a = arc(a).next) {
        ++looks_;
        const std::int32_t there = arc(a).to;
        if (at(there).tree != tree || at(there).parent == none) continue;
        if (outward(tree, a ^ 1) <= least_capacity) continue;
        std::int32_t distance = 0;
        if (!is_rooted(there, distance) || distance >= nearest) continue;
        nearest = distance;
        best = a;
    }
    if (best != none) {
        at(node).parent = best;
        at(node).checked = time_;
        at(node).distance = nearest + 1;
        return;
    }
    for (std::int32_t a = at(node).first; a != none; a = arc(a).next) {
        ++looks_;
        const std::int32_t there = arc(a).to;
        if (at(there).tree != tree || at(there).parent == none) continue;
        if (outward(tree, a ^ 1) > least_capacity) activate(there);
        const std::int32_t up = at(there).parent;
        if (up >= 0 && arc(up).to == node) make_orphan(there);
    }
    at(node).tree = Tree::free;
    at(node).parent = none;
}

void MinimumCut::adopt() {
    ++time_;
    while (!orphans_.empty()) {
        const std::int32_t node = orphans_.front();
        orphans_.pop_front();
        adopt(node);
    }
}

std::int64_t MinimumCut::run(std::int64_t most_looks) {
    looks_ = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        Node& node = nodes_[i];
        if (std::abs(node.rest) <= least_capacity) continue;
        node.tree = node.rest > 0 ? Tree::source : Tree::sink;
        node.parent = terminal;
        node.distance = 1;
        activate(static_cast<std::int32_t>(i));
    }
    while (!active_.empty() && looks_ < most_looks) {
        const std::int32_t node = active_.front();
        if (at(node).tree == Tree::free) {
            at(node).is_active = false;
            active_.pop_front();
            continue;
        }
        const std::int32_t bridge = grow(node);
        if (bridge == none) {
            at(node).is_active = false;
            active_.pop_front();
            continue;
        }
        ++time_;
        fill(bridge);
        adopt();
    }
    return looks_;
}

}  // namespace stormcellar::retrieve
