#include "level2/live/open_sweep.h"

#include "level2/decode/fragment_builder.h"
#include "level2/decode/volume_builder.h"

namespace stormcellar::level2 {
namespace {

// Groups pieces, which must be added in order, into sweeps.
class Grouper {
  public:
    void begin_chunk(const LiveChunk& chunk) {
        header_between_ = header_between_ || (chunk.header && !first_chunk_);
        first_chunk_ = false;
        chunk_ = &chunk;
        serial_ = chunk.serial;
        place_ = 0;
    }
    void note(const FragmentMarks& marks) {
        if (!marks.patterns.empty()) {
            pattern_ = &marks.patterns.back();
            pattern_id_ = {serial_ + 1, 0};
        }
        header_between_ = header_between_ || marks.header.has_value();
    }
    void add(const Fragment::Piece& piece) {
        note(piece.before);
        const bool continues =
            previous_ != nullptr && !header_between_ && continues_sweep(*previous_, piece);
        if (!continues && !sweeps_.empty()) sweeps_.back().closed = true;
        previous_ = &piece;
        header_between_ = false;
        const OpenSweep::PieceId id{serial_, place_++};
        if (piece.left_out) return;
        if (!continues) sweeps_.push_back({{}, {pattern_id_}, pattern_, false});
        OpenSweep& sweep = sweeps_.back();
        sweep.pieces.push_back({&piece, chunk_, id.second});
        sweep.ids.push_back(id);
        sweep.closed = ends_sweep(piece.sweep.radials.back());
    }
    [[nodiscard]] std::vector<OpenSweep> take() { return std::move(sweeps_); }

  private:
    std::vector<OpenSweep> sweeps_;
    const Vcp* pattern_ = nullptr;
    OpenSweep::PieceId pattern_id_{};  // the chunk that gave `pattern_`; 0: no pattern
    const Fragment::Piece* previous_ = nullptr;
    bool header_between_ = false;
    bool first_chunk_ = true;
    const LiveChunk* chunk_ = nullptr;
    std::uint64_t serial_ = 0;
    std::size_t place_ = 0;
};

}  // namespace

std::vector<OpenSweep> sweeps_of(const std::map<int, LiveChunk>& chunks) {
    Grouper grouper;
    for (const auto& [number, chunk] : chunks) {
        grouper.begin_chunk(chunk);
        for (const Fragment& fragment : chunk.fragments) {
            for (const Fragment::Piece& piece : fragment.pieces)
                grouper.add(piece);
            grouper.note(fragment.behind);
        }
    }
    return grouper.take();
}

Result<Sweep> join(const OpenSweep& open, std::uint64_t limit_bytes, const SweepDepot* depot) {
    VolumeBuilder builder{limit_bytes};
    const Vcp* pattern = open.pattern;
    for (const auto& [piece, chunk, place] : open.pieces) {
        Result<Sweep> sweep = whole_piece(*chunk, place, *piece, depot);
        if (!sweep) return sweep;
        Fragment fragment;
        fragment.pieces.push_back({{}, std::move(*sweep), piece->vcp, false});
        if (pattern != nullptr) fragment.pieces.front().before.patterns = {*pattern};
        pattern = nullptr;
        if (!builder.append(std::move(fragment))) return Sweep{};
    }
    return builder.so_far().sweeps.empty() ? Sweep{} : builder.whole_sweep(0);
}

}  // namespace stormcellar::level2
