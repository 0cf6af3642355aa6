// catalog/path_homes.h -- guesses which database has the row of a path, and remembers the database
// for the paths that were used last.
//
// Each path is needed several times and should be looked up once. Two paths with the same 64-bit
// hash would be confused; among 65,536 paths the probability is 1 in 9 billion. Used only inside
// the catalog room.
//
// Threads   Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "base/checksum.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/station_rule.h"

namespace stormcellar::catalog {

// The name of the database for files of unknown stations.
inline constexpr std::string_view unknown_station = "_unknown";

// Returns the station with which the file's name begins. Otherwise returns the name of the file's
// directory (KTLX/FILE), or of the directory above (KTLX/123/CHUNK), if that is a station's name.
// Otherwise returns unknown_station. With a rule, only stations that it knows count, so that names
// of files create no databases. The view refers to the bytes of the path or to unknown_station.
[[nodiscard]] std::string_view guessed_home(std::string_view path,
                                            const StationRule* rule = nullptr);

class PathHomes {
  public:
    // Notes that this database has the path. Call it after the row was written to this database.
    // Returns the database that had the path before, in which the caller must delete the row.
    // Returns an empty text if no database had the path, and none if nothing was noted about the
    // path.
    std::optional<std::string> exchange(const std::filesystem::path& path,
                                        const std::string& name) {
        const MutexLock lock(mutex_);
        const std::string* known = find(key_of(path));
        std::optional<std::string> before;
        if (known != nullptr) before = *known;
        add(key_of(path), name);
        return before;
    }
    // Notes that this database has the path. If another database is known to have the path, notes
    // nothing and returns false.
    [[nodiscard]] bool set_if_free(const std::filesystem::path& path, const std::string& name) {
        const MutexLock lock(mutex_);
        const std::string* known = find(key_of(path));
        if (known != nullptr && !known->empty() && *known != name) return false;
        add(key_of(path), name);
        return true;
    }
    void forget(const std::filesystem::path& path) {
        const MutexLock lock(mutex_);
        young_.erase(key_of(path));
        old_.erase(key_of(path));
    }
    // Notes that no database has the path, unless a database was noted in the meantime.
    void set_none(const std::filesystem::path& path) {
        const MutexLock lock(mutex_);
        if (find(key_of(path)) == nullptr) add(key_of(path), {});
    }
    // Returns the database that has the path; an empty text if no database has it; none if that is
    // unknown.
    [[nodiscard]] std::optional<std::string> of(const std::filesystem::path& path) const {
        const MutexLock lock(mutex_);
        const std::string* name = find(key_of(path));
        return name == nullptr ? std::nullopt : std::optional{*name};
    }

  private:
    static std::uint64_t key_of(const std::filesystem::path& path) {
        return xxh3_64(std::as_bytes(std::span{path.native()}));
    }
    [[nodiscard]] const std::string* find(std::uint64_t key) const STORMCELLAR_REQUIRES(mutex_) {
        for (const auto* known : {&young_, &old_}) {
            if (const auto found = known->find(key); found != known->end()) return &found->second;
        }
        return nullptr;
    }
    void add(std::uint64_t key, const std::string& name) STORMCELLAR_REQUIRES(mutex_) {
        if (young_.size() >= half) old_ = std::exchange(young_, {});
        young_.insert_or_assign(key, name);
    }
    static constexpr std::size_t half = 32'768;
    mutable Mutex mutex_;
    std::unordered_map<std::uint64_t, std::string> young_ STORMCELLAR_GUARDED_BY(mutex_);
    std::unordered_map<std::uint64_t, std::string> old_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::catalog
