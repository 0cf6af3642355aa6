#include "pipeline/mosaic/mosaic_frame.h"

#include <algorithm>
#include <map>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "base/parallel.h"
#include "grid/judge/audit.h"
#include "grid/plan/position_error.h"
#include "pipeline/mosaic/frame_parts.h"
#include "pipeline/mosaic/instant_cache.h"
#include "stormcellar/base/version.h"
#include "stormcellar/grid/column_geometry.h"

namespace stormcellar::pipeline {
namespace {

grid::TimedView timed(const PartialView& partial) {
    return {partial.view, partial.middle(), partial.description->provenance.sweeps};
}

// One site's share of a frame: a partial, unchanged, or a grid for the instant that was made of two
// partials.
struct SiteShare {
    const PartialView* nearest = nullptr;
    const PartialView* before = nullptr;  // `before` and `after` are either both set or both null
    const PartialView* after = nullptr;
    bool nothing_after = false;  // the site has no volume after the instant yet
    InstantCache::Key key;       // the key of `made`
    std::shared_ptr<const grid::BrickGrid> made;

    [[nodiscard]] grid::BrickView view() const { return made ? made->view() : nearest->view; }
    [[nodiscard]] std::vector<const PartialView*> used() const {
        if (before == nullptr) return {nearest};
        return {before, after};
    }
};

// Returns true if both partials have the same window and the same codes. Windows differ if the site
// moved, and codes if the configuration was changed.
bool is_pair(const PartialView& before, const PartialView& after) {
    return *before.view.spec == *after.view.spec &&
           before.view.quantization == after.view.quantization;
}

// Returns a site's share. It is the nearer partial, unchanged, if the method asks for that, if
// there is only one partial, or if the two cannot be mixed (is_pair()).
SiteShare share_of(const PartialView* before, const PartialView* after, UtcTime instant,
                   grid::TimeMethod method) {
    SiteShare share;
    if (before == nullptr || after == nullptr) {
        share.nearest = before != nullptr ? before : after;
        return share;
    }
    const bool later = after->middle() - instant < instant - before->middle();
    share.nearest = later ? after : before;
    if (method == grid::TimeMethod::nearest || !is_pair(*before, *after)) return share;
    share.before = before;
    share.after = after;
    return share;
}

// Returns a share for each site that has a partial near the instant. Errors: not_found if no site
// has such a partial.
Result<std::vector<SiteShare>> shares_of(std::span<const PartialView> partials, UtcTime instant,
                                         const FrameOptions& options) {
    const std::vector<Bracket> brackets = brackets_of(partials, instant, options.greatest_gap);
    if (brackets.empty()) {
        const auto minutes = std::chrono::duration<double, std::ratio<60>>(options.greatest_gap);
        return fail(ErrorCode::not_found, "no site has a volume within {:g} minutes of {}",
                    minutes.count(), format_utc(instant));
    }
    const auto partial_at = [&](const std::optional<std::size_t>& index) {
        return index ? &partials[*index] : nullptr;
    };
    std::vector<SiteShare> shares;
    shares.reserve(brackets.size());
    for (const Bracket& bracket : brackets) {
        shares.push_back(
            share_of(partial_at(bracket.before), partial_at(bracket.after), instant, options.time));
        shares.back().nothing_after = !bracket.after;
    }
    return shares;
}

Result<std::optional<grid::MotionField>> motion_between(const PartialView& before,
                                                        const PartialView& after, int threads) {
    grid::MotionOptions by;
    by.threads = threads;
    return grid::estimate_motion(before.view, after.view,
                                 seconds_between(before.middle(), after.middle()), by);
}

Result<std::optional<grid::MotionField>> motion_of(const SiteShare& share,
                                                   const FrameOptions& options, int threads) {
    const bool moves =
        options.time == grid::TimeMethod::advected && options.overlap.moment == level2::Moment::ref;
    if (!moves) return std::optional<grid::MotionField>{};
    if (options.motions == nullptr) return motion_between(*share.before, *share.after, threads);
    const auto known = options.motions->find(share.nearest->site().icao);
    return known != options.motions->end() ? known->second : std::nullopt;
}

Status make_share(SiteShare& share, UtcTime instant, const FrameOptions& options, int threads,
                  GeometryCache& geometries, InstantCache* instants) {
    if (share.before != nullptr && instants != nullptr) share.made = instants->find(share.key);
    if (share.made != nullptr) return {};
    for (const PartialView* partial : share.used()) {
        if (partial->file == nullptr) continue;
        if (Status good = partial->file->verify(); !good) return good;
    }
    if (share.before == nullptr) return {};
    const auto geometry = geometries.get(share.nearest->site(), *share.nearest->view.spec);
    if (!geometry) return pass_on(geometry);
    grid::InstantOptions at;
    at.instant = instant;
    at.moment = options.overlap.moment;
    at.method = options.time;
    at.sweep_times = options.sweep_times;
    at.threads = threads;
    const auto motion = motion_of(share, options, threads);
    if (!motion) return pass_on(motion);
    if (*motion) at.motion = &**motion;
    auto made = grid::grid_at(timed(*share.before), timed(*share.after), **geometry, at);
    if (!made) return pass_on(made);
    share.made = std::make_shared<const grid::BrickGrid>(std::move(*made));
    if (instants != nullptr) instants->keep(share.key, share.made);
    return {};
}

// Collects texts, each once, in order. Beyond a limit, only counts further texts: the file of a
// frame holds at most 1 MiB of texts, and each partial adds texts.
class TextsOnce {
  public:
    TextsOnce(std::size_t most_bytes, std::string_view kind)
        : most_bytes_(most_bytes), kind_(kind) {}
    void add(const std::vector<std::string>& more) {
        for (const std::string& text : more) {
            if (!known_.insert(text).second) continue;
            bytes_ += text.size();
            if (bytes_ > most_bytes_) ++left_out_;
            if (bytes_ <= most_bytes_) texts_.push_back(text);
        }
    }
    std::vector<std::string> take() {
        if (left_out_ > 0) texts_.push_back(fmt::format("and {} more {}", left_out_, kind_));
        return std::move(texts_);
    }

  private:
    std::size_t most_bytes_;
    std::string_view kind_;
    std::size_t bytes_ = 0, left_out_ = 0;
    std::unordered_set<std::string> known_;
    std::vector<std::string> texts_;
};

// The texts of a frame, with their limits. A thousand partials with the usual notes and radar
// troubles are well below these limits.
struct FrameTexts {
    TextsOnce source_files{std::size_t{192} << 10, "volumes"};
    TextsOnce stations{std::size_t{32} << 10, "stations"};
    TextsOnce notes{std::size_t{128} << 10, "notes"};
    TextsOnce radar_troubles{std::size_t{128} << 10, "troubles"};
};

void describe(const PartialView& partial, FrameTexts& texts, cache::GridDescription& frame) {
    const cache::GridDescription& from = *partial.description;
    grid::Provenance& provenance = frame.provenance;
    const grid::Provenance& source = from.provenance;
    texts.source_files.add(source.source_files);
    texts.stations.add(source.stations);
    texts.notes.add(source.notes);
    texts.radar_troubles.add(source.radar_troubles);
    provenance.method = source.method;
    provenance.beam_model = source.beam_model;
    provenance.averaging = source.averaging;
    provenance.effects = source.effects;
    provenance.partial = provenance.partial || source.partial;
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

// Returns the windows in which the new frame differs from the previous frame. Returns none if
// nothing can be copied from the previous frame.
std::optional<std::vector<grid::GridWindow>> changes_since(const PreviousFrame* previous,
                                                           const cache::GridDescription& now,
                                                           const FrameOptions& options,
                                                           const grid::Quantization& quantization) {
    if (previous == nullptr || options.overlap.counts || options.overlap.weights) {
        return std::nullopt;
    }
    const cache::GridDescription& was = *previous->description;
    const bool usable = was.spec == now.spec && was.time == now.time && was.moment == now.moment &&
                        was.provenance.recipe == now.provenance.recipe &&
                        was.provenance.software_version == now.provenance.software_version &&
                        !was.provenance.parts.empty() &&
                        previous->cells.quantization == quantization;
    if (!usable) return std::nullopt;
    return changed_windows(was.provenance.parts, now.provenance.parts);
}

void drop_untouched(const grid::GridSpec& domain, const std::vector<grid::GridWindow>& changed,
                    std::vector<SiteShare>& shares) {
    std::erase_if(shares, [&](const SiteShare& share) {
        const auto window = grid::window_of(domain, *share.nearest->view.spec);
        return std::none_of(changed.begin(), changed.end(), [&](const grid::GridWindow& one) {
            return share_bricks(*window, one);
        });
    });
}

Status make_shares(std::vector<SiteShare>& shares, UtcTime instant, const FrameOptions& options,
                   GeometryCache& geometries, InstantCache* instants) {
    std::vector<Status> made(shares.size());
    const int count = static_cast<int>(shares.size());
    const int threads_each = count == 0 ? 1 : std::max(1, options.threads / count);
    for_each_piece(count, options.threads, [&](int piece) {
        const auto at = static_cast<std::size_t>(piece);
        made[at] = make_share(shares[at], instant, options, threads_each, geometries, instants);
    });
    for (Status& one : made) {
        if (!one) return std::move(one);
    }
    return {};
}

// Describes everything but the cells. Also sets the key of each share in the InstantCache.
Result<cache::GridDescription> describe_shares(const grid::GridSpec& domain,
                                               std::vector<SiteShare>& shares, UtcTime instant,
                                               const FrameOptions& options) {
    cache::GridDescription frame;
    std::vector<const PartialView*> used;
    FrameTexts texts;
    for (const SiteShare& share : shares) {
        for (const PartialView* partial : share.used()) {
            describe(*partial, texts, frame);
            used.push_back(partial);
        }
    }
    frame.provenance.source_files = texts.source_files.take();
    frame.provenance.stations = texts.stations.take();
    frame.provenance.notes = texts.notes.take();
    frame.provenance.radar_troubles = texts.radar_troubles.take();
    frame.provenance.provisional = std::any_of(
        shares.begin(), shares.end(), [](const SiteShare& share) { return share.nothing_after; });
    auto parts = parts_of(domain, used);
    if (!parts) return pass_on(parts);
    frame.provenance.recipe = recipe_of(options);
    auto part = parts->begin();
    for (SiteShare& share : shares) {
        if (share.before == nullptr) {
            ++part;
            continue;
        }
        share.key = {part[0].fingerprint, part[1].fingerprint, frame.provenance.recipe, instant};
        part += 2;
    }
    frame.spec = domain;
    frame.time = instant;
    frame.provenance.parts = std::move(*parts);
    frame.provenance.software_version = software_version;
    frame.provenance.effects = frame_effects(frame.provenance.effects, options);
    return frame;
}

grid::Partial placed(const grid::GridSpec& domain, const SiteShare& share,
                     GeometryCache& geometries) {
    grid::Partial partial{share.view(), share.nearest->site()};
    // If a grid is not a window of the domain, merge() will report the error.
    const auto window = grid::window_of(domain, *partial.view.spec);
    if (window) partial.distance = geometries.distance(domain, *window, partial.site);
    return partial;
}

// Returns the options of the audit. If cells are wide, four gates for each cell are enough.
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
    const auto geometry = geometries.get(site, grid::window_spec(domain, *window), options.frame);
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
    brackets.reserve(sites.size());
    for (const auto& [icao, bracket] : sites)
        brackets.push_back(bracket);
    return brackets;
}

Result<Motions> estimate_motions(std::span<const PartialView> partials, UtcTime instant,
                                 level2::Moment moment, const FrameOptions& options) {
    Motions motions;
    if (moment != level2::Moment::ref) return motions;
    for (const Bracket& bracket : brackets_of(partials, instant, options.greatest_gap)) {
        if (!bracket.before || !bracket.after) continue;
        const PartialView& before = partials[*bracket.before];
        const PartialView& after = partials[*bracket.after];
        if (!is_pair(before, after)) continue;
        auto motion = motion_between(before, after, options.threads);
        if (!motion) return pass_on(motion);
        motions[before.site().icao] = std::move(*motion);
    }
    return motions;
}

Result<cache::GridDescription> describe_frame(const grid::GridSpec& domain,
                                              std::span<const PartialView> partials,
                                              UtcTime instant, const FrameOptions& options) {
    auto shares = shares_of(partials, instant, options);
    if (!shares) return pass_on(shares);
    return describe_shares(domain, *shares, instant, options);
}

Result<FrameRecipe> recipe_for(const grid::GridSpec& domain, std::span<const PartialView> partials,
                               UtcTime instant, const FrameOptions& options) {
    auto frame = describe_frame(domain, partials, instant, options);
    if (!frame) return pass_on(frame);
    return FrameRecipe{std::move(frame->provenance.parts), frame->provenance.recipe};
}

Result<MosaicFrame> make_frame(const grid::GridSpec& domain, std::span<const PartialView> partials,
                               UtcTime instant, const FrameOptions& options,
                               GeometryCache& geometries, const MadeBefore& before) {
    auto shares = shares_of(partials, instant, options);
    if (!shares) return pass_on(shares);
    auto description = describe_shares(domain, *shares, instant, options);
    if (!description) return pass_on(description);

    auto changed = changes_since(before.frame, *description, options,
                                 shares->front().nearest->view.quantization);
    if (changed) drop_untouched(domain, *changed, *shares);
    if (Status made = make_shares(*shares, instant, options, geometries, before.instants); !made) {
        return pass_on(made);
    }
    std::vector<grid::Partial> to_merge;
    to_merge.reserve(shares->size());
    for (const SiteShare& share : *shares)
        to_merge.push_back(placed(domain, share, geometries));
    grid::MosaicOptions overlap = options.overlap;
    overlap.threads = options.threads;
    auto mosaic = changed ? grid::update({before.frame->cells, std::nullopt, std::nullopt},
                                         to_merge, *changed, overlap)
                          : grid::merge(domain, to_merge, overlap);
    if (!mosaic) return pass_on(mosaic);
    return MosaicFrame{std::move(*description), std::move(*mosaic), std::move(changed)};
}

}  // namespace stormcellar::pipeline
