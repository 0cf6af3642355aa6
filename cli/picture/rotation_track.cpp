#include "cli/picture/rotation_track.h"

#include <utility>

#include "render/options/scene_options.h"

namespace stormcellar::cli {
namespace {

using grid::CellStatus;

int knowledge_of(CellStatus status) {
    switch (status) {
        case CellStatus::not_seen:
            return 0;
        case CellStatus::range_folded:
        case CellStatus::ambiguous:
            return 1;
        case CellStatus::no_echo:
            return 2;
        case CellStatus::value:
            return 3;
    }
    return 0;
}

void take_larger(const grid::Grid& from, grid::Grid& to) {
    for (std::size_t i = 0; i < to.status.size(); ++i) {
        const int known = knowledge_of(from.status[i]), known_before = knowledge_of(to.status[i]);
        const bool is_larger = known == known_before && from.values[i] > to.values[i];
        if (known <= known_before && !is_larger) continue;
        to.status[i] = from.status[i];
        to.values[i] = from.values[i];
    }
}

bool is_of_same_radar(const cache::GridDescription& a, const cache::GridDescription& b) {
    return a.spec == b.spec && a.sites.size() == 1 && b.sites.size() == 1 &&
           a.sites[0].icao == b.sites[0].icao;
}

}  // namespace

Status RotationTrack::add(const grid::BrickView& view, const cache::GridDescription& description,
                          int threads) {
    grid::Grid next = grid::to_dense(view);
    if (!bricks_) {
        largest_ = std::move(next);
        since_ = description.time;
    } else if (is_of_same_radar(description_, description)) {
        take_larger(next, largest_);
    } else {
        return fail(ErrorCode::bad_argument,
                    "the grids of rotation tracks must have the same radar, place and size; give "
                    "--center to files of one station");
    }
    description_ = description;
    description_.provenance.notes.push_back(render::track_note(since_));
    bricks_ = grid::BrickGrid::from(largest_, view.quantization, threads);
    return {};
}

}  // namespace stormcellar::cli
