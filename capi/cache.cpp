#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "capi/grid_handle.h"
#include "capi/guarded.h"
#include "capi/query.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/grid/brick_grid.h"

struct stormcellar_cache {
    stormcellar::cache::StoreReader reader;
};

struct stormcellar_grid_list {
    std::vector<stormcellar::cache::StoreEntry> entries;
};

namespace stormcellar::capi {
namespace {

Status open_cache(const char* directory, stormcellar_cache** cache) {
    if (directory == nullptr || cache == nullptr)
        return is_null(directory == nullptr ? "directory" : "cache");
    *cache = nullptr;
    auto reader = cache::StoreReader::open(directory);
    if (!reader) return pass_on(reader);
    *cache = new stormcellar_cache{std::move(*reader)};
    return {};
}

Status list_grids(const stormcellar_cache* cache, const stormcellar_query* query,
                  stormcellar_grid_list** list, std::size_t* count) {
    if (cache == nullptr || list == nullptr || count == nullptr)
        return is_null(cache == nullptr ? "cache" : list == nullptr ? "list" : "count");
    *list = nullptr;
    const auto wanted = take(query);
    if (!wanted) return pass_on(wanted);
    auto domains = cache->reader.domains();
    if (!domains) return pass_on(domains);
    if (wanted->name != nullptr) *domains = {wanted->name};
    auto moments = moments_named(wanted->moment);
    if (!moments) return pass_on(moments);
    if (moments->empty()) moments->assign(level2::all_moments.begin(), level2::all_moments.end());
    const TimeRange range = range_of(*wanted);
    std::vector<cache::StoreEntry> all;
    for (const std::string& domain : *domains) {
        for (const level2::Moment moment : *moments) {
            auto some = cache->reader.list(domain, moment, range.from, range.to);
            if (!some) return pass_on(some);
            std::ranges::move(*some, std::back_inserter(all));
        }
    }
    *count = all.size();
    *list = new stormcellar_grid_list{std::move(all)};
    return {};
}

Status describe_entry(const stormcellar_grid_list* list, std::size_t index,
                      stormcellar_grid_file_facts* to) {
    if (list == nullptr) return is_null("list");
    if (index >= list->entries.size())
        return fail(ErrorCode::bad_argument, "there is no entry {}; there are {}", index,
                    list->entries.size());
    const cache::StoreEntry& entry = list->entries[index];
    stormcellar_grid_file_facts facts{};
    facts.path = entry.path.c_str();
    facts.domain = entry.domain.c_str();
    copy_text(level2::moment_name(entry.moment), facts.moment, sizeof facts.moment);
    facts.time_ms = milliseconds_of(entry.time);
    facts.bytes = entry.bytes_on_disk;
    return give(facts, to);
}

// Returns the domain of a grid file in a cache; empty for a file elsewhere.
std::string domain_of(const std::filesystem::path& path, level2::Moment moment) {
    const std::string domain = path.parent_path().parent_path().parent_path().filename();
    const auto time = cache::time_in_file_name(domain, moment, path.filename().native());
    return time ? domain : std::string{};
}

Status read_grid(const char* path, stormcellar_grid** grid) {
    if (path == nullptr || grid == nullptr) return is_null(path == nullptr ? "path" : "grid");
    *grid = nullptr;
    const auto file = cache::GridFile::open(path);
    if (!file) return pass_on(file);
    if (Status good = file->verify(); !good) return good;
    const cache::GridDescription& description = file->description();
    grid::Grid cells = grid::to_dense(file->view());
    cells.moment = description.moment;
    cells.time = description.time;
    cells.start_time = description.start_time;
    cells.end_time = description.end_time;
    cells.sites = description.sites;
    cells.provenance = description.provenance;
    const bool is_mean =
        grid::cell_extent_of(description.provenance.method) == grid::CellExtent::area;
    *grid = new stormcellar_grid{std::move(cells), is_mean, domain_of(path, description.moment)};
    return {};
}

}  // namespace
}  // namespace stormcellar::capi

using namespace stormcellar;

stormcellar_code stormcellar_cache_open(const char* directory, stormcellar_cache** cache,
                                        stormcellar_error* error) {
    return capi::guarded(error, [&] { return capi::open_cache(directory, cache); });
}

void stormcellar_cache_free(stormcellar_cache* cache) {
    delete cache;
}

stormcellar_code stormcellar_cache_list(const stormcellar_cache* cache,
                                        const stormcellar_query* query,
                                        stormcellar_grid_list** list, size_t* count,
                                        stormcellar_error* error) {
    return capi::guarded(error, [&] { return capi::list_grids(cache, query, list, count); });
}

void stormcellar_grid_list_free(stormcellar_grid_list* list) {
    delete list;
}

stormcellar_code stormcellar_grid_list_describe(const stormcellar_grid_list* list, size_t index,
                                                stormcellar_grid_file_facts* facts,
                                                stormcellar_error* error) {
    return capi::guarded(error, [&] { return capi::describe_entry(list, index, facts); });
}

stormcellar_code stormcellar_grid_read(const char* path, stormcellar_grid** grid,
                                       stormcellar_error* error) {
    return capi::guarded(error, [&] { return capi::read_grid(path, grid); });
}
