#include "pipeline/mosaic/mapped_partials.h"

#include <iterator>
#include <optional>
#include <utility>

#include "pipeline/mosaic/domain_frames.h"
#include "stormcellar/grid/grid_window.h"

namespace stormcellar::pipeline {
namespace {

constexpr std::chrono::milliseconds greatest_gap = FrameOptions{}.greatest_gap;
// If a station has more open partials than this, the partials that cannot contribute to a frame are
// closed.
constexpr std::size_t most_open = 24;

UtcTime middle_of_file(const OpenPartial& partial) {
    return PartialView{&partial.file.description(), {}, nullptr}.middle();
}

// Closes the partials that brackets_of() does not take: for each instant, it takes the last partial
// before the instant and the first one after it.
void keep_brackets(const std::vector<UtcTime>& instants, std::vector<OpenPartial>& files) {
    std::set<std::size_t> needed;
    for (const UtcTime instant : instants) {
        std::optional<std::size_t> before, after;
        for (std::size_t at = 0; at < files.size(); ++at) {
            const UtcTime middle = middle_of_file(files[at]);
            if (middle <= instant && (!before || middle >= middle_of_file(files[*before])))
                before = at;
            if (middle > instant && (!after || middle <= middle_of_file(files[*after]))) after = at;
        }
        if (before) needed.insert(*before);
        if (after) needed.insert(*after);
    }
    std::vector<OpenPartial> kept;
    for (const std::size_t at : needed)
        kept.push_back(std::move(files[at]));
    files = std::move(kept);
}

}  // namespace

Result<std::vector<std::string>> partial_domains(const cache::StoreReader& store,
                                                 const std::string& domain) {
    auto domains = store.domains();
    if (!domains) return domains;
    std::erase_if(*domains,
                  [&](const std::string& name) { return !name.starts_with(domain + "."); });
    return domains;
}

Result<MappedPartials> MappedPartials::open(const cache::StoreReader& store, const Domain& domain,
                                            level2::Moment moment, UtcTime from, UtcTime to,
                                            std::vector<std::string>& problems,
                                            Unreadable unreadable) {
    MappedPartials all;
    all.store_ = &store;
    all.domain_ = &domain;
    all.moment_ = moment;
    all.from_ = from;
    all.to_ = to;
    all.unreadable_ = unreadable;
    if (Status loaded = all.load(problems); !loaded) return pass_on(loaded);
    return all;
}

Status MappedPartials::load(std::vector<std::string>& problems) {
    files_.clear();
    const auto domains = partial_domains(*store_, domain_->name);
    if (!domains) return pass_on(domains);
    std::vector<UtcTime> instants = instants_between(from_, to_, domain_->interval);
    instants.insert(instants.end(), {from_, to_});
    for (const std::string& name : *domains) {
        const auto entries = store_->list(name, moment_, from_ - greatest_gap - longest_to_middle,
                                          to_ + greatest_gap);
        if (!entries) return pass_on(entries);
        std::vector<OpenPartial> of_station;
        for (const cache::StoreEntry& entry : *entries) {
            if (bad_.contains(entry.path)) continue;
            auto file = cache::GridFile::open(entry.path);
            if (!file && file.error().code == ErrorCode::io)
                // Try again, because a disk may fail once.
                file = cache::GridFile::open(entry.path);
            if (!file && ends_it(file.error()))
                return fail(is_shortage(file.error().code) ? file.error().code : ErrorCode::io,
                            "{}", file.error().message);
            if (!file) {
                problems.push_back(file.error().message);
                bad_.insert(entry.path);
                continue;
            }
            if (!grid::window_of(domain_->spec, file->description().spec)) continue;
            of_station.push_back({entry.path, std::move(*file)});
            if (of_station.size() > 2 * instants.size() + most_open)
                keep_brackets(instants, of_station);
        }
        if (of_station.size() > most_open) keep_brackets(instants, of_station);
        std::move(of_station.begin(), of_station.end(), std::back_inserter(files_));
    }
    return {};
}

bool MappedPartials::ends_it(const Error& error) const {
    const bool cannot_be_read =
        (error.code == ErrorCode::io || error.code == ErrorCode::permission) &&
        unreadable_ == Unreadable::is_an_error;
    return cannot_be_read || is_shortage(error.code);
}

std::vector<PartialView> MappedPartials::views() const {
    std::vector<PartialView> views;
    for (const auto& [path, file] : files_)
        views.push_back({&file.description(), file.view(), &file});
    return views;
}

Status MappedPartials::check_whole() const {
    for (const auto& [path, file] : files_) {
        if (Status whole = file.check_whole(); !whole) return whole;
    }
    return {};
}

Result<bool> MappedPartials::drop_damaged(std::vector<std::string>& problems) {
    const std::size_t known = bad_.size();
    for (const auto& [path, file] : files_) {
        const Status good = file.verify();
        if (good) continue;
        if (ends_it(good.error())) return pass_on(good);
        problems.push_back(good.error().message);
        bad_.insert(path);
    }
    if (bad_.size() == known) return false;
    // If damaged partials were dropped, other partials may contribute in their place.
    if (Status loaded = load(problems); !loaded) return pass_on(loaded);
    return true;
}

}  // namespace stormcellar::pipeline
