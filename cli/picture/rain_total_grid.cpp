#include "cli/picture/rain_total_grid.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "render/options/scene_options.h"

namespace stormcellar::cli {
namespace {

constexpr double most_unseen_share = 0.1;

UtcTime middle_of(const cache::GridDescription& description) {
    return description.start_time + (description.end_time - description.start_time) / 2;
}

}  // namespace

Status RainTotalGrid::add(const grid::BrickView& view, const cache::GridDescription& description,
                          int threads) {
    const bool is_of_one_radar =
        description.sites.size() == 1 &&
        (volumes_ == 0 || description.sites[0].icao == description_.sites[0].icao);
    if (!is_of_one_radar)
        return fail(ErrorCode::bad_argument, "the files of a rain total must be of one radar");
    if (!total_) {
        total_.emplace(description.sites[0], retrieve::RainSteps::advected, threads);
        since_ = description.time;
    }
    if (Status added = total_->add(view, middle_of(description)); !added) return added;
    description_ = description;
    ++volumes_;
    return {};
}

Result<grid::BrickGrid> RainTotalGrid::bricks() const {
    if (volumes_ < 2)
        return fail(ErrorCode::bad_argument, "a rain total needs at least two volumes");
    grid::Grid sum;
    sum.spec = total_->spec();
    sum.moment = level2::Moment::rate;
    sum.values = total_->mm();
    sum.status.assign(sum.values.size(), grid::CellStatus::value);
    for (std::size_t column = 0; column < sum.values.size(); ++column) {
        const double unseen = static_cast<double>(total_->unseen_minutes()[column]);
        if (unseen <= most_unseen_share * total_->minutes()) continue;
        const bool was_seen = unseen < 0.999 * total_->minutes();
        sum.status[column] = was_seen ? grid::CellStatus::ambiguous : grid::CellStatus::not_seen;
        sum.values[column] = 0;
    }
    return grid::BrickGrid::from(sum, grid::default_quantization(level2::Moment::rate));
}

cache::GridDescription RainTotalGrid::description() const {
    cache::GridDescription made = description_;
    made.spec = total_->spec();
    const auto& unseen = total_->unseen_minutes();
    const auto all = static_cast<float>(0.999 * total_->minutes());
    const auto partly = std::ranges::count_if(
        unseen, [&](float minutes) { return minutes > 0.01F && minutes < all; });
    made.provenance.notes.push_back(render::track_note(since_));
    made.provenance.notes.push_back(fmt::format(
        "rain of {:.0f} minutes and {} volumes; {} columns were not seen for a part of them",
        total_->minutes(), volumes_, partly));
    return made;
}

}  // namespace stormcellar::cli
