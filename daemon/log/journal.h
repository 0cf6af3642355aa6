// daemon/log/journal.h -- entries for systemd's journal, with fields of their own.
//
// One datagram an entry: NAME=value and a newline for each field; a value with a newline in it as
// NAME, a newline, its length (8 bytes, little endian), the value and a newline. What is too long
// for a datagram goes as a sealed memory file whose descriptor is sent. Written here instead of
// with sd_journal_sendv(), which knows one socket only and says that all is well when nobody
// listens there: a line must then go elsewhere.
// Source: systemd.io/JOURNAL_NATIVE_PROTOCOL, sd_journal_send(3).
// Thread contract: send() from any thread.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace stormcellar::daemon {

inline constexpr const char* journal_socket = "/run/systemd/journal/socket";

// Names are capital letters, digits and "_" and do not begin with a digit or "_": others the
// journal leaves out. Values are any bytes.
struct JournalField {
    std::string_view name;
    std::string value;
};
[[nodiscard]] std::string journal_entry(std::span<const JournalField> fields);

class Journal {
  public:
    explicit Journal(std::filesystem::path socket);
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;
    ~Journal();

    // False when nobody takes it: no socket there, or none that has room within a second.
    [[nodiscard]] bool send(std::string_view entry) const;

  private:
    [[nodiscard]] bool send_as_file(std::string_view entry) const;

    std::filesystem::path path_;
    int descriptor_;  // negative: none could be had
};

}  // namespace stormcellar::daemon
