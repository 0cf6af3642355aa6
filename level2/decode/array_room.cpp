#include "level2/decode/array_room.h"

#include <algorithm>

namespace stormcellar::level2 {

std::uint64_t bytes_of(const Vcp& vcp) {
    return sizeof(Vcp) + vcp.cuts.size() * sizeof(VcpCut);
}

tl::unexpected<Error> no_memory() {
    return fail(ErrorCode::exhausted, "there is not enough memory for it");
}

std::uint64_t ArrayRoom::left_bytes() const {
    return limit_bytes_ - std::min(limit_bytes_, taken_bytes());
}

bool ArrayRoom::ask_for_more() {
    if (!more_) return true;
    const std::uint64_t limit = std::exchange(more_, {})();
    if (limit != 0) limit_bytes_ = limit;
    return limit != 0;
}

bool ArrayRoom::holds() {
    if (sweep_bytes() > most_sweep_bytes) return false;
    if (taken_bytes() > limit_bytes_) ask_for_more();
    return taken_bytes() <= limit_bytes_;
}

bool ArrayRoom::add(std::uint64_t bytes) {
    closed_bytes_ += bytes;
    return holds();
}

void ArrayRoom::continue_sweep() {
    closed_bytes_ += sweep_bytes();
    radials_ = 0;
    row_bytes_ = sizeof(Radial);
    kind_bytes_ = 0;
    gates_.clear();
}

bool ArrayRoom::begin_sweep() {
    continue_sweep();
    kind_bytes_ = empty_kind_bytes;
    return add(empty_sweep_bytes);
}

bool ArrayRoom::add_radials(std::size_t count) {
    radials_ += count;
    return holds();
}

bool ArrayRoom::widen(std::size_t moment, std::size_t gates, std::uint64_t bytes_per_code) {
    if (moment >= gates_.size()) {
        // Each row has its number of gates beside its codes.
        row_bytes_ += (moment + 1 - gates_.size()) * sizeof(std::uint16_t);
        gates_.resize(moment + 1);
    } else if (gates <= gates_[moment]) {
        return true;
    }
    if (gates > gates_[moment]) {
        row_bytes_ += (gates - gates_[moment]) * bytes_per_code;
        gates_[moment] = gates;
    }
    return holds();
}

void ArrayRoom::clear() {
    continue_sweep();
    closed_bytes_ = 0;
}

}  // namespace stormcellar::level2
