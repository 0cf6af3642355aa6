#include "pipeline/mosaic/mosaic_maker.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "grid/plan/grid_effects.h"
#include "level2/decode/volume_checks.h"
#include "pipeline/keep/keep_rule.h"
#include "pipeline/keep/site_grids.h"
#include "pipeline/mosaic/mapped_partials.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::pipeline {
namespace {

// Number of windows that are kept. For a large domain, each takes some 15 MiB.
constexpr std::size_t kept_geometries = 16;
// Limit of the kept grids. One site's grid in a domain of 1000 km at 1 km takes 3 to 10 MiB.
constexpr std::size_t kept_instants_bytes = std::size_t{192} << 20U;

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

// The time span of the frames that a new volume changes. It goes from the previous volume of the
// site to the next volume, but at most greatest_frame_gap to each side, and not beyond the times of
// all partials.
struct Span {
    UtcTime from, to;
};
Span span_changed_by(const cache::GridDescription& changed,
                     const std::vector<PartialView>& partials) {
    const UtcTime middle = middle_of(changed);
    Span span{middle - greatest_frame_gap, middle + greatest_frame_gap};
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

// Returns true if another try may succeed, because the system only refused something.
bool may_pass(const Error& error) {
    return error.cause() != Cause::data && error.code != ErrorCode::over_budget &&
           error.code != ErrorCode::bad_argument && error.code != ErrorCode::not_found;
}

bool is_damage(const Error& error) {
    return error.code == ErrorCode::corrupt || error.code == ErrorCode::truncated ||
           error.code == ErrorCode::io;
}

// Returns the partials without those of late machines. The partials of a station stay if another
// machine has brought a newer volume of it.
std::vector<PartialView> without(const std::vector<LateMachine>& late,
                                 std::vector<PartialView> partials) {
    for (const LateMachine& machine : late) {
        std::set<std::string> stations = machine.stations;
        for (const PartialView& partial : partials)
            if (partial.middle() > machine.newest) stations.erase(partial.site().icao);
        std::erase_if(partials, [&](const PartialView& partial) {
            return stations.contains(partial.site().icao);
        });
    }
    return partials;
}

bool is_frame_time(UtcTime time, std::chrono::seconds interval) {
    return instants_between(time, time, interval).size() == 1;
}

}  // namespace

MosaicMaker::MosaicMaker(cache::StoreWriter* store, std::vector<Domain> domains, FramesWhen frames,
                         std::shared_ptr<PartialSources> sources)
    : store_(store),
      domains_(std::move(domains)),
      frames_when_(frames),
      sources_(std::move(sources)),
      geometries_(kept_geometries),
      instants_(kept_instants_bytes) {}

// Makes partials and frames in each domain. If one domain has an error, continues with the other
// domains.
Result<Kept> MosaicMaker::take_in(const VolumeSource& source, int threads) {
    Kept kept;
    Status all;
    if (is_idle()) return kept;
    for (const Domain& domain : domains_) {
        if (!domain.takes(source.site.icao)) continue;
        for (const level2::Moment moment : domain.moments) {
            if (!level2::holds(source.volume, moment)) continue;
            const Status done = keep(domain, moment, source, threads, kept);
            if (done) continue;
            if (may_pass(done.error())) {
                all = done;
            } else {
                kept.problems.push_back(fmt::format("{}: {}", domain.name, done.error().message));
            }
        }
    }
    if (!all) return pass_on(all);
    return kept;
}

Mutex& MosaicMaker::frames_of(const std::string& domain, level2::Moment moment) {
    const MutexLock lock(mutex_);
    return frames_[{domain, moment}];
}

Status MosaicMaker::keep(const Domain& domain, level2::Moment moment, const VolumeSource& source,
                         int threads, Kept& kept) {
    auto made = make_partial(source.volume, source.site, domain.spec,
                             partial_options(domain, moment, source.site, threads), geometries_);
    if (!made) return of_gridding(made.error());
    if (!*made) return {};
    cache::GridDescription& description = (*made)->description;
    description.provenance.source_files = {level2::volume_name(source.site.icao, description.time)};
    description.provenance.partial = source.partial;
    description.provenance.radar_troubles = source.radar_troubles;
    description.provenance.notes.insert(description.provenance.notes.begin(), source.notes.begin(),
                                        source.notes.end());
    Mutex& frames = frames_of(domain.name, moment);
    const MutexLock lock(frames);
    const std::string name = site_domain(domain.name, source.site.icao);
    const auto path = store_->path_of(name, moment, description.time);
    if (!path) return of_gridding(path.error());
    const auto reason =
        reason_to_keep(*path, {description, (*made)->bricks.view(), source.has_rival});
    if (!reason) return of_storing(reason.error());
    if (*reason) return {};
    const auto committed = store_->commit(name, description, (*made)->bricks.view());
    if (!committed) return of_storing(committed.error());
    if (committed->empty()) return {};  // the grid is older than the cache's budgets allow
    remove_other_times(*store_, name, moment, source.volume, source.file);
    keep_to_an_hours_volumes(*store_, name, moment, description.time);
    kept.partials.push_back(*committed);
    if (frames_when_ == FramesWhen::asked_for) return {};
    return refresh(domain, moment, description, threads, kept, frames);
}

Status MosaicMaker::refresh(const Domain& domain, level2::Moment moment,
                            const cache::GridDescription& changed, int threads, Kept& kept,
                            Mutex& frames, const std::function<void()>& beat) {
    const UtcTime middle = middle_of(changed);
    auto partials = MappedPartials::open(*store_, domain, moment, middle - greatest_frame_gap,
                                         middle + greatest_frame_gap, kept.problems);
    if (!partials) return pass_on(partials);
    const Span span = span_changed_by(changed, partials->views());
    for (const UtcTime instant : instants_between(span.from, span.to, domain.interval)) {
        if (beat) beat();
        const auto made =
            make({domain, moment, instant, threads}, *partials, kept.problems, frames);
        if (!made && may_pass(made.error())) return pass_on(made);
        if (!made) {
            kept.problems.push_back(fmt::format("the frame {} {}: {}", domain.name,
                                                format_utc(instant), made.error().message));
            continue;
        }
        if (made->path.empty()) continue;
        kept.frames.push_back(made->path);
        if (made->merged) ++kept.updated;
    }
    return {};
}

// Makes a frame without the partials that turn out to be damaged. CacheMender repairs these.
Result<MosaicFrame> MosaicMaker::frame_of_sound(const FrameJob& job, MappedPartials& partials,
                                                const std::vector<LateMachine>& late,
                                                const PreviousFrame* previous,
                                                std::vector<std::string>& problems) {
    const FrameOptions options = frame_options(job.domain, job.moment, job.threads);
    while (true) {
        auto frame = make_frame(job.domain.spec, without(late, partials.views()), job.instant,
                                options, geometries_, {previous, &instants_});
        if (frame || !is_damage(frame.error())) return frame;
        const auto dropped = partials.drop_damaged(problems);
        if (!dropped) return pass_on(dropped);
        if (!*dropped) return frame;
    }
}

Result<FrameMade> MosaicMaker::make(const FrameJob& job, MappedPartials& partials,
                                    std::vector<std::string>& problems, Mutex&) {
    const auto path = store_->path_of(job.domain.name, job.moment, job.instant);
    if (!path) return pass_on(path);
    const auto stands = cache::GridFile::open(*path);
    // Do not copy from a damaged frame, because copied bricks would get new checksums.
    const bool sound = stands && stands->verify();
    const PreviousFrame previous =
        sound ? PreviousFrame{&stands->description(), stands->view()} : PreviousFrame{};
    const std::vector<LateMachine> late = late_for(job);
    auto frame = frame_of_sound(job, partials, late, sound ? &previous : nullptr, problems);
    if (!frame) return pass_on(frame);
    if (Status whole = partials.check_whole(); !whole) return pass_on(whole);
    if (sound) {
        if (Status whole = stands->check_whole(); !whole) return pass_on(whole);
    }
    finish(frame->description, late);
    const grid::Provenance& provenance = frame->description.provenance;
    auto committed =
        store_->commit(job.domain.name, frame->description, frame->mosaic.cells.view());
    if (!committed) return pass_on(committed);
    return FrameMade{std::move(*committed), provenance.stations, std::move(frame->merged)};
}

std::vector<LateMachine> MosaicMaker::late_for(const FrameJob& job) const {
    return sources_ ? sources_->late_for(job.domain.name, job.moment, job.instant)
                    : std::vector<LateMachine>{};
}

void MosaicMaker::finish(cache::GridDescription& frame,
                         const std::vector<LateMachine>& late) const {
    frame.provenance.revision = static_cast<int>(frame.provenance.parts.size());
    for (const LateMachine& machine : late)
        frame.provenance.left_out.push_back(machine.text());
}

// Returns true if the frame is due and is missing, lacks a partial, or was made of an earlier state
// of its partials. Partials that have left the cache do not make a frame stale.
Result<bool> MosaicMaker::is_stale(const FrameJob& job, const MappedPartials& partials) const {
    const auto views = partials.views();
    if (!lies_between(views, job.instant)) return false;
    const auto late = late_for(job);
    auto wanted = describe_frame(job.domain.spec, without(late, views), job.instant,
                                 frame_options(job.domain, job.moment, job.threads));
    if (!wanted && wanted.error().code == ErrorCode::not_found) return false;
    if (!wanted) return pass_on(wanted);
    finish(*wanted, late);
    const auto path = store_->path_of(job.domain.name, job.moment, job.instant);
    if (!path) return pass_on(path);
    const auto stands = cache::GridFile::open(*path);
    if (!stands) return true;
    const grid::Provenance &is = stands->description().provenance, &should = wanted->provenance;
    const auto lacks = [&](const grid::FramePart& part) {
        return std::ranges::find(is.parts, part) == is.parts.end();
    };
    if (std::ranges::any_of(should.parts, lacks)) return true;
    const auto texts = [](const grid::Provenance& of) {
        return std::tie(of.source_files, of.stations, of.notes, of.radar_troubles, of.left_out,
                        of.partial, of.provisional, of.method, of.effects);
    };
    return is.parts == should.parts && texts(is) != texts(should);
}

Result<std::optional<StaleFrame>> MosaicMaker::make_stale(int threads,
                                                          std::vector<std::string>& problems) {
    StaleFrame frame;
    {
        const MutexLock lock(mutex_);
        if (unchecked_.empty()) return std::optional<StaleFrame>{};
        frame.name = unchecked_.extract(unchecked_.begin()).value();
    }
    const auto look = [&]() -> Status {
        const auto found = domain_of(domains_, frame.name);
        if (!found) return pass_on(found);
        const FrameJob job{**found, frame.name.moment, frame.name.time, threads};
        Mutex& frames = frames_of(job.domain.name, job.moment);
        const MutexLock lock(frames);
        auto partials = MappedPartials::open(*store_, job.domain, job.moment, job.instant,
                                             job.instant, problems);
        if (!partials) return pass_on(partials);
        const auto stale = is_stale(job, *partials);
        if (!stale) return pass_on(stale);
        if (!*stale) return {};
        auto made = make(job, *partials, problems, frames);
        if (!made) return pass_on(made);
        frame.made = std::move(*made);
        return {};
    };
    const auto look_later = [&] {
        const MutexLock lock(mutex_);
        unchecked_.insert(frame.name);
    };
    Status looked;
    try {
        looked = look();
    } catch (...) {  // memory is short
        look_later();
        throw;
    }
    if (!looked) {
        if (may_pass(looked.error())) look_later();
        return pass_on(looked);
    }
    return std::optional{std::move(frame)};
}

void MosaicMaker::note_frames(const Domain& domain, const OthersPartial& partial, UtcTime middle) {
    const MutexLock lock(mutex_);
    for (const UtcTime instant : instants_between(middle - greatest_frame_gap,
                                                  middle + greatest_frame_gap, domain.interval))
        unchecked_.insert({domain.name, partial.name.moment, instant});
}

Result<FrameMade> MosaicMaker::make_again(const cache::GridName& frame, int threads,
                                          std::vector<std::string>& problems) {
    const auto found = domain_of(is_idle() ? std::span<const Domain>{} : domains_, frame);
    if (!found) return pass_on(found);
    const Domain* const domain = *found;
    if (!is_frame_time(frame.time, domain->interval)) {
        return fail(ErrorCode::bad_argument, "{} has frames every {} s, so none at {}",
                    domain->name, domain->interval.count(), format_utc(frame.time));
    }
    Mutex& frames = frames_of(domain->name, frame.moment);
    const MutexLock lock(frames);
    const Unreadable unreadable =
        frames_when_ == FramesWhen::asked_for ? Unreadable::is_an_error : Unreadable::is_left_out;
    auto partials = MappedPartials::open(*store_, *domain, frame.moment, frame.time, frame.time,
                                         problems, unreadable);
    if (!partials) return pass_on(partials);
    return make({*domain, frame.moment, frame.time, threads}, *partials, problems, frames);
}

}  // namespace stormcellar::pipeline
