#include "render/volume/block_codes.h"

#include <algorithm>

#include "stormcellar/grid/brick_view.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/volume/block_codes.cpp"
#include <hwy/foreach_target.h>
// This include must come after foreach_target.h, which compiles this file once for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace stormcellar::render::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Subtracting the first value code makes the codes of states wrap to the top of the range, where no
// value is.
template <class Code>
void find_in(const std::byte* bytes, int edge, BlockCodes& found) {
    constexpr int row_cells = grid::brick_edge;
    const hn::CappedTag<Code, row_cells> d;
    const auto lanes = static_cast<int>(hn::Lanes(d));
    const Code* codes = reinterpret_cast<const Code*>(bytes);
    const auto first_value = hn::Set(d, static_cast<Code>(grid::first_value_code));
    const int across = row_cells / edge;
    found.across = across;
    std::size_t block = 0;
    for (int x = 0; x < row_cells; x += edge) {
        for (int y = 0; y < row_cells; y += edge) {
            HWY_ALIGN Code least[row_cells], largest[row_cells];
            for (int z = 0; z < row_cells; z += lanes) {
                auto low = hn::Set(d, static_cast<Code>(-1));
                auto high = hn::Zero(d);
                for (int i = x; i < x + edge; ++i) {
                    for (int j = y; j < y + edge; ++j) {
                        const auto cells =
                            hn::LoadU(d, codes + (i * row_cells + j) * row_cells + z);
                        low = hn::Min(low, hn::Sub(cells, first_value));
                        high = hn::Max(high, cells);
                    }
                }
                hn::Store(low, d, least + z);
                hn::Store(high, d, largest + z);
            }
            for (int z = 0; z < row_cells; z += edge, ++block) {
                const Code lowest = *std::min_element(least + z, least + z + edge);
                found.least[block] = static_cast<std::uint16_t>(lowest + grid::first_value_code);
                found.largest[block] = *std::max_element(largest + z, largest + z + edge);
            }
        }
    }
}

void find_in_brick(const std::byte* codes, int code_bytes, int edge, BlockCodes& found) {
    code_bytes == 1 ? find_in<std::uint8_t>(codes, edge, found)
                    : find_in<std::uint16_t>(codes, edge, found);
}

}  // namespace stormcellar::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stormcellar::render {

HWY_EXPORT(find_in_brick);

void find_block_codes(const std::byte* codes, int code_bytes, int edge, BlockCodes& found) {
    HWY_DYNAMIC_DISPATCH(find_in_brick)(codes, code_bytes, edge, found);
}

}  // namespace stormcellar::render
#endif
