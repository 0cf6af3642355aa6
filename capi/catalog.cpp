#include "stormcellar/catalog/catalog.h"

#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

#include "capi/guarded.h"
#include "capi/query.h"

struct stormcellar_catalog {
    stormcellar::catalog::CatalogReader reader;
};

struct stormcellar_file_list {
    std::vector<stormcellar::catalog::CatalogEntry> entries;
};

namespace stormcellar::capi {
namespace {

Status open_catalog(const char* directory, stormcellar_catalog** catalog) {
    if (directory == nullptr || catalog == nullptr)
        return is_null(directory == nullptr ? "directory" : "catalog");
    *catalog = nullptr;
    auto reader = catalog::CatalogReader::open(directory);
    if (!reader) return pass_on(reader);
    *catalog = new stormcellar_catalog{std::move(*reader)};
    return {};
}

// Returns the volumes of all stations whose databases can be read.
Result<std::vector<catalog::CatalogEntry>> list_all(const catalog::CatalogReader& reader,
                                                    const catalog::Query& query) {
    const auto stations = reader.station_names();
    if (!stations) return pass_on(stations);
    std::vector<catalog::CatalogEntry> all;
    for (const std::string& station : *stations) {
        auto some = reader.list(station, query);
        if (some) std::ranges::move(*some, std::back_inserter(all));
    }
    return all;
}

Status list_files(const stormcellar_catalog* catalog, const stormcellar_query* query,
                  stormcellar_file_list** list, std::size_t* count) {
    if (catalog == nullptr || list == nullptr || count == nullptr)
        return is_null(catalog == nullptr ? "catalog" : list == nullptr ? "list" : "count");
    *list = nullptr;
    const auto wanted = take(query);
    if (!wanted) return pass_on(wanted);
    if (wanted->moment != nullptr)
        return fail(ErrorCode::bad_argument, "a catalog does not know the moments of its files");
    const TimeRange range = range_of(*wanted);
    const catalog::Query times{.from = range.from, .to = range.to};
    auto entries = wanted->name != nullptr ? catalog->reader.list(wanted->name, times)
                                           : list_all(catalog->reader, times);
    if (!entries) return pass_on(entries);
    *count = entries->size();
    *list = new stormcellar_file_list{std::move(*entries)};
    return {};
}

Status describe_file(const stormcellar_file_list* list, std::size_t index,
                     stormcellar_file_facts* to) {
    if (list == nullptr) return is_null("list");
    if (index >= list->entries.size())
        return fail(ErrorCode::bad_argument, "there is no entry {}; there are {}", index,
                    list->entries.size());
    const catalog::CatalogEntry& entry = list->entries[index];
    stormcellar_file_facts facts{};
    facts.path = entry.path.c_str();
    facts.reason = entry.reason.c_str();
    copy_text(entry.station, facts.station, sizeof facts.station);
    copy_text(catalog::file_state_name(entry.state), facts.state, sizeof facts.state);
    facts.start_ms = milliseconds_of(entry.volume.start_time);
    facts.end_ms = milliseconds_of(entry.volume.end_time);
    facts.bytes = entry.size_bytes;
    facts.volume = entry.number_in_file;
    facts.vcp = entry.volume.vcp.value_or(-1);
    facts.sweeps = entry.volume.sweep_count;
    facts.radials = entry.volume.radial_count;
    facts.complete = entry.volume.complete ? 1 : 0;
    return give(facts, to);
}

}  // namespace
}  // namespace stormcellar::capi

using namespace stormcellar;

stormcellar_code stormcellar_catalog_open(const char* directory, stormcellar_catalog** catalog,
                                          stormcellar_error* error) {
    return capi::guarded(error, [&] { return capi::open_catalog(directory, catalog); });
}

void stormcellar_catalog_free(stormcellar_catalog* catalog) {
    delete catalog;
}

stormcellar_code stormcellar_catalog_list(const stormcellar_catalog* catalog,
                                          const stormcellar_query* query,
                                          stormcellar_file_list** list, size_t* count,
                                          stormcellar_error* error) {
    return capi::guarded(error, [&] { return capi::list_files(catalog, query, list, count); });
}

void stormcellar_file_list_free(stormcellar_file_list* list) {
    delete list;
}

stormcellar_code stormcellar_file_list_describe(const stormcellar_file_list* list, size_t index,
                                                stormcellar_file_facts* facts,
                                                stormcellar_error* error) {
    return capi::guarded(error, [&] { return capi::describe_file(list, index, facts); });
}
