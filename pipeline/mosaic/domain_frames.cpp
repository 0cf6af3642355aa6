#include "pipeline/mosaic/domain_frames.h"

#include <algorithm>
#include <set>
#include <string>

#include "pipeline/mosaic/mapped_partials.h"
#include "stormcellar/base/version.h"
#include "stormcellar/cache/grid_file.h"

namespace stormcellar::pipeline {
namespace {

// Returns the starts of all volumes that have partials.
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

Result<bool> is_due(const cache::StoreReader& store, const Domain& domain, level2::Moment moment,
                    UtcTime instant) {
    std::vector<std::string> ignored;
    const auto partials = MappedPartials::open(store, domain, moment, instant, instant, ignored);
    if (!partials) return pass_on(partials);
    return lies_between(partials->views(), instant);
}

Status add_missing(const cache::StoreReader& store, const Domain& domain, level2::Moment moment,
                   std::chrono::milliseconds newest, std::vector<cache::GridName>& all) {
    const auto starts = starts_of(store, domain, moment);
    if (!starts) return pass_on(starts);
    if (starts->empty()) return {};
    const auto frames = store.list(domain.name, moment, std::nullopt, std::nullopt);
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
        const auto due = is_due(store, domain, moment, instant);
        if (!due) return pass_on(due);
        if (*due) all.push_back({domain.name, moment, instant});
    }
    return {};
}

}  // namespace

bool lies_between(const std::vector<PartialView>& partials, UtcTime instant) {
    bool any_before = false, any_after = false;
    for (const PartialView& partial : partials) {
        any_before = any_before || partial.middle() <= instant;
        any_after = any_after || partial.middle() >= instant;
    }
    return any_before && any_after;
}

const Domain* find_domain(std::span<const Domain> domains, std::string_view name,
                          level2::Moment moment) {
    for (const Domain& domain : domains) {
        const auto& moments = domain.moments;
        const bool has = std::find(moments.begin(), moments.end(), moment) != moments.end();
        if (domain.name == name && has) return &domain;
    }
    return nullptr;
}

Result<const Domain*> domain_of(std::span<const Domain> domains, const cache::GridName& frame) {
    if (const Domain* domain = find_domain(domains, frame.domain, frame.moment)) return domain;
    return fail(ErrorCode::not_found, "the configuration has no domain {} of {}", frame.domain,
                level2::moment_name(frame.moment));
}

FrameOptions frame_options(const Domain& domain, level2::Moment moment, int threads) {
    FrameOptions options;
    options.overlap.moment = moment;
    options.overlap.overlap = domain.overlap.value_or(grid::default_overlap(moment));
    options.overlap.length_m = domain.overlap_length_m;
    options.time = domain.time;
    options.threads = threads;
    return options;
}

std::vector<UtcTime> instants_between(UtcTime from, UtcTime to, std::chrono::seconds interval) {
    const auto day = std::chrono::floor<std::chrono::days>(from);
    std::vector<UtcTime> instants;
    const auto since = from - UtcTime{day};
    const auto steps = (since + interval - std::chrono::milliseconds{1}) / interval;
    for (UtcTime at = UtcTime{day} + steps * interval; at <= to; at += interval) {
        instants.push_back(at);
        // The count begins anew at midnight, even if the interval does not divide a day.
        const auto next_day = std::chrono::floor<std::chrono::days>(at) + std::chrono::days{1};
        if (at + interval > UtcTime{next_day}) at = UtcTime{next_day} - interval;
    }
    return instants;
}

Result<FrameStanding> standing_of(const cache::StoreReader& store, std::span<const Domain> domains,
                                  const cache::GridName& frame) {
    const auto found = domain_of(domains, frame);
    if (!found) return pass_on(found);
    const Domain* const domain = *found;
    std::vector<std::string> ignored;
    const auto partials = MappedPartials::open(store, *domain, frame.moment, frame.time, frame.time,
                                               ignored, Unreadable::is_an_error);
    if (!partials) return pass_on(partials);
    const auto views = partials->views();
    if (!lies_between(views, frame.time)) return FrameStanding::not_due;
    const auto recipe =
        recipe_for(domain->spec, views, frame.time, frame_options(*domain, frame.moment, 1));
    if (!recipe) {
        if (recipe.error().code == ErrorCode::not_found) return FrameStanding::not_due;
        return pass_on(recipe);
    }
    const auto path = store.path_of(frame.domain, frame.moment, frame.time);
    if (!path) return pass_on(path);
    const auto stands = cache::GridFile::open(*path);
    if (!stands) return FrameStanding::to_make;
    const grid::Provenance& made_of = stands->description().provenance;
    const bool is_current = stands->description().spec == domain->spec &&
                            made_of.parts == recipe->parts && made_of.recipe == recipe->recipe &&
                            made_of.software_version == software_version;
    return is_current ? FrameStanding::current : FrameStanding::to_make;
}

Result<std::vector<cache::GridName>> missing_frames(const cache::StoreReader& store,
                                                    std::span<const Domain> domains,
                                                    std::chrono::milliseconds newest) {
    std::vector<cache::GridName> all;
    for (const Domain& domain : domains) {
        for (const level2::Moment moment : domain.moments) {
            if (Status added = add_missing(store, domain, moment, newest, all); !added) {
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
