#include "retrieve/dealias/minimum_cut.h"

#include <algorithm>
#include <limits>

namespace stormcellar::retrieve {
namespace {

constexpr float least_capacity = 1e-5F;  // smaller capacities are rounding errors

}  // namespace

MinimumCut::MinimumCut(std::int32_t nodes)
    : source_(nodes), sink_(nodes + 1), first_(static_cast<std::size_t>(nodes) + 2, -1) {}

void MinimumCut::add(std::int32_t from, std::int32_t to, float capacity) {
    auto& first_from = first_[static_cast<std::size_t>(from)];
    arcs_.push_back({to, first_from, capacity});
    first_from = static_cast<std::int32_t>(arcs_.size() - 1);
    auto& first_to = first_[static_cast<std::size_t>(to)];
    arcs_.push_back({from, first_to, 0});
    first_to = static_cast<std::int32_t>(arcs_.size() - 1);
}

void MinimumCut::prefer_source(std::int32_t node, float cost) {
    if (cost > 0) add(source_, node, cost);
    if (cost < 0) add(node, sink_, -cost);
}

void MinimumCut::connect(std::int32_t from, std::int32_t to, float cost) {
    if (cost > 0) add(from, to, cost);
}

// Numbers the nodes by their distance from the source along arcs with capacity left. Returns true
// if the sink has a number.
bool MinimumCut::reaches_sink() {
    level_.assign(first_.size(), -1);
    level_[static_cast<std::size_t>(source_)] = 0;
    queue_.assign(1, source_);
    for (std::size_t i = 0; i < queue_.size(); ++i) {
        const auto node = static_cast<std::size_t>(queue_[i]);
        for (std::int32_t a = first_[node]; a >= 0; a = arcs_[static_cast<std::size_t>(a)].next) {
            ++looks_;
            const Arc& arc = arcs_[static_cast<std::size_t>(a)];
            auto& level = level_[static_cast<std::size_t>(arc.to)];
            if (arc.capacity <= least_capacity || level >= 0) continue;
            level = level_[node] + 1;
            queue_.push_back(arc.to);
        }
    }
    return level_[static_cast<std::size_t>(sink_)] >= 0;
}

// Returns the first arc from the node that leads one level on and has capacity left, or -1 if there
// is none.
std::int32_t MinimumCut::next_arc(std::int32_t node) {
    std::int32_t& a = current_[static_cast<std::size_t>(node)];
    const std::int32_t level = level_[static_cast<std::size_t>(node)];
    for (; a >= 0; a = arcs_[static_cast<std::size_t>(a)].next) {
        ++looks_;
        const Arc& arc = arcs_[static_cast<std::size_t>(a)];
        if (arc.capacity > least_capacity && level_[static_cast<std::size_t>(arc.to)] == level + 1)
            break;
    }
    return a;
}

// Sends as much flow along the path from the source to the sink as it can hold. Returns the number
// of arcs before the first full arc.
std::size_t MinimumCut::fill_path() {
    float flow = std::numeric_limits<float>::max();
    for (const std::int32_t a : path_)
        flow = std::min(flow, arcs_[static_cast<std::size_t>(a)].capacity);
    std::size_t left = path_.size();
    for (std::size_t i = path_.size(); i-- > 0;) {
        Arc& arc = arcs_[static_cast<std::size_t>(path_[i])];
        arc.capacity -= flow;
        arcs_[static_cast<std::size_t>(path_[i] ^ 1)].capacity += flow;
        if (arc.capacity <= least_capacity) left = i;
    }
    return left;
}

// Fills shortest paths until none is left or the limit on looks is reached. A node from which the
// sink cannot be reached loses its level.
void MinimumCut::fill_shortest_paths() {
    path_.clear();
    std::int32_t node = source_;
    while (looks_ < most_looks_) {
        if (node == sink_) {
            path_.resize(fill_path());
        } else if (const std::int32_t a = next_arc(node); a >= 0) {
            path_.push_back(a);
        } else {
            if (path_.empty()) return;
            level_[static_cast<std::size_t>(node)] = std::numeric_limits<std::int32_t>::max();
            path_.pop_back();
        }
        node = path_.empty() ? source_ : arcs_[static_cast<std::size_t>(path_.back())].to;
    }
}

std::int64_t MinimumCut::run(std::int64_t most_looks) {
    looks_ = 0;
    most_looks_ = most_looks;
    while (reaches_sink() && looks_ < most_looks_) {
        current_ = first_;
        fill_shortest_paths();
    }
    return looks_;
}

}  // namespace stormcellar::retrieve
