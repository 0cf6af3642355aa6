#include "render/products/rain_total_grid.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "retrieve/rain/rain_note.h"

namespace stormcellar::render {
namespace {

constexpr double most_unseen_share = 0.1;
constexpr double all_of_the_time = 0.999;

// Returns the place about which the columns are placed: the radar, or the center of a mosaic.
grid::SitePosition columns_about(const cache::GridDescription& description) {
    if (description.provenance.recipe == 0) return description.sites.front();
    return {"", description.spec.center_latitude_deg, description.spec.center_longitude_deg, 0};
}

}  // namespace

UtcTime middle_of(const cache::GridDescription& grid) {
    if (grid.provenance.recipe != 0 || grid.end_time <= grid.start_time) return grid.time;
    return grid.start_time + (grid.end_time - grid.start_time) / 2;
}

Status RainTotalGrid::add(const grid::BrickView& rate, const cache::GridDescription& description,
                          int threads) {
    const bool is_of_one_radar =
        description.sites.size() == 1 &&
        (volumes_ == 0 || description.sites[0].icao == description_.sites[0].icao);
    if (description.provenance.recipe == 0 && !is_of_one_radar)
        return fail(ErrorCode::bad_argument, "the files of a rain total must be of one radar");
    const UtcTime middle = middle_of(description);
    if (!total_) {
        total_.emplace(columns_about(description), retrieve::RainSteps::advected, threads, span_);
        first_ = middle;
    }
    if (Status added = total_->add(rate, middle); !added) return added;
    description_ = description;
    last_ = middle;
    ++volumes_;
    return {};
}

void RainTotalGrid::close() {
    if (total_) total_->close();
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
        const bool was_seen = unseen < all_of_the_time * total_->minutes();
        sum.status[column] = was_seen ? grid::CellStatus::ambiguous : grid::CellStatus::not_seen;
        sum.values[column] = 0;
    }
    return grid::BrickGrid::from(sum, grid::default_quantization(level2::Moment::rate));
}

cache::GridDescription RainTotalGrid::description() const {
    cache::GridDescription made = description_;
    made.spec = total_->spec();
    made.moment = level2::Moment::rate;
    made.time = span_ ? span_->to : last_;
    made.start_time = span_ ? span_->from : first_;
    const auto& unseen = total_->unseen_minutes();
    const auto all = static_cast<float>(all_of_the_time * total_->minutes());
    const auto partly = std::ranges::count_if(
        unseen, [&](float minutes) { return minutes > 0.01F && minutes < all; });
    made.provenance.notes.push_back(retrieve::rain_note({.from = made.start_time,
                                                         .minutes = total_->minutes(),
                                                         .gap_minutes = total_->gap_minutes(),
                                                         .volumes = volumes_,
                                                         .columns_partly_unseen = partly}));
    return made;
}

}  // namespace stormcellar::render
