#include "stormcellar/grid/cell_details.h"

#include <algorithm>

namespace stormcellar::grid {

std::string_view detail_name(Detail detail) {
    constexpr std::array<std::string_view, all_details.size()> names = {"age", "height_offset",
                                                                        "distance", "weight"};
    return names[static_cast<std::size_t>(detail)];
}

std::optional<Detail> detail_from_name(std::string_view name) {
    const auto* const found =
        std::find_if(all_details.begin(), all_details.end(),
                     [&](Detail detail) { return detail_name(detail) == name; });
    if (found == all_details.end()) return std::nullopt;
    return *found;
}

CellDetails::CellDetails(DetailSet set, std::size_t cells) : set_(set) {
    if (!set.any()) return;
    known_.resize(cells);
    for (const Detail detail : all_details) {
        if (set.has(detail)) values_[static_cast<std::size_t>(detail)].resize(cells);
    }
}

std::optional<float> CellDetails::at(Detail detail, std::size_t cell) const {
    const bool is_known = set_.has(detail) && (known_[cell] & DetailSet::bit_of(detail)) != 0;
    if (!is_known) return std::nullopt;
    return values_[static_cast<std::size_t>(detail)][cell];
}

void CellDetails::put(Detail detail, std::size_t cell, float value) {
    values_[static_cast<std::size_t>(detail)][cell] = value;
    known_[cell] = static_cast<std::uint8_t>(known_[cell] | DetailSet::bit_of(detail));
}

}  // namespace stormcellar::grid
