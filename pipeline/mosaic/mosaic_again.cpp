// Makes damaged, removed or missing frames again from the partials in the store.
#include <algorithm>
#include <set>

#include "pipeline/mosaic/mapped_partials.h"
#include "pipeline/mosaic/mosaic_maker.h"
#include "stormcellar/base/version.h"
#include "stormcellar/cache/grid_file.h"

namespace stormcellar::pipeline {
namespace {

bool is_frame_time(UtcTime time, std::chrono::seconds interval) {
    return instants_between(time, time, interval).size() == 1;
}

auto no_domain(const cache::GridName& frame) {
    return fail(ErrorCode::not_found, "the configuration has no domain {} of {}", frame.domain,
                level2::moment_name(frame.moment));
}

// When the volumes of the existing partials began.
Result<std::set<UtcTime>> starts_of(const cache::StoreReader& store, const Domain& domain,
                                    level2::Moment moment) {
    std::set<UtcTime> starts;
    const auto domains = partial_domains(store, domain.name);
    if (!domains) return pass_on(domains);
    for (const std::string& name : *domains) {
        const auto entries = store.list(name, moment, std::nullopt, std::nullopt);
        if (!entries) return pass_on(entries);
        for (const cache::StoreEntry& entry : *entries)
            starts.insert(entry.time);
    }
    return starts;
}

// Returns true if the instant is between two partials of which one counts for it, as in take_in().
bool lies_between(const std::vector<PartialView>& partials, UtcTime instant) {
    bool any_before = false, any_after = false;
    for (const PartialView& partial : partials) {
        any_before = any_before || partial.middle() <= instant;
        any_after = any_after || partial.middle() >= instant;
    }
    return any_before && any_after;
}

Result<bool> is_due(const cache::StoreReader& store, const Domain& domain, level2::Moment moment,
                    UtcTime instant) {
    std::vector<std::string> ignored;
    const auto partials = MappedPartials::open(store, domain, moment, instant, instant, ignored);
    if (!partials) return pass_on(partials);
    return lies_between(partials->views(), instant);
}

}  // namespace

const Domain* MosaicMaker::find(std::string_view name, level2::Moment moment) const {
    for (const Domain& domain : domains_) {
        const auto& moments = domain.moments;
        const bool has = std::find(moments.begin(), moments.end(), moment) != moments.end();
        if (domain.name == name && has) return &domain;
    }
    return nullptr;
}

Result<FrameStanding> MosaicMaker::standing_of(const cache::GridName& frame) const {
    const Domain* domain = find(frame.domain, frame.moment);
    if (domain == nullptr || store_ == nullptr) return no_domain(frame);
    std::vector<std::string> ignored;
    const auto partials =
        MappedPartials::open(*store_, *domain, frame.moment, frame.time, frame.time, ignored);
    if (!partials) return pass_on(partials);
    const auto views = partials->views();
    if (!lies_between(views, frame.time)) return FrameStanding::not_due;
    const auto recipe =
        recipe_for(domain->spec, views, frame.time, frame_options(*domain, frame.moment, 1));
    if (!recipe) {
        if (recipe.error().code == ErrorCode::not_found) return FrameStanding::not_due;
        return pass_on(recipe);
    }
    const auto path = store_->path_of(frame.domain, frame.moment, frame.time);
    if (!path) return pass_on(path);
    const auto stands = cache::GridFile::open(*path);
    if (!stands) return FrameStanding::to_make;
    const grid::Provenance& made_of = stands->description().provenance;
    const bool is_current = stands->description().spec == domain->spec &&
                            made_of.parts == recipe->parts && made_of.recipe == recipe->recipe &&
                            made_of.software_version == software_version;
    return is_current ? FrameStanding::current : FrameStanding::to_make;
}

Result<FrameMade> MosaicMaker::make_again(const cache::GridName& frame, int threads,
                                          std::vector<std::string>& problems) {
    const Domain* domain = find(frame.domain, frame.moment);
    if (domain == nullptr || store_ == nullptr) return no_domain(frame);
    if (!is_frame_time(frame.time, domain->interval)) {
        return fail(ErrorCode::bad_argument, "{} has frames every {} s, so none at {}",
                    domain->name, domain->interval.count(), format_utc(frame.time));
    }
    const std::scoped_lock lock(frames_of(domain->name, frame.moment));
    auto partials =
        MappedPartials::open(*store_, *domain, frame.moment, frame.time, frame.time, problems);
    if (!partials) return pass_on(partials);
    return make({*domain, frame.moment, frame.time, threads}, *partials, problems);
}

Status MosaicMaker::add_missing(const Domain& domain, level2::Moment moment,
                                std::chrono::milliseconds newest,
                                std::vector<cache::GridName>& all) const {
    const auto starts = starts_of(*store_, domain, moment);
    if (!starts) return pass_on(starts);
    if (starts->empty()) return {};
    const auto frames = store_->list(domain.name, moment, std::nullopt, std::nullopt);
    if (!frames) return pass_on(frames);
    std::set<UtcTime> standing;
    for (const cache::StoreEntry& frame : *frames)
        standing.insert(frame.time);
    UtcTime from = std::max(*starts->begin(), *starts->rbegin() - newest);
    if (!standing.empty()) from = std::max(from, *standing.begin());
    const UtcTime to = *starts->rbegin() + longest_to_middle;
    for (const UtcTime instant : instants_between(from, to, domain.interval)) {
        if (standing.contains(instant)) continue;
        const auto near = starts->lower_bound(instant - greatest_frame_gap - longest_to_middle);
        if (near == starts->end() || *near > instant + greatest_frame_gap) continue;
        const auto due = is_due(*store_, domain, moment, instant);
        if (!due) return pass_on(due);
        if (*due) all.push_back({domain.name, moment, instant});
    }
    return {};
}

Result<std::vector<cache::GridName>> MosaicMaker::missing_frames(
    std::chrono::milliseconds newest) const {
    std::vector<cache::GridName> all;
    if (is_idle()) return all;
    for (const Domain& domain : domains_) {
        for (const level2::Moment moment : domain.moments) {
            if (Status added = add_missing(domain, moment, newest, all); !added) {
                return pass_on(added);
            }
        }
    }
    std::stable_sort(
        all.begin(), all.end(),
        [](const cache::GridName& a, const cache::GridName& b) { return a.time > b.time; });
    return all;
}

}  // namespace stormcellar::pipeline
