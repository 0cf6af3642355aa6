// catalog/open_databases.h -- the open databases of a catalog: a bounded set, of which the least
// recently used one is closed first.
//
// An open database takes three descriptors (itself, its WAL and the WAL's index). A thread that
// works on a database holds a lease and the mutex of its slot. Only a database without a lease is
// closed to make room, so none is closed while a thread uses it. If all are leased, the bound is
// exceeded by as many as threads work at once. What a slot remembers of a closed database takes
// some 200 bytes. A slot that remembers nothing is dropped with its last lease, so that asking for
// names leaves nothing behind. Cost: a lease takes 0.1 microseconds. Closing a database that was
// written to makes a checkpoint of its WAL, which is synced: 0.4 ms; opening it again takes 0.5 ms
// (medians of 200, 2026-11-25, a shared cloud machine of two cores;
// tests/catalog/open_databases_test.cpp prints them). Inside the catalog room only. Thread
// contract: any thread; the mutex of a slot guards its contents.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include <sys/types.h>

#include "catalog/station_database.h"

namespace stormcellar::catalog {

// Tells whether a path still names the same file.
struct FileIdentity {
    dev_t device = 0;
    ino_t inode = 0;
    bool operator==(const FileIdentity&) const = default;

    static FileIdentity of(const std::filesystem::path& path);
};

// Whether a database has rows of paths whose guessed_home() is another database.
enum class Strays : std::uint8_t {
    unknown,
    none,
    some,
    too_many_rows,  // for a file to wait until they are examined; mark_missing() does that
};

// The place of one database.
struct Slot {
    std::mutex mutex;  // guards the members below
    std::unique_ptr<StationDatabase> database;
    FileIdentity file;  // the file that was opened last; none: not opened yet
    std::atomic<Strays> strays = Strays::unknown;  // written under the mutex, read without it

  private:
    friend class OpenDatabases;
    // The mutex of OpenDatabases guards these.
    std::string name_;
    std::size_t leases_ = 0;
    bool is_counted_ = false;
    std::list<Slot*>::iterator place_;  // in the list of open ones, while it is counted
};

class OpenDatabases {
  public:
    explicit OpenDatabases(std::size_t most_open) : most_open_(most_open) {}

    // A lease: the slot stays, and its database stays open if it is open, while this object lives.
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
    // Marks the slot as the most recently used.
    [[nodiscard]] Lease lease(const std::string& name);

    // Call it before opening the slot's database, with a lease and the slot's mutex: closes the
    // least recently used databases to stay within the bound.
    void make_room(Slot& slot);
    // Closes the slot's database, or undoes make_room(). Call it with a lease and the slot's mutex.
    void close(Slot& slot);
    // Closes up to this many databases without a lease, least recently used first; returns how
    // many.
    std::size_t close_idle(std::size_t count);

    [[nodiscard]] std::size_t open_count() const;
    [[nodiscard]] std::size_t slot_count() const;

  private:
    void give_back(Slot& slot);
    bool close_one_idle();
    // The caller holds mutex_.
    void drop_if_empty(Slot& slot);

    const std::size_t most_open_;
    mutable std::mutex mutex_;  // guards the members below, not the contents of slots
    std::map<std::string, std::unique_ptr<Slot>, std::less<>> slots_;
    std::list<Slot*> open_;  // most recently used first
};

// Returns true if the process cannot open another database at the moment.
[[nodiscard]] bool is_out_of_descriptors();
// The error of a database in that case: it is nobody's fault, and trying again may help.
[[nodiscard]] tl::unexpected<Error> no_descriptor(const std::filesystem::path& database);

}  // namespace stormcellar::catalog
