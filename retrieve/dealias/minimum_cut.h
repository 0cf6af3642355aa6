// retrieve/dealias/minimum_cut.h -- finds the minimum cut of a graph with a source and a sink.
//
// Source   Dinic (1970). Time is at most of order nodes^2 x edges, and near linear for the sparse
//          graphs of dealiasing.
// Threads  One thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace stormcellar::retrieve {

class MinimumCut {
  public:
    explicit MinimumCut(std::int32_t nodes);
    // Makes the cut cost `cost` if the node is on the sink's side. A negative `cost` makes it cost
    // -cost if the node is on the source's side.
    void prefer_source(std::int32_t node, float cost);
    // Makes the cut cost `cost` if `from` is on the source's side and `to` on the sink's side.
    void connect(std::int32_t from, std::int32_t to, float cost);
    // Computes the cut, after which on_source_side() is valid. Stops after looking at about
    // `most_looks` arcs; the cut may then not be the smallest. Returns the number of arcs looked
    // at, counting repetitions.
    std::int64_t run(std::int64_t most_looks);
    [[nodiscard]] bool on_source_side(std::int32_t node) const {
        return level_[static_cast<std::size_t>(node)] >= 0;
    }

  private:
    struct Arc {
        std::int32_t to, next;
        float capacity;
    };
    void add(std::int32_t from, std::int32_t to, float capacity);
    bool reaches_sink();
    std::int32_t next_arc(std::int32_t node);
    std::size_t fill_path();
    void fill_shortest_paths();

    std::int32_t source_, sink_;
    std::int64_t looks_ = 0, most_looks_ = 0;
    std::vector<Arc> arcs_;  // an arc and its reverse are neighbors
    std::vector<std::int32_t> first_, current_, level_, queue_, path_;
};

}  // namespace stormcellar::retrieve
