// daemon/log/journal.h -- entries for systemd's journal, with fields of their own.
//
// Each entry is one datagram: NAME=value and a newline for each field. A value that holds a newline
// is sent as NAME, a newline, its length (8 bytes, little endian), the value and a newline. An
// entry that is too long for a datagram is sent as the descriptor of a sealed memory file. This
// class does not use sd_journal_sendv(), which knows one socket only and reports success when
// nobody listens there: a line must then go elsewhere. Source: systemd.io/JOURNAL_NATIVE_PROTOCOL,
// sd_journal_send(3). Thread contract: send() from any thread.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace stormcellar::daemon {

inline constexpr const char* journal_socket = "/run/systemd/journal/socket";

// Names consist of capital letters, digits and "_" and do not begin with a digit or "_"; the
// journal drops others. Values are any bytes.
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

    // Returns false if nobody accepts the entry: there is no socket, or it has no room within a
    // second.
    [[nodiscard]] bool send(std::string_view entry) const;

  private:
    [[nodiscard]] bool send_as_file(std::string_view entry) const;

    std::filesystem::path path_;
    int descriptor_;  // negative: the system gave none
};

}  // namespace stormcellar::daemon
