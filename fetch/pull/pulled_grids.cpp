#include "fetch/pull/pulled_grids.h"

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include <sys/stat.h>

#include "stormcellar/base/mutex.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::pull {
namespace {

namespace fs = std::filesystem;

std::string tag_of_checksum(std::uint64_t checksum) {
    return fmt::format("\"{:016x}\"", checksum);
}

std::uint64_t bytes_on_disk(const fs::path& path) {
    struct stat facts {};
    return ::stat(path.c_str(), &facts) == 0 ? static_cast<std::uint64_t>(facts.st_blocks) * 512
                                             : 0;
}

// The log shows only this much of a tag; a server may send 100 kB.
constexpr std::size_t most_told_of_tag = 40;

// Checks the whole file. Only one thread may check at a time, because a check may take half a
// gigabyte of memory.
Status check(const fs::path& path, const cache::GridName& name, const std::string& tag) {
    static Mutex one_at_a_time;
    const MutexLock lock(one_at_a_time);
    const auto file = cache::GridFile::open(path, cache::limits_of_site);
    if (!file) return pass_on(file);
    const cache::GridDescription& grid = file->description();
    const std::string icao = name.domain.substr(name.domain.find('.') + 1);
    const bool is_it = grid.moment == name.moment && grid.time == name.time &&
                       grid.sites.size() == 1 && grid.sites.front().icao == icao;
    if (!is_it) return fail(ErrorCode::corrupt, "the grid is not the one that was asked for");
    if (tag != tag_of_checksum(file->checksum())) {
        return fail(ErrorCode::corrupt, "the checksum {} of the grid is not the server's {}",
                    tag_of_checksum(file->checksum()),
                    tag.empty() ? "(none)" : tag.substr(0, most_told_of_tag));
    }
    if (Status good = file->verify(); !good) return good;
    return file->check_whole();
}

}  // namespace

Result<PulledGrids> PulledGrids::open(FileSystem& file_system, fs::path directory,
                                      PulledLimits limits) {
    // The store removes the leftovers of a killed writer when it is opened as the only writer.
    const auto store = cache::StoreWriter::open(file_system, directory, true);
    if (!store) return pass_on(store);
    PulledGrids grids(file_system, std::move(directory), limits);
    std::error_code ignored;
    fs::remove(grids.incoming(), ignored);
    const auto domains = store->domains();
    if (!domains) return pass_on(domains);
    for (const std::string& domain : *domains) {
        for (std::size_t i = 0; i < level2::moment_count; ++i) {
            const auto moment = static_cast<level2::Moment>(i);
            const auto entries = store->list(domain, moment, std::nullopt, std::nullopt);
            if (!entries) return pass_on(entries);
            for (const cache::StoreEntry& entry : *entries)
                grids.remember({domain, moment, entry.time}, {});
        }
    }
    return grids;
}

void PulledGrids::remember(const cache::GridName& name, std::string tag) {
    Known& known = grids_[name];
    bytes_ -= known.bytes;
    known = {bytes_on_disk(path_of(name)), std::move(tag)};
    bytes_ += known.bytes;
}

std::string PulledGrids::tag_of(const cache::GridName& name) {
    const auto known = grids_.find(name);
    if (known == grids_.end()) return {};
    if (known->second.tag.empty()) {
        const auto file = cache::GridFile::open(path_of(name));
        if (file) known->second.tag = tag_of_checksum(file->checksum());
    }
    return known->second.tag;
}

Result<PulledGrids::Incoming> PulledGrids::begin(const cache::GridName& name) {
    auto file = AtomicFile::create(*file_system_, incoming());
    if (!file) return pass_on(file);
    return Incoming(name, std::move(*file));
}

Status PulledGrids::give_name(Incoming& incoming_file) {
    const fs::path path = path_of(incoming_file.name_);
    if (Status whole = incoming_file.file_.commit(); !whole) return whole;
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) return fail(ErrorCode::io, "{}: {}", path.native(), error.message());
    if (Status named = file_system_->rename(incoming(), path); !named) return named;
    return file_system_->sync_directory(path.parent_path());
}

Status PulledGrids::keep(Incoming incoming, const std::string& tag) {
    const Status good = check(incoming.file_.temporary_path(), incoming.name_, tag);
    if (!good) {
        // Let the message name the final path of the grid instead of the temporary path.
        std::string why = good.error().message;
        const std::string temporary = incoming.file_.temporary_path().native() + ": ";
        if (why.starts_with(temporary)) why.erase(0, temporary.size());
        return fail(good.error().code, "{}: {}", path_of(incoming.name_).native(), why);
    }
    if (Status named = give_name(incoming); !named) {
        std::error_code ignored;
        fs::remove(this->incoming(), ignored);
        remove_empty_above(path_of(incoming.name_));
        return named;
    }
    remember(incoming.name_, tag);
    return {};
}

void PulledGrids::remove_empty_above(const fs::path& path) const {
    std::error_code ignored;
    for (fs::path above = path.parent_path(); above != directory_; above = above.parent_path())
        if (!fs::remove(above, ignored)) break;
}

// Removes a grid, and the directories above it that become empty.
void PulledGrids::remove(const cache::GridName& name) {
    const fs::path path = path_of(name);
    (void)file_system_->remove(path);
    remove_empty_above(path);
    bytes_ -= grids_[name].bytes;
    grids_.erase(name);
}

std::size_t PulledGrids::prune(UtcTime now) {
    std::vector<cache::GridName> oldest_first;
    for (const auto& [name, known] : grids_)
        oldest_first.push_back(name);
    std::ranges::sort(oldest_first, {}, &cache::GridName::time);
    std::size_t removed = 0;
    for (const cache::GridName& name : oldest_first) {
        const bool has_room = bytes_ <= limits_.bytes && grids_.size() <= limits_.grids;
        if (name.time >= now - limits_.age && has_room) break;
        remove(name);
        ++removed;
    }
    return removed;
}

std::optional<UtcTime> PulledGrids::newest() const {
    std::optional<UtcTime> newest;
    for (const auto& [name, known] : grids_)
        newest = std::max(newest.value_or(name.time), name.time);
    return newest;
}

}  // namespace stormcellar::pull
