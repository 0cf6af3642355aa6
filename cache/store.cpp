#include "stormcellar/cache/store.h"

#include <algorithm>
#include <set>
#include <system_error>
#include <utility>

#include "base/unsynced_files.h"
#include "cache/directories.h"
#include "cache/leftover_watch.h"
#include "cache/roller.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::cache {
namespace {

namespace fs = std::filesystem;

// A commit is tried this often: another process may remove an empty directory before the file is
// created in it, and other programs may take the room that an eviction made on a full disk.
constexpr int most_tries = 4;

// Creates the directory, and syncs its parent, so that it survives a power cut.
Status make_cache_directory(FileSystem& file_system, const fs::path& directory) {
    std::error_code error;
    const bool created = fs::create_directories(directory, error);
    if (error) return directory_failure(directory, error);
    if (!created) return {};
    const fs::path parent = fs::absolute(directory).lexically_normal().parent_path();
    return file_system.sync_directory(parent);
}

}  // namespace

struct StoreWriter::DurableDirectories {
    Mutex mutex;
    std::set<fs::path> paths STORMCELLAR_GUARDED_BY(mutex);
};

Result<StoreReader> StoreReader::open(fs::path directory) {
    std::error_code error;
    const fs::file_status status = fs::status(directory, error);
    if (status.type() == fs::file_type::not_found) {
        return fail(ErrorCode::not_found, "{}: there is no cache here", directory.native());
    }
    if (error) return directory_failure(directory, error);
    if (status.type() != fs::file_type::directory) {
        return fail(ErrorCode::not_a_file, "{}: is not a directory", directory.native());
    }
    return StoreReader(std::move(directory));
}

void leave_out_future(std::vector<StoreEntry>& entries, UtcTime now) {
    const auto first = std::ranges::find_if(
        entries, [&](const StoreEntry& entry) { return !is_believed(entry.time, now); });
    if (first != entries.begin()) entries.erase(first, entries.end());
}

StoreWriter::StoreWriter(FileSystem& file_system, fs::path directory,
                         std::unique_ptr<Roller> roller)
    : StoreReader(std::move(directory)),
      file_system_(&file_system),
      durable_(std::make_unique<DurableDirectories>()),
      roller_(std::move(roller)) {}
StoreWriter::StoreWriter(StoreWriter&&) noexcept = default;
StoreWriter& StoreWriter::operator=(StoreWriter&&) noexcept = default;
StoreWriter::~StoreWriter() = default;

Result<StoreWriter> StoreWriter::open(FileSystem& file_system, fs::path directory,
                                      bool sweep_temporary) {
    if (Status made = make_cache_directory(file_system, directory); !made) return pass_on(made);
    if (sweep_temporary) {
        if (Status swept = sweep_temporaries(file_system, directory); !swept) return pass_on(swept);
    }
    return StoreWriter(file_system, std::move(directory), nullptr);
}

RollingStore::RollingStore(FileSystem& file_system, fs::path directory,
                           std::unique_ptr<Roller> roller)
    : StoreWriter(file_system, std::move(directory), std::move(roller)) {}

Result<RollingStore> RollingStore::open(FileSystem& file_system, fs::path directory,
                                        Budgets budgets, Surroundings surroundings) {
    if (Status made = make_cache_directory(file_system, directory); !made) return pass_on(made);
    auto roller = Roller::open(file_system, directory, std::move(budgets), std::move(surroundings));
    if (!roller) return pass_on(roller);
    return RollingStore(file_system, std::move(directory), std::move(*roller));
}

// Creates the directory if it is missing, and syncs its parent, so that the directory survives a
// power cut. Also syncs at the first use of an existing directory, because its creator may have
// been killed before the sync.
Status StoreWriter::make_directory(const fs::path& directory) {
    std::error_code error;
    const bool created = fs::create_directory(directory, error);
    if (error) return directory_failure(directory, error);
    if (!created) {
        const MutexLock lock(durable_->mutex);
        if (durable_->paths.contains(directory)) return {};
    }
    if (Status synced = file_system_->sync_directory(directory.parent_path()); !synced) {
        return synced;
    }
    const MutexLock lock(durable_->mutex);
    durable_->paths.insert(directory);
    return {};
}

Result<fs::path> StoreReader::path_of(const std::string& domain, level2::Moment moment,
                                      UtcTime time) const {
    if (!is_domain_name(domain)) {
        return fail(ErrorCode::bad_argument,
                    "domain '{}': a name is up to 64 letters, digits, _ and -, and begins with a "
                    "letter or digit; a '.' and an ICAO may follow it",
                    domain);
    }
    if (!is_possible(time)) {
        return fail(ErrorCode::bad_argument,
                    "a grid of {}: its time is outside the years 1970 to 9999", domain);
    }
    return directory() / relative_path(GridName{domain, moment, time});
}

Status StoreWriter::write(FileSystem& file_system, const fs::path& path,
                          const GridDescription& description, const grid::BrickView& view,
                          Durability durability) {
    UnsyncedFiles unsynced(file_system);
    FileSystem& files = durability == Durability::power_cut ? file_system : unsynced;
    const fs::path day = path.parent_path();
    const fs::path& moment = day.parent_path();
    for (int tries = 1;; ++tries) {
        Status done;
        for (const fs::path& directory : {this->directory(), moment.parent_path(), moment, day}) {
            if (done) done = make_directory(directory);
        }
        if (done) {
            if (const auto written = write_grid_file(files, path, description, view, packing_)) {
                return {};
            } else {
                done = pass_on(written);
            }
        }
        if (done.error().code != ErrorCode::not_found || tries == most_tries) return done;
    }
}

Result<fs::path> StoreWriter::commit_within_budgets(const GridName& name, const fs::path& path,
                                                    const GridDescription& description,
                                                    const grid::BrickView& view,
                                                    Durability durability) {
    const std::uint64_t most = most_bytes_on_disk(description, view, roller_->block_bytes());
    const auto reserved = roller_->reserve(name, most);
    if (!reserved) return pass_on(reserved);
    if (!*reserved) return fs::path{};
    for (int tries = 1;; ++tries) {
        LeftoverWatch watch(*file_system_);
        Status written = write(watch, path, description, view, durability);
        if (watch.leftover()) roller_->add_leftover(group_of(name.domain), *watch.leftover());
        if (written) return path;
        const bool full = written.error().code == ErrorCode::no_space;
        if (full && tries < most_tries && roller_->make_room(name, most)) continue;
        if (full && roller_->leaves_out(name)) return fs::path{};
        return pass_on(written);
    }
}

Result<fs::path> StoreWriter::commit(const std::string& domain, const GridDescription& description,
                                     const grid::BrickView& view, Durability durability) {
    Result<fs::path> path = path_of(domain, description.moment, description.time);
    if (!path) return path;
    if (roller_) {
        return commit_within_budgets({domain, description.moment, description.time}, *path,
                                     description, view, durability);
    }
    if (Status written = write(*file_system_, *path, description, view, durability); !written) {
        return pass_on(written);
    }
    return path;
}

bool StoreWriter::would_keep(const std::string& domain, level2::Moment moment, UtcTime time) const {
    return !roller_ || roller_->would_keep({domain, moment, time});
}

RollReport RollingStore::roll(const std::function<void()>& step) {
    return roller().roll(step);
}

void RollingStore::set_budgets(Budgets budgets) {
    roller().set_budgets(std::move(budgets));
}

StoreUsage RollingStore::usage() const {
    return roller().usage();
}

Status StoreWriter::remove(const StoreEntry& entry) {
    const auto path = path_of(entry.domain, entry.moment, entry.time);
    if (!path) return pass_on(path);
    if (Status removed = file_system_->remove(*path); !removed) return removed;
    return file_system_->sync_directory(path->parent_path());
}

Result<std::vector<std::string>> StoreReader::domains() const {
    return domains_in(directory());
}

Result<std::vector<StoreEntry>> StoreReader::list(const std::string& domain, level2::Moment moment,
                                                  std::optional<UtcTime> from,
                                                  std::optional<UtcTime> to) const {
    std::vector<StoreEntry> entries;
    if (!is_domain_name(domain)) return entries;
    const auto days = days_in(directory() / domain / std::string(level2::moment_name(moment)));
    if (!days) return pass_on(days);
    // Days are compared by the names of their directories, so a query reads only the directories
    // that it needs. First clamp the limits to times that grids can have.
    const UtcTime lower = from.value_or(UtcTime{});
    const UtcTime upper = to.value_or(last_possible_time);
    const std::string first_day = day_name(std::clamp(lower, UtcTime{}, last_possible_time));
    const std::string last_day = day_name(std::clamp(upper, UtcTime{}, last_possible_time));
    for (const auto& day : *days) {
        if (day < first_day || day > last_day) continue;
        const auto contents = read_day(directory(), {domain, moment, day}, lower, upper);
        if (!contents) return pass_on(contents);
        for (const FoundGrid& grid : contents->grids) {
            entries.push_back({domain, moment, grid.time,
                               directory() / relative_path(GridName{domain, moment, grid.time}),
                               grid.bytes_on_disk, grid.pinned});
        }
    }
    return entries;
}

}  // namespace stormcellar::cache
