#include "cli/picture/rotation_track.h"

#include <utility>

#include "render/options/scene_options.h"
#include "stormcellar/retrieve/velocity_shear.h"

namespace stormcellar::cli {
namespace {

void take_larger(const grid::Grid& from, grid::Grid& to) {
    for (std::size_t i = 0; i < to.status.size(); ++i) {
        const int known = retrieve::knowledge(from.status[i]);
        const int known_before = retrieve::knowledge(to.status[i]);
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
