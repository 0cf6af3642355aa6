#include "pipeline/mosaic/between_grids.h"

#include <algorithm>
#include <utility>

#include "pipeline/mosaic/domain_frames.h"
#include "pipeline/mosaic/frame_parts.h"
#include "pipeline/mosaic/mapped_partials.h"
#include "stormcellar/cache/grid_file.h"

namespace stormcellar::pipeline {
namespace {

constexpr std::size_t kept_geometries = 16;
constexpr std::size_t kept_instants_bytes = std::size_t{64} << 20U;

bool is_damage(const Error& error) {
    return error.code == ErrorCode::corrupt || error.code == ErrorCode::truncated ||
           error.code == ErrorCode::io;
}

PartialView view_of(const cache::GridFile& file) {
    return {&file.description(), file.view(), &file};
}

}  // namespace

BetweenGrids::BetweenGrids(const cache::StoreReader& store, level2::Moment moment,
                           BetweenOptions options)
    : store_(store),
      moment_(moment),
      options_(options),
      geometries_(std::make_unique<GeometryCache>(kept_geometries)),
      instants_(std::make_unique<InstantCache>(kept_instants_bytes)) {}

// Learns the rules of a mosaic from one of its frames. The recipe in a frame is a digest of the
// rules, so this function looks for rules with the same recipe.
Status BetweenGrids::learn_rules(const cache::GridDescription& newest) {
    Domain rules;
    rules.spec = newest.spec;
    rules.moments = {moment_};
    for (const grid::OverlapFacts& overlap : grid::overlap_facts) {
        for (const grid::TimeMethodFacts& time : grid::time_method_facts) {
            rules.overlap = overlap.overlap;
            rules.time = time.method;
            if (recipe_of(frame_options(rules, moment_, 1)) != newest.provenance.recipe) continue;
            rules.time = options_.method;
            mosaic_ = std::move(rules);
            return {};
        }
    }
    return fail(ErrorCode::unsupported,
                "frames cannot be made between those in the cache: they were merged by rules that "
                "are not known here (an overlap_km of its own?)");
}

Result<BetweenGrids> BetweenGrids::open(const cache::StoreReader& store, const std::string& domain,
                                        level2::Moment moment, const BetweenOptions& options,
                                        std::vector<std::string>& problems) {
    BetweenGrids all(store, moment, options);
    const auto margin = longest_bridge + longest_to_middle;
    const auto entries = store.list(
        domain, moment, options.from ? std::optional(*options.from - margin) : std::nullopt,
        options.to ? std::optional(*options.to + longest_bridge) : std::nullopt);
    if (!entries) return pass_on(entries);
    std::optional<cache::GridDescription> newest;
    for (const cache::StoreEntry& entry : *entries) {
        const auto file = cache::GridFile::open(entry.path);
        if (!file && is_shortage(file.error().code)) return pass_on(file);
        if (!file) {
            problems.push_back(file.error().message);
            continue;
        }
        newest = file->description();
        const bool is_frame = newest->provenance.recipe != 0;
        const UtcTime middle = is_frame ? newest->time : view_of(*file).middle();
        all.grids_.push_back(
            {entry.path, middle, newest->spec, !newest->provenance.sweeps.empty()});
    }
    if (!newest) {
        return fail(ErrorCode::not_found, "the cache has no grid of {}{}", domain,
                    options.from || options.to ? " near these times" : "");
    }
    std::stable_sort(all.grids_.begin(), all.grids_.end(),
                     [](const Stored& a, const Stored& b) { return a.middle < b.middle; });
    if (newest->provenance.recipe == 0 && newest->sites.size() == 1) return all;
    const auto sites = partial_domains(store, domain);
    if (!sites) return pass_on(sites);
    if (sites->empty()) {
        return fail(ErrorCode::not_found,
                    "frames cannot be made between those in the cache: the cache does not have the "
                    "grids of {}'s sites",
                    domain);
    }
    if (Status learnt = all.learn_rules(*newest); !learnt) return pass_on(learnt);
    all.mosaic_->name = domain;
    return all;
}

// Returns the index of the last grid whose time is not after the instant.
std::optional<std::size_t> BetweenGrids::before(UtcTime instant) const {
    const auto after =
        std::upper_bound(grids_.begin(), grids_.end(), instant,
                         [](UtcTime time, const Stored& grid) { return time < grid.middle; });
    if (after == grids_.begin()) return std::nullopt;
    return static_cast<std::size_t>(after - grids_.begin()) - 1;
}

std::vector<UtcTime> BetweenGrids::instants(std::chrono::seconds interval) const {
    UtcTime from = grids_.front().middle, to = grids_.back().middle;
    if (options_.from) from = std::max(from, *options_.from);
    if (options_.to) to = std::min(to, *options_.to);
    auto all = instants_between(from, to, interval);
    std::erase_if(all, [&](UtcTime instant) {
        const std::size_t at = before(instant).value_or(0);
        return grids_[at].middle != instant &&
               grids_[at + 1].middle - grids_[at].middle > longest_bridge;
    });
    return all;
}

Result<std::optional<MosaicFrame>> BetweenGrids::at(UtcTime instant) {
    return mosaic_ ? of_partials(instant) : of_volumes(instant);
}

Result<std::optional<MosaicFrame>> BetweenGrids::of_volumes(UtcTime instant) {
    const auto first = before(instant);
    if (!first) return std::optional<MosaicFrame>{};
    const bool has_next = *first + 1 < grids_.size() &&
                          grids_[*first + 1].middle - grids_[*first].middle <= longest_bridge;
    if (!has_next && grids_[*first].middle != instant) return std::optional<MosaicFrame>{};

    std::vector<cache::GridFile> files;
    for (std::size_t i = *first; i <= *first + (has_next ? 1 : 0); ++i) {
        auto file = cache::GridFile::open(grids_[i].path);
        if (!file) return pass_on(file);
        files.push_back(std::move(*file));
    }
    // If the grids have different shapes, use only the nearer one.
    if (has_next && grids_[*first].spec != grids_[*first + 1].spec) {
        const bool later = grids_[*first + 1].middle - instant < instant - grids_[*first].middle;
        files.erase(later ? files.begin() : files.begin() + 1);
    }
    std::vector<PartialView> views;
    views.reserve(files.size());
    for (const cache::GridFile& file : files)
        views.push_back(view_of(file));
    FrameOptions options;
    options.overlap.moment = moment_;
    options.overlap.overlap = grid::default_overlap(moment_);
    options.time = options_.method;
    options.greatest_gap = longest_bridge;
    options.threads = options_.threads;
    if (pair_ != first && views.size() == 2 && options.time == grid::TimeMethod::advected) {
        auto motions = estimate_motions(views, instant, moment_, options);
        if (!motions) return pass_on(motions);
        motions_ = std::move(*motions);
        pair_ = first;
    }
    options.motions = &motions_;
    auto frame =
        make_frame(files.front().description().spec, views, instant, options, *geometries_);
    if (!frame) return pass_on(frame);
    for (const cache::GridFile& file : files) {
        if (Status whole = file.check_whole(); !whole) return pass_on(whole);
    }
    return std::optional{std::move(*frame)};
}

Result<std::optional<MosaicFrame>> BetweenGrids::of_partials(UtcTime instant) {
    std::vector<std::string> damaged;  // to leave out, as in the domain's own frames
    auto partials = MappedPartials::open(store_, *mosaic_, moment_, instant, instant, damaged);
    if (!partials) return pass_on(partials);
    const FrameOptions options = frame_options(*mosaic_, moment_, options_.threads);
    while (true) {
        auto frame = make_frame(mosaic_->spec, partials->views(), instant, options, *geometries_,
                                {nullptr, instants_.get()});
        if (!frame && frame.error().code == ErrorCode::not_found) {
            return std::optional<MosaicFrame>{};
        }
        if (!frame && is_damage(frame.error())) {
            const auto dropped = partials->drop_damaged(damaged);
            if (!dropped) return pass_on(dropped);
            if (*dropped) continue;
        }
        if (!frame) return pass_on(frame);
        if (Status whole = partials->check_whole(); !whole) return pass_on(whole);
        return std::optional{std::move(*frame)};
    }
}

bool BetweenGrids::stands(const std::filesystem::path& path) const {
    if (!mosaic_) return false;
    const auto file = cache::GridFile::open(path);
    return file && file->description().spec == mosaic_->spec &&
           file->description().provenance.recipe == recipe_of(frame_options(*mosaic_, moment_, 1));
}

std::string BetweenGrids::method_text() const {
    std::string text(grid::time_method_name(options_.method));
    if (options_.method == grid::TimeMethod::nearest) return text;
    const bool moves =
        options_.method == grid::TimeMethod::advected && moment_ == level2::Moment::ref;
    if (!moves) text = "blend";
    const bool dated = mosaic_ || std::all_of(grids_.begin(), grids_.end(),
                                              [](const Stored& grid) { return grid.dated; });
    text += dated ? ", each sweep at its own time" : ", each volume as of its middle";
    return text;
}

}  // namespace stormcellar::pipeline
