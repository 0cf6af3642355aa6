#include "pipeline/mosaic/site_watch.h"

#include <algorithm>

#include "stormcellar/cache/grid_file.h"

namespace stormcellar::pipeline {
namespace {

// Number of newest frames to examine, because the very newest frames of a domain are provisional.
constexpr std::size_t frames_looked_at = 24;

bool has_reflectivity(const Domain& domain) {
    return std::find(domain.moments.begin(), domain.moments.end(), level2::Moment::ref) !=
           domain.moments.end();
}

}  // namespace

SiteWatch::SiteWatch(const cache::StoreReader& store, std::vector<Domain> domains)
    : store_(store), domains_(std::move(domains)) {
    std::erase_if(domains_, [](const Domain& domain) { return !has_reflectivity(domain); });
}

Result<std::optional<PairReport>> SiteWatch::compare_next() {
    for (const Domain& domain : domains_) {
        const auto frame = newest_complete(domain);
        if (!frame) return pass_on(frame);
        if (!*frame) continue;
        while (const auto pair = take_due(**frame)) {
            if (auto report = compare(**frame, *pair)) return report;
        }
    }
    return std::optional<PairReport>{};
}

Result<std::optional<SiteWatch::CompleteFrame>> SiteWatch::newest_complete(
    const Domain& domain) const {
    const auto entries = store_.list(domain.name, level2::Moment::ref, std::nullopt, std::nullopt);
    if (!entries) return pass_on(entries);
    std::size_t looked_at = 0;
    for (auto entry = entries->rbegin(); entry != entries->rend(); ++entry) {
        if (++looked_at > frames_looked_at) break;
        const auto file = cache::GridFile::open(entry->path);
        if (!file) continue;  // the frame is damaged; CacheMender repairs it
        const grid::Provenance& provenance = file->description().provenance;
        if (provenance.provisional || provenance.parts.empty()) continue;
        return CompleteFrame{&domain, file->description()};
    }
    return std::optional<CompleteFrame>{};
}

// Marks the pair as compared at the instant of this frame.
std::optional<SiteWatch::Pair> SiteWatch::take_due(const CompleteFrame& frame) {
    const auto& sites = frame.description.sites;
    const UtcTime now = frame.description.time;
    for (std::size_t a = 0; a < sites.size(); ++a) {
        for (std::size_t b = a + 1; b < sites.size(); ++b) {
            if (!may_overlap(sites[a], sites[b])) continue;
            const Pair pair{sites[a].icao, sites[b].icao};
            const auto [last, is_new] = compared_.try_emplace({frame.domain->name, pair}, now);
            if (!is_new && now < last->second + period) continue;
            last->second = now;
            return pair;
        }
    }
    return std::nullopt;
}

std::optional<PairReport> SiteWatch::compare(const CompleteFrame& frame, const Pair& pair) const {
    std::vector<cache::GridFile> files;
    for (const grid::FramePart& part : frame.description.provenance.parts) {
        if (part.icao != pair.first && part.icao != pair.second) continue;
        const auto path =
            store_.path_of(frame.domain->name + "." + part.icao, level2::Moment::ref, part.time);
        if (!path) continue;
        auto file = cache::GridFile::open(*path);
        if (file && file->verify()) files.push_back(std::move(*file));
    }
    std::vector<PartialView> views;
    views.reserve(files.size());
    for (const cache::GridFile& file : files)
        views.push_back({&file.description(), file.view(), &file});
    const UtcTime instant = frame.description.time;
    const auto looks = looks_about(views, instant);
    if (looks.size() != 2) return std::nullopt;
    auto found = compare_looks(looks[0], looks[1], instant);
    if (!found) return std::nullopt;
    const bool whole = std::all_of(files.begin(), files.end(), [](const cache::GridFile& file) {
        return file.check_whole().has_value();
    });
    if (!whole) return std::nullopt;
    PairReport report{frame.domain->name, instant, std::move(*found), {}};
    report.faults = grid::faults(report.found);
    return report;
}

}  // namespace stormcellar::pipeline
