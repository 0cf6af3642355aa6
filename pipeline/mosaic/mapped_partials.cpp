#include "pipeline/mosaic/mapped_partials.h"

#include <utility>

#include "stormcellar/grid/grid_window.h"

namespace stormcellar::pipeline {
namespace {

constexpr std::chrono::milliseconds greatest_gap = FrameOptions{}.greatest_gap;

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
                                            std::vector<std::string>& problems) {
    MappedPartials all;
    const auto domains = partial_domains(store, domain.name);
    if (!domains) return pass_on(domains);
    for (const std::string& name : *domains) {
        const auto entries =
            store.list(name, moment, from - greatest_gap - longest_to_middle, to + greatest_gap);
        if (!entries) return pass_on(entries);
        for (const cache::StoreEntry& entry : *entries) {
            auto file = cache::GridFile::open(entry.path);
            if (!file) {
                problems.push_back(file.error().message);
                continue;
            }
            if (!grid::window_of(domain.spec, file->description().spec)) continue;
            all.files_.push_back(std::move(*file));
        }
    }
    return all;
}

std::vector<PartialView> MappedPartials::views() const {
    std::vector<PartialView> views;
    for (const cache::GridFile& file : files_)
        views.push_back({&file.description(), file.view(), &file});
    return views;
}

Status MappedPartials::check_whole() const {
    for (const cache::GridFile& file : files_) {
        if (Status whole = file.check_whole(); !whole) return whole;
    }
    return {};
}

bool MappedPartials::drop_damaged(std::vector<std::string>& problems) {
    const auto dropped = std::erase_if(files_, [&](const cache::GridFile& file) {
        const Status good = file.verify();
        if (!good) problems.push_back(good.error().message);
        return !good;
    });
    return dropped > 0;
}

}  // namespace stormcellar::pipeline
