#include "pipeline/mosaic_frame.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "base/parallel.h"
#include "base/version.h"
#include "grid/audit.h"
#include "grid/column_geometry.h"
#include "grid/motion.h"
#include "grid/position_error.h"

namespace stormcellar::pipeline {
namespace {

double seconds_between(UtcTime from, UtcTime to) {
    return std::chrono::duration<double>(to - from).count();
}

grid::TimedView timed(const PartialView& partial) {
    return {partial.view, partial.middle(), partial.description->provenance.sweeps};
}

// One site's grid for the instant: bricks of its own, or a partial as it stands.
struct SiteGrid {
    const PartialView* partial = nullptr;  // one of its bracket, for its site
    std::optional<grid::BrickGrid> made;

    [[nodiscard]] grid::BrickView view() const { return made ? made->view() : partial->view; }
};

// Whether a bracket's site is as it stands: the method takes the nearer one untouched.
const PartialView* nearest_of(const PartialView* before, const PartialView* after,
                              UtcTime instant) {
    if (before == nullptr || after == nullptr) return before != nullptr ? before : after;
    return after->middle() - instant < instant - before->middle() ? after : before;
}

Result<SiteGrid> site_grid(const PartialView* before, const PartialView* after, UtcTime instant,
                           level2::Moment moment, const FrameOptions& options, int threads,
                           GeometryCache& geometries) {
    SiteGrid site;
    site.partial = nearest_of(before, after, instant);
    // Two windows of one site differ where it moved: the nearer one stands then.
    const bool pair = before != nullptr && after != nullptr &&
                      *before->view.spec == *after->view.spec &&
                      before->view.quantization == after->view.quantization;
    if (options.time == grid::TimeMethod::nearest || !pair) return site;

    const auto geometry = geometries.get(site.partial->site(), *site.partial->view.spec);
    if (!geometry) return pass_on(geometry);
    grid::InstantOptions at;
    at.instant = instant;
    at.moment = moment;
    at.method = options.time;
    at.sweep_times = options.sweep_times;
    at.threads = threads;
    std::optional<grid::MotionField> motion;
    if (at.method == grid::TimeMethod::advected && moment == level2::Moment::ref) {
        auto found = grid::estimate_motion(before->view, after->view,
                                           seconds_between(before->middle(), after->middle()));
        if (!found) return pass_on(found);
        motion = std::move(*found);
        if (motion) at.motion = &*motion;
    }
    auto made = grid::grid_at(timed(*before), timed(*after), **geometry, at);
    if (!made) return pass_on(made);
    site.made = std::move(*made);
    return site;
}

template <class T>
void add_once(std::vector<T>& all, const std::vector<T>& more) {
    for (const T& one : more) {
        if (std::find(all.begin(), all.end(), one) == all.end()) all.push_back(one);
    }
}

void describe(const PartialView& partial, cache::GridDescription& frame) {
    const cache::GridDescription& from = *partial.description;
    grid::Provenance& provenance = frame.provenance;
    const grid::Provenance& source = from.provenance;
    add_once(provenance.source_files, source.source_files);
    add_once(provenance.stations, source.stations);
    add_once(provenance.notes, source.notes);
    provenance.method = source.method;
    provenance.beam_model = source.beam_model;
    provenance.averaging = source.averaging;
    provenance.effects = source.effects;
    provenance.partial = provenance.partial || source.partial;
    provenance.source_modified_ns =
        std::max(provenance.source_modified_ns, source.source_modified_ns);
    const bool first = frame.sites.empty();
    frame.moment = from.moment;
    frame.start_time = first ? from.start_time : std::min(frame.start_time, from.start_time);
    frame.end_time = first ? from.end_time : std::max(frame.end_time, from.end_time);
    const auto is_it = [&](const grid::SitePosition& site) {
        return site.icao == partial.site().icao;
    };
    if (std::none_of(frame.sites.begin(), frame.sites.end(), is_it)) {
        frame.sites.push_back(partial.site());
    }
}

std::string frame_effects(const std::string& of_partials, const FrameOptions& options) {
    std::string text = of_partials;
    const auto add = [&](const std::string& step) { text += (text.empty() ? "" : ", ") + step; };
    add(fmt::format("time: {}", grid::time_method_name(options.time)));
    if (options.time != grid::TimeMethod::nearest) {
        add(options.sweep_times ? "sweeps: each at its own time" : "sweeps: as one");
    }
    add(fmt::format("overlap: {}", grid::overlap_name(options.overlap.overlap)));
    return text;
}

grid::Partial placed(const grid::GridSpec& domain, const SiteGrid& site,
                     GeometryCache& geometries) {
    grid::Partial partial{site.view(), site.partial->site()};
    // Of a grid that is no window of the domain merge() says what is wrong.
    const auto window = grid::window_of(domain, *partial.view.spec);
    if (window) partial.distance = geometries.distance(domain, *window, partial.site);
    return partial;
}

// Four gates to a cell are enough where cells are wide.
grid::AuditOptions audit_options(const grid::GridSpec& domain) {
    grid::AuditOptions options;
    const double cell_m = std::min(domain.cell_width_m(), domain.cell_height_m());
    options.range_step_m = std::max(options.range_step_m, cell_m / 4);
    return options;
}

}  // namespace

Result<std::optional<MadePartial>> make_partial(const level2::Volume& volume,
                                                const grid::SitePosition& site,
                                                const grid::GridSpec& domain,
                                                const PartialOptions& options,
                                                GeometryCache& geometries) {
    const auto window = geometries.window(domain, site, options.reach_m);
    if (!window) return std::optional<MadePartial>{};
    const auto geometry = geometries.get(site, grid::window_spec(domain, *window));
    if (!geometry) return pass_on(geometry);
    auto made = grid::make_grid(volume, site, **geometry, options.gridder);
    if (!made) return pass_on(made);
    made->provenance.predicted_error = grid::unplanned_error(
        volume, site, (*geometry)->spec(), (*geometry)->frame_kind(), options.gridder);
    MadePartial partial{cache::describe(*made), grid::BrickGrid::from(*made, options.quantization)};
    grid::AuditOptions audit = audit_options(domain);
    const auto places = geometries.places(site, (*geometry)->spec());
    audit.columns = places.get();
    const auto audited = grid::audit(partial.bricks.view(), volume, site, options.gridder, audit);
    if (audited) partial.description.provenance.audit = audited->rows;
    return std::optional<MadePartial>{std::move(partial)};
}

std::vector<Bracket> brackets_of(std::span<const PartialView> partials, UtcTime instant,
                                 std::chrono::milliseconds greatest_gap) {
    std::map<std::string, Bracket> sites;
    for (std::size_t at = 0; at < partials.size(); ++at) {
        const UtcTime middle = partials[at].middle();
        const bool is_before = middle <= instant;
        if ((is_before ? instant - middle : middle - instant) > greatest_gap) continue;
        Bracket& bracket = sites[partials[at].site().icao];
        std::optional<std::size_t>& end = is_before ? bracket.before : bracket.after;
        const bool nearer = !end || (is_before ? middle >= partials[*end].middle()
                                               : middle <= partials[*end].middle());
        if (nearer) end = at;
    }
    std::vector<Bracket> brackets;
    for (const auto& [icao, bracket] : sites)
        brackets.push_back(bracket);
    return brackets;
}

Result<MosaicFrame> make_frame(const grid::GridSpec& domain, std::span<const PartialView> partials,
                               UtcTime instant, const FrameOptions& options,
                               GeometryCache& geometries) {
    const std::vector<Bracket> brackets = brackets_of(partials, instant, options.greatest_gap);
    if (brackets.empty()) {
        const auto minutes = std::chrono::duration<double, std::ratio<60>>(options.greatest_gap);
        return fail(ErrorCode::not_found, "no site has a volume within {:g} minutes of {}",
                    minutes.count(), format_utc(instant));
    }
    cache::GridDescription description;
    bool provisional = false;
    std::vector<std::optional<Result<SiteGrid>>> sites(brackets.size());
    const auto partial_at = [&](const std::optional<std::size_t>& index) {
        return index ? &partials[*index] : nullptr;
    };
    const int count = static_cast<int>(brackets.size());
    const int threads_a_site = std::max(1, options.threads / count);
    for_each_piece(count, options.threads, [&](int piece) {
        const Bracket& bracket = brackets[static_cast<std::size_t>(piece)];
        sites[static_cast<std::size_t>(piece)] =
            site_grid(partial_at(bracket.before), partial_at(bracket.after), instant,
                      options.overlap.moment, options, threads_a_site, geometries);
    });
    std::vector<grid::Partial> to_merge;
    for (std::size_t at = 0; at < brackets.size(); ++at) {
        const Result<SiteGrid>& site = *sites[at];
        if (!site) return pass_on(site);
        to_merge.push_back(placed(domain, *site, geometries));
        for (const auto& index : {brackets[at].before, brackets[at].after}) {
            const bool used = index && (site->made || &partials[*index] == site->partial);
            if (used) describe(partials[*index], description);
        }
        provisional = provisional || !brackets[at].after;
    }
    grid::MosaicOptions overlap = options.overlap;
    overlap.threads = options.threads;
    auto mosaic = grid::merge(domain, to_merge, overlap);
    if (!mosaic) return pass_on(mosaic);
    description.spec = domain;
    description.time = instant;
    description.provenance.software_version = software_version;
    description.provenance.provisional = provisional;
    description.provenance.effects = frame_effects(description.provenance.effects, options);
    return MosaicFrame{std::move(description), std::move(*mosaic)};
}

}  // namespace stormcellar::pipeline
