#include "stormcellar/grid/brick_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/checksum.h"
#include "base/floating_point.h"
#include "base/parallel.h"
#include "grid/cells/nearest_code.h"

namespace stormcellar::grid {
namespace {

// Each thread has several pieces of work, because storms make some bricks costlier than others.
constexpr int pieces_a_thread = 4;

// Returns the nearest code. Clamps a value beyond the range of codes to the end of the range, and
// counts it.
std::uint16_t code_of(float value, const Quantization& quantization, std::uint64_t& clamped) {
    const double code = nearest_code(value, quantization);
    if (is_within<double>(code, quantization.first_code(), quantization.largest_code())) {
        return static_cast<std::uint16_t>(code);
    }
    ++clamped;
    return std::isgreater(code, double{first_value_code}) ? quantization.largest_code()
                                                          : quantization.first_code();
}

// Reads one brick of cells as codes. Places beyond the edge of the grid remain 0.
template <class Code>
class BrickReader {
  public:
    BrickReader(const Grid& grid, const Quantization& quantization)
        : grid_(grid), quantization_(quantization) {}

    void read(int bx, int by, int bz, const BrickExtent& extent) {
        if (extent.cells() < static_cast<int>(brick_cells)) codes_.fill(0);
        const GridSpec& spec = grid_.spec;
        for (int x = 0; x < extent.x; ++x) {
            for (int y = 0; y < extent.y; ++y) {
                const std::size_t from =
                    spec.index(bx * brick_edge + x, by * brick_edge + y, bz * brick_edge);
                read_column(from, extent.z, codes_.data() + brick_edge * (brick_edge * x + y));
            }
        }
    }
    [[nodiscard]] const Code* codes() const { return codes_.data(); }
    [[nodiscard]] std::uint64_t clamped_count() const { return clamped_; }

  private:
    void read_column(std::size_t from, int height, Code* to) {
        const CellStatus* status = grid_.status.data() + from;
        if (height == brick_edge) {
            if (!copy_states<brick_edge>(status, to)) return;
        } else {
            bool has_value = false;
            for (int z = 0; z < height; ++z)
                has_value |= copy_states<1>(status + z, to + z);
            if (!has_value) return;
        }
        const float* values = grid_.values.data() + from;
        for (int z = 0; z < height; ++z) {
            if (status[z] == CellStatus::value) {
                to[z] = static_cast<Code>(code_of(values[z], quantization_, clamped_));
            }
        }
    }

    // Copies the states. Writes ambiguous (5) as code 3. Returns true if one of the states is a
    // value (3).
    template <int count>
    static bool copy_states(const CellStatus* status, Code* to) {
        std::uint8_t largest = 0;
        for (int z = 0; z < count; ++z) {
            const auto state = static_cast<std::uint8_t>(status[z]);
            largest |= static_cast<std::uint8_t>(state & (state >> 1));
            to[z] = static_cast<std::uint8_t>(state - 2 * (state >> 2));
        }
        return largest != 0;
    }

    const Grid& grid_;
    const Quantization& quantization_;
    std::array<Code, brick_cells> codes_{};
    std::uint64_t clamped_ = 0;
};

// Counts the cells of a brick by state. Places beyond the extent count as not seen, because their
// code is 0.
struct CodeCounts {
    std::size_t not_seen = 0;
    std::size_t no_echo = 0;
    std::size_t range_folded = 0;
    std::uint16_t smallest = 65535;  // the smallest code of a cell with a value
    std::uint16_t largest = 0;
    [[nodiscard]] std::size_t values() const {
        return brick_cells - not_seen - no_echo - range_folded;
    }
};

// Returns how many codes equal `wanted`. Counts in rows of 128 codes, so that a counter needs only
// one byte.
template <class Code>
std::size_t count_of(const Code* codes, Code wanted) {
    constexpr std::size_t row = 128;
    std::size_t count = 0;
    for (const Code* first = codes; first != codes + brick_cells; first += row) {
        Code in_row = 0;
        for (std::size_t i = 0; i < row; ++i)
            in_row = static_cast<Code>(in_row + static_cast<Code>(first[i] == wanted));
        count += in_row;
    }
    return count;
}

// Each count has a loop of its own, because the compiler vectorizes such loops. The compiler does
// not vectorize a single loop for all counts, so such a loop took ten times as many instructions.
template <class Code>
CodeCounts count_codes(const Code* codes) {
    CodeCounts counts;
    counts.not_seen = count_of(codes, Code{0});
    counts.no_echo = count_of(codes, Code{1});
    counts.range_folded = count_of(codes, Code{2});
    // Subtract first_value_code, so that codes of values start at 0. Codes of states then wrap
    // around and are larger.
    const auto wrapped = [](Code code) { return static_cast<Code>(code - first_value_code); };
    Code smallest = wrapped(0);
    for (std::size_t i = 0; i < brick_cells; ++i)
        smallest = wrapped(codes[i]) < smallest ? wrapped(codes[i]) : smallest;
    Code largest = 0;
    for (std::size_t i = 0; i < brick_cells; ++i)
        largest = codes[i] > largest ? codes[i] : largest;
    counts.smallest = static_cast<std::uint16_t>(smallest + first_value_code);
    counts.largest = largest;
    return counts;
}

template <class Code>
std::array<std::byte, state_block_bytes> pack_states(const Code* codes) {
    std::array<std::byte, state_block_bytes> packed;
    for (std::size_t i = 0; i < packed.size(); ++i, codes += 4) {
        packed[i] =
            static_cast<std::byte>(codes[0] | codes[1] << 2 | codes[2] << 4 | codes[3] << 6);
    }
    return packed;
}

template <class Code>
void read_columns(const Grid& grid, const BrickView& shape, int begin_x, int end_x,
                  BricksWriter& writer) {
    BrickReader<Code> reader(grid, shape.quantization);
    auto index = static_cast<std::size_t>(begin_x) * static_cast<std::size_t>(shape.bricks_y) *
                 static_cast<std::size_t>(shape.bricks_z);
    for (int bx = begin_x; bx < end_x; ++bx) {
        for (int by = 0; by < shape.bricks_y; ++by) {
            for (int bz = 0; bz < shape.bricks_z; ++bz, ++index) {
                const BrickExtent extent = brick_extent(grid.spec, bx, by, bz);
                reader.read(bx, by, bz, extent);
                writer.put_codes(index, reader.codes(), extent);
            }
        }
    }
    writer.count_clamped(reader.clamped_count());
}

// Fills the grid in pieces along x. Each writer gets the next piece, so that the states of all
// writers together are in order.
template <class Code>
void read_all(const Grid& grid, int threads, BrickGrid& made) {
    const BrickView shape = made.view();
    const int pieces = threads <= 1 ? 1 : std::min(shape.bricks_x, pieces_a_thread * threads);
    std::vector<BricksWriter> writers(static_cast<std::size_t>(pieces), BricksWriter(made));
    for_each_piece(pieces, threads, [&](int piece) {
        read_columns<Code>(grid, shape, shape.bricks_x * piece / pieces,
                           shape.bricks_x * (piece + 1) / pieces,
                           writers[static_cast<std::size_t>(piece)]);
    });
    made.finish(writers);
}

}  // namespace

BrickExtent brick_extent(const GridSpec& spec, int bx, int by, int bz) {
    const auto along = [](int brick, int cells) {
        return std::min(brick_edge, cells - brick * brick_edge);
    };
    return {along(bx, spec.nx), along(by, spec.ny), along(bz, spec.nz())};
}

BrickGrid::BrickGrid(GridSpec spec, const Quantization& quantization)
    : spec_(std::move(spec)), quantization_(quantization) {
    bricks_.resize(static_cast<std::size_t>(bricks_along(spec_.nx)) *
                   static_cast<std::size_t>(bricks_along(spec_.ny)) *
                   static_cast<std::size_t>(bricks_along(spec_.nz())));
    codes_ = SparseBytes(bricks_.size() * brick_cells *
                         static_cast<std::size_t>(quantization.code_bytes));
}

BrickGrid BrickGrid::from(const Grid& grid, const Quantization& quantization, int threads) {
    BrickGrid made(grid.spec, quantization);
    if (quantization.code_bytes == 1) {
        read_all<std::uint8_t>(grid, threads, made);
    } else {
        read_all<std::uint16_t>(grid, threads, made);
    }
    return made;
}

void BrickGrid::finish(std::span<BricksWriter> writers) {
    std::size_t size = 0;
    for (const BricksWriter& writer : writers)
        size += writer.states_.size();
    states_.reserve(size);
    for (BricksWriter& writer : writers) {
        auto block = static_cast<std::uint32_t>(states_.size() / state_block_bytes);
        for (const std::size_t brick : writer.bricks_with_states_)
            bricks_[brick].status_index = block++;
        states_.insert(states_.end(), writer.states_.begin(), writer.states_.end());
        clamped_count_ += writer.clamped_count_;
        writer = BricksWriter(*this);
    }
}

BrickView BrickGrid::view() const {
    BrickView view;
    view.spec = &spec_;
    view.quantization = quantization_;
    view.bricks_x = bricks_along(spec_.nx);
    view.bricks_y = bricks_along(spec_.ny);
    view.bricks_z = bricks_along(spec_.nz());
    view.codes = codes_.bytes();
    view.bricks = bricks_;
    view.states = states_;
    return view;
}

void BrickGrid::clear(std::size_t brick) {
    BrickEntry& entry = bricks_[brick];
    if (entry.kind == BrickKind::stored) {
        const std::size_t size = brick_cells * static_cast<std::size_t>(quantization_.code_bytes);
        std::memset(codes_.data() + brick * size, 0, size);
    }
    entry = {};
}

void BrickGrid::finish_again(std::span<BricksWriter> writers) {
    const std::vector<std::byte> old_states = std::move(states_);
    states_.clear();
    std::size_t count = 0;
    for (const BricksWriter& writer : writers)
        count += writer.bricks_with_states_.size();
    // While a grid is written, the status_index of a brick that was written is an index in the new
    // blocks. The status_index of any other brick is an index in the old blocks.
    std::vector<const std::byte*> new_blocks;
    new_blocks.reserve(count);
    std::vector<bool> is_new(bricks_.size());
    for (const BricksWriter& writer : writers) {
        const std::byte* block = writer.states_.data();
        for (const std::size_t brick : writer.bricks_with_states_) {
            is_new[brick] = true;
            bricks_[brick].status_index = static_cast<std::uint32_t>(new_blocks.size());
            new_blocks.push_back(block);
            block += state_block_bytes;
        }
        clamped_count_ += writer.clamped_count_;
    }
    const auto has_states = [](const BrickEntry& entry) {
        return entry.kind == BrickKind::status_only;
    };
    const auto all = std::count_if(bricks_.begin(), bricks_.end(), has_states);
    states_.reserve(static_cast<std::size_t>(all) * state_block_bytes);
    std::uint32_t next = 0;
    for (std::size_t brick = 0; brick < bricks_.size(); ++brick) {
        BrickEntry& entry = bricks_[brick];
        if (!has_states(entry)) continue;
        const std::byte* block = is_new[brick]
                                     ? new_blocks[entry.status_index]
                                     : old_states.data() + entry.status_index * state_block_bytes;
        states_.insert(states_.end(), block, block + state_block_bytes);
        entry.status_index = next++;
    }
    for (BricksWriter& writer : writers)
        writer = BricksWriter(*this);
}

void BricksWriter::put_uniform(std::size_t brick, CellStatus status) {
    grid_->bricks_[brick].uniform_status = status;
}

template <class Code>
void BricksWriter::put_codes(std::size_t brick, const Code* codes, const BrickExtent& extent) {
    const bool all_alike = std::memcmp(codes, codes + 1, (brick_cells - 1) * sizeof(Code)) == 0;
    if (all_alike && codes[0] < first_value_code) {
        return put_uniform(brick, static_cast<CellStatus>(codes[0]));
    }
    const CodeCounts counts = count_codes(codes);
    const auto cells = static_cast<std::size_t>(extent.cells());
    BrickEntry& entry = grid_->bricks_[brick];
    if (counts.values() > 0) {
        entry.kind = BrickKind::stored;
        entry.value_count = static_cast<std::uint16_t>(counts.values());
        entry.min_code = counts.smallest;
        entry.max_code = counts.largest;
        std::byte* place = grid_->codes_.data() + brick * brick_cells * sizeof(Code);
        std::memcpy(place, codes, brick_cells * sizeof(Code));
        entry.checksum = xxh3_64({place, brick_cells * sizeof(Code)});
    } else if (counts.no_echo == cells) {
        entry.uniform_status = CellStatus::no_echo;
    } else if (counts.range_folded == cells) {
        entry.uniform_status = CellStatus::range_folded;
    } else if (counts.not_seen < brick_cells) {
        const auto packed = pack_states(codes);
        add_states(brick, packed, xxh3_64(packed));
    }
}
template void BricksWriter::put_codes(std::size_t, const std::uint8_t*, const BrickExtent&);
template void BricksWriter::put_codes(std::size_t, const std::uint16_t*, const BrickExtent&);

void BricksWriter::put_states(std::size_t brick, std::span<const std::byte> states,
                              const BrickExtent& extent) {
    std::array<std::size_t, 3> counts{};
    for (const std::byte four : states) {
        const auto bits = std::to_integer<unsigned>(four);
        for (unsigned shift = 0; shift < 8; shift += 2)
            ++counts[(bits >> shift) & 3U];
    }
    const auto cells = static_cast<std::size_t>(extent.cells());
    if (counts[0] == brick_cells) return;
    if (counts[1] == cells) return put_uniform(brick, CellStatus::no_echo);
    if (counts[2] == cells) return put_uniform(brick, CellStatus::range_folded);
    add_states(brick, states, xxh3_64(states));
}

void BricksWriter::copy(std::size_t brick, const BrickView& from, std::size_t from_brick) {
    const BrickEntry& source = from.bricks[from_brick];
    if (source.kind == BrickKind::status_only) {
        const auto states =
            from.states.subspan(source.status_index * state_block_bytes, state_block_bytes);
        return add_states(brick, states, source.checksum);
    }
    grid_->bricks_[brick] = source;
    // The value copied into packed_bytes is a length in the source's file, so drop it.
    grid_->bricks_[brick].packed_bytes = 0;
    if (source.kind == BrickKind::uniform) return;
    const std::size_t size = brick_cells * static_cast<std::size_t>(from.quantization.code_bytes);
    std::memcpy(grid_->codes_.data() + brick * size, from.codes.data() + from_brick * size, size);
}

void BricksWriter::add_states(std::size_t brick, std::span<const std::byte> states,
                              std::uint64_t checksum) {
    BrickEntry& entry = grid_->bricks_[brick];
    entry.kind = BrickKind::status_only;
    entry.checksum = checksum;
    states_.insert(states_.end(), states.begin(), states.end());
    bricks_with_states_.push_back(brick);
}

Grid to_dense(const BrickView& view) {
    Grid grid;
    grid.spec = *view.spec;
    grid.values.resize(grid.spec.cell_count());
    grid.status.resize(grid.spec.cell_count());
    for (int iy = 0; iy < grid.spec.ny; ++iy) {
        for (int ix = 0; ix < grid.spec.nx; ++ix) {
            for (int iz = 0; iz < grid.spec.nz(); ++iz) {
                const std::size_t cell = grid.spec.index(ix, iy, iz);
                grid.status[cell] = view.status(ix, iy, iz);
                if (grid.status[cell] == CellStatus::value) {
                    grid.values[cell] = view.value(ix, iy, iz);
                }
            }
        }
    }
    return grid;
}

}  // namespace stormcellar::grid
