#include "stormcellar/grid/brick_view.h"

#include <array>
#include <cstring>

namespace stormcellar::grid {
namespace {

std::size_t brick_of(const BrickView& view, int ix, int iy, int iz) {
    return view.brick_index(ix / brick_edge, iy / brick_edge, iz / brick_edge);
}

CellStatus stored_state(const BrickView& view, const BrickEntry& brick, std::size_t cell) {
    const std::size_t at = brick.status_index * state_block_bytes + cell / 4;
    const auto four_cells = static_cast<unsigned>(view.states[at]);
    return static_cast<CellStatus>((four_cells >> (2 * (cell % 4))) & 3U);
}

}  // namespace

std::string_view cell_status_name(CellStatus status) {
    constexpr std::array<std::string_view, cell_status_count> names = {
        "not_seen", "no_echo", "range_folded", "value", "unavailable", "ambiguous"};
    return names[static_cast<std::size_t>(status)];
}

std::vector<CellStatus> states_of(level2::Moment moment) {
    std::vector<CellStatus> states = {CellStatus::not_seen, CellStatus::no_echo,
                                      CellStatus::range_folded, CellStatus::value};
    if (level2::facts_of(moment).is_derived) states.push_back(CellStatus::ambiguous);
    return states;
}

std::uint16_t BrickView::code_at(std::size_t offset) const {
    if (quantization.code_bytes == 1) return static_cast<std::uint16_t>(codes[offset]);
    std::uint16_t code = 0;
    std::memcpy(&code, codes.data() + 2 * offset, sizeof code);
    return code;
}

CellStatus BrickView::status(int ix, int iy, int iz) const {
    const BrickEntry& brick = bricks[brick_of(*this, ix, iy, iz)];
    const std::size_t offset = offset_x(ix) + offset_y(iy) + offset_z(iz);
    switch (brick.kind) {
        case BrickKind::uniform:
            return brick.uniform_status;
        case BrickKind::status_only:
            return stored_state(*this, brick, offset % brick_cells);
        case BrickKind::stored:
            return quantization.status_of(code_at(offset));
    }
    return CellStatus::not_seen;
}

float BrickView::value(int ix, int iy, int iz) const {
    return quantization.value_of(code_at(offset_x(ix) + offset_y(iy) + offset_z(iz)));
}

}  // namespace stormcellar::grid
