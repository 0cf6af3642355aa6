// catalog/open_databases.h -- the open databases of a catalog, a limited set that closes the least
// recently used database first. Used only inside the catalog room.
//
// An open database takes three descriptors (itself, its WAL and the WAL's index). A thread that
// uses a database holds a lease and the mutex of the database's slot. Only databases without a
// lease are closed to make room. If all open databases are leased, the limit is exceeded, by at
// most one database for each working thread.
//
// The slot of a closed database takes some 200 bytes. A slot without information is dropped with
// its last lease, so requests for missing databases leave nothing behind.
//
// Cost      A lease takes 0.1 microseconds. Closing a database that was written takes 0.4 ms,
//           because its WAL is moved into the database and synced. Opening the database again takes
//           0.5 ms (medians of 200, 2026-11-25, a shared cloud machine of two cores).
// Threads   Any thread; a slot's mutex guards what the slot holds.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <string>

#include <sys/types.h>

#include "catalog/station_database.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::catalog {

// Identifies a file, because another file may have replaced it at its path.
struct FileIdentity {
    dev_t device = 0;
    ino_t inode = 0;
    bool operator==(const FileIdentity&) const = default;

    static FileIdentity of(const std::filesystem::path& path);
};

// Strays of a database: rows of paths whose guessed_home() is another database.
enum class Strays : std::uint8_t {
    unknown,
    none,
    some,
    too_many_rows,  // not searched while a file waits; mark_missing() searches later
};

// One database of the catalog, which may be open or closed.
struct Slot {
    Mutex mutex;
    std::unique_ptr<StationDatabase> database STORMCELLAR_GUARDED_BY(mutex);
    // The file that was opened last; zeros: none yet.
    FileIdentity file STORMCELLAR_GUARDED_BY(mutex);
    std::atomic<Strays> strays = Strays::unknown;  // written under the mutex, read without it

  private:
    friend class OpenDatabases;
    // The mutex of OpenDatabases guards the members below.
    std::string name_;
    std::size_t leases_ = 0;
    bool is_counted_ = false;
    std::list<Slot*>::iterator place_;  // the place in open_ while is_counted_ is true
};

class OpenDatabases {
  public:
    explicit OpenDatabases(std::size_t most_open) : most_open_(most_open) {}

    // Keeps a slot while this object lives. Other threads do not close the slot's database to make
    // room.
    class Lease {
      public:
        Lease(OpenDatabases& all, Slot& slot) : all_(all), slot_(slot) {}
        ~Lease() { all_.give_back(slot_); }
        Lease(const Lease&) = delete;
        Lease& operator=(const Lease&) = delete;
        Slot& operator*() const { return slot_; }
        Slot* operator->() const { return &slot_; }

      private:
        OpenDatabases& all_;
        Slot& slot_;
    };
    // Leases the slot of a database, which becomes the most recently used one.
    [[nodiscard]] Lease lease(const std::string& name);

    // Counts the slot's database as open, and closes the least recently used databases beyond the
    // limit. Call it with a lease and the slot's mutex, before the slot's database is opened.
    void make_room(Slot& slot) STORMCELLAR_REQUIRES(slot.mutex);
    // Closes the slot's database, or undoes make_room() if it was not opened. Call it with a lease
    // and the slot's mutex.
    void close(Slot& slot) STORMCELLAR_REQUIRES(slot.mutex);
    // Closes up to `count` databases without a lease, the least recently used first, and returns
    // how many were closed.
    std::size_t close_idle(std::size_t count);

    [[nodiscard]] std::size_t open_count() const;
    [[nodiscard]] std::size_t slot_count() const;

  private:
    void give_back(Slot& slot);
    bool close_one_idle();
    void drop_if_empty(Slot& slot) STORMCELLAR_REQUIRES(mutex_);

    const std::size_t most_open_;
    mutable Mutex mutex_;
    std::map<std::string, std::unique_ptr<Slot>, std::less<>> slots_ STORMCELLAR_GUARDED_BY(mutex_);
    std::list<Slot*> open_ STORMCELLAR_GUARDED_BY(mutex_);  // the most recently used first
};

// Returns true if this process has too few free descriptors to open a database.
[[nodiscard]] bool is_out_of_descriptors();
// Returns the error `exhausted` for a database that could not be opened because
// is_out_of_descriptors() is true. Another try may succeed.
[[nodiscard]] tl::unexpected<Error> no_descriptor(const std::filesystem::path& database);

}  // namespace stormcellar::catalog
