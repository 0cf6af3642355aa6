// catalog/catalog_parts.h -- what a Catalog consists of: its databases, opened when they are asked
// for, and mended when they are found damaged.
//
// Inside the catalog room only. Thread contract: that of Catalog; each database is for one thread
// at a time.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <sys/types.h>

#include "catalog/catalog.h"
#include "catalog/path_homes.h"
#include "catalog/station_database.h"

namespace stormcellar::catalog {

inline constexpr std::string_view database_ending = ".sqlite";

// Of a database's name; empty: of files whose station is not known.
[[nodiscard]] std::string station_of(const std::string& name);

// Tells whether a path still names the file that it named.
struct FileIdentity {
    dev_t device = 0;
    ino_t inode = 0;
    bool operator==(const FileIdentity&) const = default;

    static FileIdentity of(const std::filesystem::path& path);
};

// Whether a database has a row of a path whose guessed_home() is another.
enum class Strays : std::uint8_t {
    unknown,
    none,
    some,
    too_many_rows,  // to look through them while a file waits; mark_missing() does
};

struct Catalog::Impl {
    struct Slot {
        std::mutex mutex;  // guards what follows
        std::unique_ptr<StationDatabase> database;
        FileIdentity file;
        std::atomic<Strays> strays = Strays::unknown;  // written under the mutex, read without
    };

    std::filesystem::path directory;
    bool writing = false;
    std::mutex slots_mutex;  // guards the map, not what its slots hold
    std::map<std::string, std::unique_ptr<Slot>, std::less<>> slots;
    PathHomes homes;
    std::mutex repairs_mutex;  // guards repairs
    std::vector<Repair> repairs;

    [[nodiscard]] std::filesystem::path path_of(const std::string& name) const {
        return directory / (name + std::string{database_ending});
    }

    Slot& slot(const std::string& name) {
        const std::scoped_lock lock(slots_mutex);
        auto& place = slots[name];
        if (!place) place = std::make_unique<Slot>();
        return *place;
    }

    // Runs `work` on the database of that name, opened when need be, and mended when it is damaged.
    // Missing databases are created when writing and `create` is set; else not_found.
    template <class Work>
    auto with(const std::string& name, bool create, Work work)
        -> Result<decltype(work(std::declval<StationDatabase&>()))> {
        Slot& place = slot(name);
        const std::scoped_lock lock(place.mutex);
        auto done = attempt(place, name, create, work);
        if (done || !writing || done.error().code != ErrorCode::corrupt) return done;
        if (!mend(place, name)) return done;
        return attempt(place, name, create, work);
    }

    template <class Work>
    auto attempt(Slot& place, const std::string& name, bool create, Work work)
        -> Result<decltype(work(std::declval<StationDatabase&>()))> {
        const std::filesystem::path path = path_of(name);
        if (Status ready = open(place, name, create); !ready) return pass_on(ready);
        const bool is_snapshot = place.database->is_snapshot();
        try {
            auto done = work(*place.database);
            if (is_snapshot) place.database.reset();
            return done;
        } catch (const SQLite::Exception& error) {
            // Where a file cannot be opened for writing, SQLite opens it for reading, and stays so.
            const bool is_stuck = writing && code_of(error) == ErrorCode::permission;
            if (is_snapshot || is_stuck) place.database.reset();
            return fail(code_of(error), "{}: {}", path.native(), error.what());
        }
    }

    Status open(Slot& place, const std::string& name, bool create);
    // Whether another attempt has a chance: the damage is set aside, or was none that lasts.
    bool mend(Slot& place, const std::string& name);

    void note_repair(Repair repair) {
        const std::scoped_lock lock(repairs_mutex);
        repairs.push_back(std::move(repair));
    }

    // The names of all databases in the directory, sorted.
    [[nodiscard]] Result<std::vector<std::string>> names() const;

    // The names of those that may have a row of the path. A row in another database than
    // guessed_home() says is a stray: of a file that is named like one station and holds another's,
    // or none's. A writer, who sees all that is written, knows which databases have any: few, so a
    // new file is not looked for in every station's.
    [[nodiscard]] Result<std::vector<std::string>> names_that_may_have(
        const std::filesystem::path& path);
    // The paths of rows that are not gone. Looks for strays on the way where nobody could.
    [[nodiscard]] std::vector<std::filesystem::path> paths_below(StationDatabase& database,
                                                                 const std::filesystem::path& below,
                                                                 const std::string& name);
    // Called before the row is written, with the slot's mutex held.
    void expect_row(const std::filesystem::path& path, const std::string& name) {
        if (guessed_home(path.native()) != name) slot(name).strays = Strays::some;
    }

  private:
    [[nodiscard]] bool may_have_strays(const std::string& name);
    // What names() gave, until a database is opened or found to have gone. Of a writer.
    std::mutex listed_mutex_;
    std::optional<std::vector<std::string>> listed_;
    std::atomic<bool> is_listing_old_ = false;
};

}  // namespace stormcellar::catalog
