#include "web/data/events/catalog_changes.h"

#include <memory>
#include <string_view>

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "stormcellar/base/station_table.h"

namespace stormcellar::web {
namespace {

constexpr std::string_view database_ending = ".sqlite", log_ending = ".sqlite-wal";

struct CloseCatalogListing {
    void operator()(DIR* listing) const { ::closedir(listing); }
};
using CatalogListing = std::unique_ptr<DIR, CloseCatalogListing>;

CatalogListing list_catalog(const std::filesystem::path& directory) {
    const int number = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (number < 0) return nullptr;
    CatalogListing listing(::fdopendir(number));
    if (!listing) ::close(number);
    return listing;
}

std::int64_t written_ns_of(const struct stat& facts) {
    return std::int64_t{facts.st_mtim.tv_sec} * 1'000'000'000 + facts.st_mtim.tv_nsec;
}

}  // namespace

std::vector<std::string> CatalogChanges::take() {
    std::map<std::string, Stamp> now;
    if (const CatalogListing listing = list_catalog(directory_)) {
        while (const dirent* entry = ::readdir(listing.get())) {
            const std::string_view name = entry->d_name;
            const std::string_view station = name.substr(0, name.find('.'));
            const std::string_view ending = name.substr(station.size());
            const bool is_log = ending == log_ending;
            if ((!is_log && ending != database_ending) || !is_icao(station)) continue;
            struct stat facts {};
            if (::fstatat(::dirfd(listing.get()), entry->d_name, &facts, AT_SYMLINK_NOFOLLOW) != 0)
                continue;
            Stamp& stamp = now[std::string(station)];
            (is_log ? stamp.log_modified_ns : stamp.modified_ns) = written_ns_of(facts);
            (is_log ? stamp.log_size : stamp.size) = facts.st_size;
        }
    }
    std::vector<std::string> changed;
    for (const auto& [station, stamp] : now) {
        const auto before = stamps_.find(station);
        if (before == stamps_.end() || before->second != stamp) changed.push_back(station);
    }
    stamps_ = std::move(now);
    return changed;
}

}  // namespace stormcellar::web
