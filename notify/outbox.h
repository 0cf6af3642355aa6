// notify/outbox.h -- the messages of one rule on disk, so that a restart neither loses nor doubles
// a message.
//
// Each message is one file. Its name has the time of the grid and the id of the cell:
//   20240601_220000_123_KTLX-20240601_215500-3.json   waits
//   20240601_220000_123_KTLX-20240601_215500-3.sent   was delivered, or dropped
// A file appears whole. settle() renames it, so that a later start knows about which cells the rule
// has sent messages, and when. If the program is killed between a delivery and settle(), the
// message is delivered again, with the same id. At most `most_waiting` messages wait; put() then
// drops the oldest. Only one process may use the directory.
//
// Threads   Many threads may use one Outbox.
// Errors    Those of file operations. After an error, put() leaves no message and may be called
//           again.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::notify {

// The name of a message. Messages are ordered by time.
struct MessageName {
    UtcTime time;      // of the grid
    std::string cell;  // letters, digits, _ - and .
    // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes a defaulted <=> for a null.
    auto operator<=>(const MessageName&) const = default;
    [[nodiscard]] std::string id() const;  // the name of the file without its ending
};
// Reads an id; none for any other text.
[[nodiscard]] std::optional<MessageName> parse_id(std::string_view id);

class Outbox {
  public:
    static constexpr std::size_t most_waiting = 1000;

    // Makes the directory if it is missing, and reads its names. Ignores other files.
    static Result<std::unique_ptr<Outbox>> open(FileSystem& file_system,
                                                std::filesystem::path directory);

    // Writes a message. Returns how many older messages were dropped to make room.
    Result<std::size_t> put(const MessageName& name, const std::string& text);
    // Returns the oldest message that waits.
    [[nodiscard]] std::optional<MessageName> oldest() const;
    [[nodiscard]] Result<std::string> read(const MessageName& name) const;
    // Notes that a message was delivered or dropped.
    Status settle(const MessageName& name);
    // Returns the time of the newest grid for which there is a message about the cell, in whatever
    // state.
    [[nodiscard]] std::optional<UtcTime> last_of(const std::string& cell) const;
    // Forgets settled messages of grids before `time`.
    void forget_before(UtcTime time);
    [[nodiscard]] std::size_t waiting() const;

  private:
    Outbox(FileSystem& file_system, std::filesystem::path directory)
        : file_system_(file_system), directory_(std::move(directory)) {}
    [[nodiscard]] std::filesystem::path path_of(const MessageName& name,
                                                std::string_view ending) const;
    void note(const std::filesystem::path& file) STORMCELLAR_REQUIRES(mutex_);
    Status settle_locked(const MessageName& name) STORMCELLAR_REQUIRES(mutex_);

    FileSystem& file_system_;
    const std::filesystem::path directory_;
    mutable Mutex mutex_;
    std::set<MessageName> waiting_ STORMCELLAR_GUARDED_BY(mutex_);
    std::set<MessageName> settled_ STORMCELLAR_GUARDED_BY(mutex_);
    std::map<std::string, UtcTime> last_ STORMCELLAR_GUARDED_BY(mutex_);  // by cell
};

}  // namespace stormcellar::notify
