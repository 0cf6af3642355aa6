#include "pipeline/mosaic_keeper.h"

#include <algorithm>
#include <set>
#include <utility>

#include "cache/grid_file.h"
#include "grid/brick_grid.h"
#include "grid/effects.h"
#include "pipeline/keep_rule.h"

namespace stormcellar::pipeline {
namespace {

// Windows of a large domain take some 15 MiB each.
constexpr std::size_t kept_geometries = 16;
constexpr std::chrono::milliseconds greatest_gap = FrameOptions{}.greatest_gap;
// No volume takes longer from its start, by which the store names it, to its middle.
constexpr std::chrono::milliseconds longest_to_middle = std::chrono::minutes{10};

bool has_moment(const level2::Volume& volume, level2::Moment moment) {
    return std::any_of(volume.sweeps.begin(), volume.sweeps.end(),
                       [&](const level2::Sweep& sweep) { return sweep.find(moment) != nullptr; });
}

std::string site_domain(const std::string& domain, const std::string& icao) {
    return domain + "." + icao;
}

UtcTime middle_of(const cache::GridDescription& description) {
    return description.start_time + (description.end_time - description.start_time) / 2;
}

PartialOptions partial_options(const Domain& domain, level2::Moment moment,
                               const grid::SitePosition& site, int threads) {
    const accuracy::Chain chain = grid::effects_of(moment);
    const accuracy::Choice rungs =
        grid::default_choice(chain, domain.spec, grid::beam_width_of(site.icao));
    PartialOptions options;
    options.gridder.moment = moment;
    options.gridder.threads = threads;
    options.gridder.method = grid::scene_choice(chain, rungs).method;
    options.quantization = grid::default_quantization(moment);
    return options;
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

// The partials of a domain whose volumes may matter between two times.
class OpenPartials {
  public:
    static Result<OpenPartials> open(const cache::Store& store, const Domain& domain,
                                     level2::Moment moment, UtcTime from, UtcTime to,
                                     std::vector<std::string>& problems) {
        OpenPartials all;
        const auto domains = store.domains();
        if (!domains) return pass_on(domains);
        for (const std::string& name : *domains) {
            if (!name.starts_with(domain.name + ".")) continue;
            const auto entries = store.list(name, moment, from - greatest_gap - longest_to_middle,
                                            to + greatest_gap);
            if (!entries) return pass_on(entries);
            for (const cache::StoreEntry& entry : *entries) {
                auto file = cache::GridFile::open(entry.path);
                if (!file) {
                    problems.push_back(file.error().message);
                    continue;
                }
                // Of a configuration that has changed since.
                if (!grid::window_of(domain.spec, file->description().spec)) continue;
                all.files_.push_back(std::move(*file));
            }
        }
        return all;
    }

    [[nodiscard]] std::vector<PartialView> views() const {
        std::vector<PartialView> views;
        for (const cache::GridFile& file : files_)
            views.push_back({&file.description(), file.view()});
        return views;
    }
    // What was read was what the files held.
    [[nodiscard]] Status check_whole() const {
        for (const cache::GridFile& file : files_) {
            if (Status whole = file.check_whole(); !whole) return whole;
        }
        return {};
    }

  private:
    std::vector<cache::GridFile> files_;
};

// From the site's volume before to the one after, as far as volumes count and there are any.
struct Span {
    UtcTime from, to;
};
Span span_changed_by(const cache::GridDescription& changed,
                     const std::vector<PartialView>& partials) {
    const UtcTime middle = middle_of(changed);
    Span span{middle - greatest_gap, middle + greatest_gap};
    UtcTime oldest = middle, newest = middle;
    for (const PartialView& partial : partials) {
        oldest = std::min(oldest, partial.middle());
        newest = std::max(newest, partial.middle());
        if (partial.site().icao != changed.sites.front().icao) continue;
        if (partial.middle() < middle) span.from = std::max(span.from, partial.middle());
        if (partial.middle() > middle) span.to = std::min(span.to, partial.middle());
    }
    span.from = std::max(span.from, oldest);
    span.to = std::min(span.to, newest);
    return span;
}

std::vector<UtcTime> instants_in(const Span& span, std::chrono::seconds interval) {
    const auto day = std::chrono::floor<std::chrono::days>(span.from);
    std::vector<UtcTime> instants;
    const auto since = span.from - UtcTime{day};
    const auto steps = (since + interval - std::chrono::milliseconds{1}) / interval;
    for (UtcTime at = UtcTime{day} + steps * interval; at <= span.to; at += interval) {
        instants.push_back(at);
        // Frames are counted from midnight, whatever the interval.
        const auto next_day = std::chrono::floor<std::chrono::days>(at) + std::chrono::days{1};
        if (at + interval > UtcTime{next_day}) at = UtcTime{next_day} - interval;
    }
    return instants;
}

}  // namespace

MosaicKeeper::MosaicKeeper(const cache::Store* store, std::vector<Domain> domains)
    : store_(store), domains_(std::move(domains)), geometries_(kept_geometries) {}

Result<Kept> MosaicKeeper::take_in(const VolumeSource& source, int threads) {
    Kept kept;
    if (is_idle()) return kept;
    for (const Domain& domain : domains_) {
        if (!domain.takes(source.site.icao)) continue;
        for (const level2::Moment moment : domain.moments) {
            if (!has_moment(source.volume, moment)) continue;
            const Status done = keep(domain, moment, source, threads, kept);
            if (!done) return pass_on(done);
        }
    }
    return kept;
}

Status MosaicKeeper::keep(const Domain& domain, level2::Moment moment, const VolumeSource& source,
                          int threads, Kept& kept) {
    auto made = make_partial(source.volume, source.site, domain.spec,
                             partial_options(domain, moment, source.site, threads), geometries_);
    if (!made) return pass_on(made);
    if (!*made) return {};
    cache::GridDescription& description = (*made)->description;
    description.provenance.source_files = {source.file};
    description.provenance.source_modified_ns = source.modified_ns;
    description.provenance.partial = source.partial;
    description.provenance.notes.insert(description.provenance.notes.begin(), source.notes.begin(),
                                        source.notes.end());
    std::mutex* one_at_a_time = nullptr;
    {
        const std::scoped_lock lock(mutex_);
        one_at_a_time = &frames_[{domain.name, moment}];
    }
    const std::scoped_lock lock(*one_at_a_time);
    const std::string name = site_domain(domain.name, source.site.icao);
    const auto path = store_->path_of(name, moment, description.time);
    if (!path) return pass_on(path);
    if (reason_to_keep(*path, description)) return {};
    const auto committed = store_->commit(name, description, (*made)->bricks.view());
    if (!committed) return pass_on(committed);
    if (committed->empty()) return {};  // older than what the budgets keep
    kept.partials.push_back(*committed);
    return refresh(domain, moment, description, threads, kept);
}

Status MosaicKeeper::refresh(const Domain& domain, level2::Moment moment,
                             const cache::GridDescription& changed, int threads, Kept& kept) {
    const UtcTime middle = middle_of(changed);
    const auto partials = OpenPartials::open(*store_, domain, moment, middle - greatest_gap,
                                             middle + greatest_gap, kept.problems);
    if (!partials) return pass_on(partials);
    const std::vector<PartialView> views = partials->views();
    const FrameOptions options = frame_options(domain, moment, threads);
    for (const UtcTime instant : instants_in(span_changed_by(changed, views), domain.interval)) {
        auto frame = make_frame(domain.spec, views, instant, options, geometries_);
        if (!frame) return pass_on(frame);
        if (Status whole = partials->check_whole(); !whole) return whole;
        frame->description.provenance.revision = 1;
        const auto path = store_->path_of(domain.name, moment, instant);
        if (!path) return pass_on(path);
        if (const auto stands = cache::GridFile::open(*path)) {
            frame->description.provenance.revision = stands->description().provenance.revision + 1;
        }
        const auto committed =
            store_->commit(domain.name, frame->description, frame->mosaic.cells.view());
        if (!committed) return pass_on(committed);
        if (!committed->empty()) kept.frames.push_back(*committed);
    }
    return {};
}

}  // namespace stormcellar::pipeline
