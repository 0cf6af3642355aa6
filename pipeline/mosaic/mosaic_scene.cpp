#include "pipeline/mosaic/mosaic_scene.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "accuracy/timing.h"

namespace stormcellar::pipeline {
namespace {

Result<MadePartial> make_one(const SceneVolume& source, const grid::GridSpec& domain,
                             const PartialOptions& options, GeometryCache& geometries) {
    auto made = make_partial(*source.volume, source.site, domain, options, geometries);
    if (!made) return fail(made.error().code, "{}: {}", source.file, made.error().message);
    if (!*made) {
        return fail(ErrorCode::bad_argument, "{}: {} sees nothing of the grid", source.file,
                    source.site.icao);
    }
    grid::Provenance& provenance = (*made)->description.provenance;
    provenance.source_files = {std::filesystem::path(source.file).filename().string()};
    provenance.partial = source.partial;
    provenance.notes.insert(provenance.notes.begin(), source.notes.begin(), source.notes.end());
    for (std::string& note : provenance.notes)
        note = fmt::format("{}: {}", source.site.icao, note);
    return std::move(**made);
}

}  // namespace

Result<std::vector<MadePartial>> make_partials(std::span<const SceneVolume> volumes,
                                               const grid::GridSpec& domain,
                                               const PartialOptions& options,
                                               GeometryCache& geometries) {
    std::vector<MadePartial> partials;
    for (const SceneVolume& source : volumes) {
        auto made = make_one(source, domain, options, geometries);
        if (!made) return pass_on(made);
        partials.push_back(std::move(*made));
    }
    return partials;
}

std::vector<PartialView> views_of(const std::vector<MadePartial>& partials) {
    std::vector<PartialView> views;
    views.reserve(partials.size());
    for (const MadePartial& partial : partials)
        views.push_back({&partial.description, partial.bricks.view()});
    return views;
}

UtcTime instant_of_newest(std::span<const PartialView> partials,
                          std::chrono::milliseconds greatest_gap) {
    std::map<std::string, UtcTime> newest;
    for (const PartialView& partial : partials) {
        UtcTime& time = newest[partial.site().icao];
        time = std::max(time, partial.middle());
    }
    const auto [first, last] =
        std::minmax_element(newest.begin(), newest.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; });
    const auto half = (last->second - first->second) / 2;
    return half <= greatest_gap ? first->second + half : last->second;
}

Result<MosaicScene> MosaicScene::make(std::vector<SceneVolume> volumes,
                                      const grid::GridSpec& domain, const accuracy::Chain& chain,
                                      const MosaicSceneOptions& options) {
    if (volumes.empty()) return fail(ErrorCode::bad_argument, "a mosaic needs at least one volume");
    MosaicScene scene;
    scene.domain_ = domain;
    scene.options_ = options;
    scene.geometries_ = std::make_shared<GeometryCache>(volumes.size() + 1);
    const double beam_width_deg = grid::beam_width_of(volumes.front().site.icao);
    scene.default_ = mosaic_choice(chain, default_mosaic_choice(chain, domain, beam_width_deg));
    auto partials = make_partials(volumes, domain, with_choice(options.partial, scene.default_),
                                  *scene.geometries_);
    if (!partials) return pass_on(partials);
    const auto near = scene.keep_what_is_near(std::move(volumes), std::move(*partials));
    if (!near) return pass_on(near);
    return scene;
}

Status MosaicScene::keep_what_is_near(std::vector<SceneVolume> volumes,
                                      std::vector<MadePartial> partials) {
    const auto all = views_of(partials);
    instant_ = options_.instant.value_or(instant_of_newest(all));
    std::set<std::size_t> used;
    for (const Bracket& bracket : brackets_of(all, instant_, options_.frame.greatest_gap)) {
        if (bracket.before) used.insert(*bracket.before);
        if (bracket.after) used.insert(*bracket.after);
    }
    std::vector<MadePartial> near;
    for (const std::size_t at : used) {
        volumes_.push_back(std::move(volumes[at]));
        times_.push_back({partials[at].description.start_time, partials[at].description.end_time});
        near.push_back(std::move(partials[at]));
    }
    const auto& kept = kept_.keep({default_.gridding, default_.fine_codes}, std::move(near));
    if (volumes_.empty()) {
        return fail(ErrorCode::not_found, "no site has a volume near {}", format_utc(instant_));
    }
    const auto views = views_of(kept);
    brackets_ = brackets_of(views, instant_, options_.frame.greatest_gap);
    const double start_s = now_s();
    auto motions =
        estimate_motions(views, instant_, options_.partial.gridder.moment, options_.frame);
    if (!motions) return pass_on(motions);
    motions_ = std::move(*motions);
    motion_s_ = now_s() - start_s;
    return {};
}

double MosaicScene::now_s() const {
    return options_.frame.threads == 1 ? accuracy::thread_s() : accuracy::monotonic_s();
}

std::size_t MosaicScene::pair_count() const {
    return static_cast<std::size_t>(
        std::count_if(brackets_.begin(), brackets_.end(), [](const Bracket& bracket) {
            return bracket.before.has_value() && bracket.after.has_value();
        }));
}

Result<const std::vector<MadePartial>*> MosaicScene::partials(const MosaicChoice& choice) {
    const Gridding gridding{choice.gridding, choice.fine_codes};
    if (const auto* found = kept_.find(gridding)) return found;
    auto made =
        make_partials(volumes_, domain_, with_choice(options_.partial, choice), *geometries_);
    if (!made) return pass_on(made);
    return &kept_.keep(gridding, std::move(*made));
}

void MosaicScene::forget(const MosaicChoice& choice) {
    kept_.drop({choice.gridding, choice.fine_codes});
}

Result<MosaicFrame> MosaicScene::frame(const MosaicChoice& choice) {
    const auto made = partials(choice);
    if (!made) return pass_on(made);
    FrameOptions options = with_choice(options_.frame, choice);
    options.motions = &motions_;
    return make_frame(domain_, views_of(**made), instant_, options, *geometries_);
}

}  // namespace stormcellar::pipeline
